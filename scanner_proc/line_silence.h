#pragma once

#include <algorithm>
#include <chrono>

namespace rimod {

// Tells from when lines come in whether they have stopped. A machine that delivers lines late or in
// bursts pauses in the midst of a sweep: the silence must be much longer than any pause before.
// Time in which this process itself did not run is no silence.
class LineSilence {
 public:
  using Clock = std::chrono::steady_clock;

  LineSilence(Clock::duration quiet_time, Clock::time_point now)
      : quiet_time_(quiet_time), last_line_(now), last_input_(now), last_look_(now) {}

  // A line came. first: of a sweep, so that the pause before it does not count.
  void OnLine(Clock::time_point now, bool first) {
    longest_pause_ = first ? Clock::duration{0} : std::max(longest_pause_, now - last_line_);
    last_line_ = now;
    OnInput(now);
  }
  // A pose came, or a line.
  void OnInput(Clock::time_point now) {
    last_input_ = now;
    unheard_ = Clock::duration{0};
  }
  // To be called many times a second, when everything that had come was handed over.
  void Look(Clock::time_point now) {
    constexpr auto kLate = std::chrono::milliseconds(30);
    if (now - last_look_ > kLate) unheard_ += now - std::max(last_look_, last_input_);
    last_look_ = now;
  }
  // As of the last look. line_waits: the last line lacks the pose after it, which is waited for.
  bool LinesStopped(bool line_waits) const {
    constexpr int kLongerThanAnyPause = 3;
    const auto silence = last_look_ - (line_waits ? last_input_ : last_line_) - unheard_;
    return silence > quiet_time_ && silence > kLongerThanAnyPause * longest_pause_;
  }

 private:
  Clock::duration quiet_time_;
  Clock::time_point last_line_, last_input_, last_look_;
  Clock::duration longest_pause_{0};  // between lines of the sweep at hand
  Clock::duration unheard_{0};        // since the last input
};

}  // namespace rimod
