#include "launcher/child.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>

namespace rimod {
namespace {

// Between fork and exec; nothing here allocates.
[[noreturn]] void Become(char* const* words, pid_t parent) {
  setpgid(0, 0);  // a Ctrl-C in the terminal reaches rimod-run alone, which stops all in order
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(1);  // it died before it could be watched
  const int nothing = open("/dev/null", O_RDONLY);
  if (nothing >= 0) dup2(nothing, STDIN_FILENO);
  signal(SIGINT, SIG_DFL);
  signal(SIGTERM, SIG_DFL);
  execv(words[0], words);
  constexpr int kCannotStart = 127;  // as shells do
  _exit(kCannotStart);
}

}  // namespace

std::string Describe(const Ending& ending) {
  if (ending.signal == 0) return "with exit code " + std::to_string(ending.exit_code);
  return "by signal " + std::to_string(ending.signal) + " (" + strsignal(ending.signal) + ")";
}

Child::Child(const std::vector<std::string>& command) {
  std::vector<char*> words;
  words.reserve(command.size() + 1);
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ < 0) throw std::system_error(errno, std::generic_category(), command[0]);
  if (pid_ == 0) Become(words.data(), parent);
  setpgid(pid_, pid_);  // both sides: whoever comes first
}

Child::~Child() {
  if (ending_) return;
  Signal(SIGKILL);
  waitpid(pid_, nullptr, 0);
}

void Child::Signal(int signal) const {
  if (!ending_) kill(-pid_, signal);
}

std::optional<Ending> Child::Poll() {
  if (ending_) return ending_;
  siginfo_t info = {};
  // Left as a zombie at first: its number stays that of the group until all of it is killed.
  const int status = waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT);
  if (status != 0 || info.si_pid != pid_) return std::nullopt;
  Signal(SIGKILL);
  waitpid(pid_, nullptr, 0);
  ending_ = info.si_code == CLD_EXITED ? Ending{info.si_status, 0} : Ending{0, info.si_status};
  return ending_;
}

}  // namespace rimod
