#include "io/progress_bar.h"

#include <unistd.h>

#include <cstdio>
#include <memory>
#include <utility>

namespace rimod {

ProgressBar::ProgressBar(std::string title)
    : title_(std::move(title)), enabled_(::isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (drawn_) std::fputs("\r\x1b[K", stderr);
}

void ProgressBar::Watch(Execution* execution) {
  if (!enabled_) return;
  const auto loop = execution->parallel_for;
  execution->parallel_for = [this, loop](std::size_t count,
                                         const std::function<void(std::size_t)>& body) {
    if (in_loop_.exchange(true)) {  // a loop inside a body
      loop(count, body);
      return;
    }
    std::atomic<std::size_t> done{0};
    const auto end_loop = [this](void*) { in_loop_ = false; };
    const std::unique_ptr<void, decltype(end_loop)> guard(this, end_loop);
    loop(count, [&](std::size_t i) {
      body(i);
      Draw(++done, count);
    });
  };
}

void ProgressBar::Draw(std::size_t done, std::size_t count) {
  constexpr std::chrono::milliseconds kPause(100);
  constexpr std::size_t kCells = 40;
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  if (now - last_drawn_ < kPause) return;
  last_drawn_ = now;
  drawn_ = true;
  const std::size_t filled = kCells * done / count;
  std::fprintf(stderr, "\r%s [%s%s] %3zu %%\x1b[K", title_.c_str(),
               std::string(filled, '#').c_str(), std::string(kCells - filled, '.').c_str(),
               100 * done / count);
}

}  // namespace rimod
