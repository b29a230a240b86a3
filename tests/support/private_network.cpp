#include "tests/support/private_network.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <vector>

namespace rimod {

void EnterPrivateNetwork(char** argv) {
  constexpr char kMark[] = "RIMOD_TEST_IN_PRIVATE_NETWORK";
  if (std::getenv(kMark) != nullptr) return;
  if (std::system("unshare -rn true 2>/dev/null") != 0) {
    std::fprintf(stderr, "SKIPPED: private networks (unshare -rn) are forbidden here\n");
    std::exit(kSkipped);
  }
  setenv(kMark, "yes", 1);
  unsetenv("LCM_DEFAULT_URL");
  constexpr char kSetUp[] =
      "ip link set lo up && ip link set lo multicast on && ip route add 224.0.0.0/4 dev lo && "
      "exec \"$0\" \"$@\"";
  std::vector<const char*> arguments = {"unshare", "-rn", "sh", "-c", kSetUp, "/proc/self/exe"};
  std::vector<char> self(4096);
  const ssize_t length = readlink("/proc/self/exe", self.data(), self.size() - 1);
  if (length > 0) arguments.back() = self.data();
  for (char** argument = argv + 1; *argument != nullptr; ++argument) arguments.push_back(*argument);
  arguments.push_back(nullptr);
  execvp("unshare", const_cast<char* const*>(arguments.data()));
  std::perror("unshare");
  std::exit(1);
}

}  // namespace rimod
