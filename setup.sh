#!/usr/bin/env bash
# Installs the Debian packages that rimod is built, run and tested with. May be run again: installs
# only what is missing. docs/dependencies.md gives the reason for each package.
set -euo pipefail

packages=(
  # compiler and build
  g++ make cmake pkg-config git
  # libraries
  libeigen3-dev libnanoflann-dev libopencv-core-dev libopencv-imgproc-dev libopencv-imgcodecs-dev
  libopencv-highgui-dev
  libembree-dev libcli11-dev libspdlog-dev libyaml-cpp-dev nlohmann-json3-dev
  zlib1g-dev liblzf-dev libwebsockets-dev
  # LCM and its viewers
  liblcm-dev libglib2.0-dev liblcm-bin liblcm-java libjchart2d-java openjdk-17-jdk-headless openjdk-17-jre
  # tests and demo
  libgtest-dev libbenchmark-dev iproute2 nftables libfaketime util-linux xvfb xdotool
)
checks=(clang clang-format clang-tidy libclang-rt-dev ccache valgrind)
# For the page of rimod-web and its test. npm may be there from elsewhere: Debian's is 400 packages.
web=(chromium)
command -v npm >/dev/null || web+=(npm)
# For benchmarks/peers, the comparison with other libraries, alone: 305 packages.
peers=(libpcl-dev libopencv-contrib-dev)
# For the plots and scenes of experiments/run alone.
experiments=(python3-matplotlib sweethome3d-furniture)

usage() {
  cat <<'END'
usage: ./setup.sh [--checks] [--web] [--peers] [--experiments] [--print]
  --checks  also what the style checks of .ci/run use: clang-format, clang-tidy, clang
            with its fuzzer, ccache, valgrind
  --web     also what the page of rimod-web is built and tested with: npm (where there is none yet)
            and Chromium
  --peers   also PCL and OpenCV's contributed modules, which benchmarks/peers compares with
  --experiments  also what experiments/run draws and makes scenes with: matplotlib, furniture
  --print   print the packages, one a line, and install nothing
END
}

print=false
for argument in "$@"; do
  case "$argument" in
    --checks) packages+=("${checks[@]}") ;;
    --web) packages+=("${web[@]}") ;;
    --peers) packages+=("${peers[@]}") ;;
    --experiments) packages+=("${experiments[@]}") ;;
    --print) print=true ;;
    -h | --help) usage; exit 0 ;;
    *) echo "setup.sh: unknown option '$argument'" >&2; usage >&2; exit 2 ;;
  esac
done
if $print; then
  printf '%s\n' "${packages[@]}"
  exit 0
fi

distribution=unknown
if [ -r /etc/os-release ]; then
  distribution=$(. /etc/os-release; echo "${ID:-unknown} ${VERSION_ID:-}")
fi
if [ "$distribution" != "debian 12" ]; then
  echo "setup.sh: made for Debian 12 (bookworm); this is '$distribution'." >&2
  echo "  rimod needs the same libraries here, under this system's names for these packages:" >&2
  printf '    %s\n' "${packages[@]}" >&2
  echo "  Install them by hand, then build: cmake --preset release && cmake --build --preset release" >&2
  exit 1
fi

# What dpkg does not list as installed; pkg-config may be there as the package pkgconf.
missing=()
installed=$(dpkg-query -W -f '${db:Status-Abbrev} ${Package}\n' "${packages[@]}" 2>/dev/null |
            sed -n 's/^[ih]i *//p') || true
for package in "${packages[@]}"; do
  grep -qxF -- "$package" <<<"$installed" || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then
  echo "setup.sh: all ${#packages[@]} packages are installed" >&2
  exit 0
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "setup.sh: not root and no sudo. As root, run: apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi

echo "setup.sh: installing ${#missing[@]} packages: ${missing[*]}" >&2
install_missing() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -q --no-install-recommends "${missing[@]}" </dev/null >&2
}
# The package lists may be absent or old: fetch them when the first attempt finds something missing.
if ! install_missing; then
  "${as_root[@]}" apt-get update -q >&2
  install_missing
fi
