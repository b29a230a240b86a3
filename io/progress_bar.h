#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>

#include "rimod/execution.h"

namespace rimod {

// A line on stderr that shows how far the library's loops are, when stderr is a terminal; else
// nothing.
class ProgressBar {
 public:
  explicit ProgressBar(std::string title);
  ~ProgressBar();  // takes the line away
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  // Makes the execution's outermost loops report to this bar, which must outlive it.
  void Watch(Execution* execution);

 private:
  void Draw(std::size_t done, std::size_t count);

  std::string title_;
  bool enabled_ = false;
  std::atomic<bool> in_loop_{false};
  std::mutex mutex_;  // guards what is below
  std::chrono::steady_clock::time_point last_drawn_;
  bool drawn_ = false;
};

}  // namespace rimod
