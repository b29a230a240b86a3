#pragma once

#include <string>

namespace rimod {

// Shows texts one in place of the other on the terminal behind stdout, whose former content comes
// back at the end. Where stdout is none, texts follow each other.
class TerminalScreen {
 public:
  TerminalScreen();
  ~TerminalScreen();
  TerminalScreen(const TerminalScreen&) = delete;
  TerminalScreen& operator=(const TerminalScreen&) = delete;

  // What does not fit into the window is cut off.
  void Show(const std::string& text);

 private:
  bool is_terminal_;
};

// The first lines of a text, at most so many, each cut to at most so many characters.
std::string CutToWindow(const std::string& text, std::size_t num_rows, std::size_t num_columns);

}  // namespace rimod
