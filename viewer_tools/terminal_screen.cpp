#include "viewer_tools/terminal_screen.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <sstream>

namespace rimod {
namespace {

// ANSI: every terminal of today knows these.
constexpr char kEnter[] = "\033[?1049h\033[?25l";  // the other screen, no cursor
constexpr char kLeave[] = "\033[?25h\033[?1049l";
constexpr char kHome[] = "\033[H";
constexpr char kClearLine[] = "\033[K";
constexpr char kClearBelow[] = "\033[J";

void Print(const std::string& text) {
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
}

}  // namespace

TerminalScreen::TerminalScreen() : is_terminal_(isatty(STDOUT_FILENO) == 1) {
  if (is_terminal_) Print(kEnter);
}

TerminalScreen::~TerminalScreen() {
  if (is_terminal_) Print(kLeave);
}

void TerminalScreen::Show(const std::string& text) {
  if (!is_terminal_) return Print(text + "\n");
  winsize window = {};
  const bool known = ioctl(STDOUT_FILENO, TIOCGWINSZ, &window) == 0 && window.ws_row > 0;
  std::istringstream lines(
      CutToWindow(text, known ? window.ws_row : 24, known ? window.ws_col : 80));
  std::string picture = kHome;
  bool first = true;
  for (std::string line; std::getline(lines, line); first = false)
    picture += (first ? "" : "\r\n") + line + kClearLine;
  Print(picture + kClearBelow);
}

std::string CutToWindow(const std::string& text, std::size_t num_rows, std::size_t num_columns) {
  std::istringstream lines(text);
  std::string cut;
  std::string line;
  for (std::size_t row = 0; row < num_rows && std::getline(lines, line); ++row)
    cut += line.substr(0, num_columns) + "\n";
  return cut;
}

}  // namespace rimod
