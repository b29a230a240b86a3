#!/bin/sh
# Bundles the page: libraries by npm, as the lock file has them, then one file by esbuild. Needs the npm registry
# the first time; what npm has fetched once it takes from its cache.
#   build.sh WORK OUT     WORK: a folder for node_modules; OUT: where the page comes
set -eu
here=$(cd -- "$(dirname -- "$0")" && pwd)
work=$1 out=$2

command -v npm >/dev/null || { echo "no npm"; exit 1; }
mkdir -p "$work" "$out"
if ! cmp -s "$here/package-lock.json" "$work/installed"; then
  cp "$here/package.json" "$here/package-lock.json" "$here/.npmrc" "$work/"
  (cd "$work" && npm ci --ignore-scripts --prefer-offline --loglevel=error --fetch-retries=1 \
    --fetch-timeout=60000) || { echo "npm could not get the page's libraries"; exit 1; }
  cp "$here/package-lock.json" "$work/installed"
fi
NODE_PATH=$work/node_modules node "$work/node_modules/esbuild/bin/esbuild" "$here/source/main.js" \
  --bundle --minify --format=esm --target=es2022 --legal-comments=eof --log-level=warning --outfile="$out/page.js"
cp "$here/source/page.css" "$out/"
cp "$here/source/index.html" "$out/"
