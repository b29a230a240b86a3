#include "io/bus.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <thread>

namespace rimod {
namespace {

// A signal handler reaches nothing but statics.
std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "may be set in a signal handler");

void RequestStop(int /*signal*/) { stop_requested.store(true); }

void SetHandler(int signal, void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;  // without SA_RESTART: waiting calls return
  sigaction(signal, &action, nullptr);
}

// Handles what waits, but for no longer than an idle period.
void Drain(lcm::LCM* lcm, const std::atomic<bool>& stop, std::chrono::milliseconds idle_period) {
  const auto end = std::chrono::steady_clock::now() + idle_period;
  while (!stop && std::chrono::steady_clock::now() < end && lcm->handleTimeout(0) > 0) {
  }
}

}  // namespace

StopOnSignal::StopOnSignal() {
  stop_requested.store(false);
  SetHandler(SIGINT, &RequestStop);
  SetHandler(SIGTERM, &RequestStop);
}

StopOnSignal::~StopOnSignal() {
  SetHandler(SIGINT, SIG_DFL);
  SetHandler(SIGTERM, SIG_DFL);
}

const std::atomic<bool>& StopOnSignal::stop() const { return stop_requested; }

bool RunBus(lcm::LCM* lcm, const std::atomic<bool>& stop, const std::function<void()>& on_idle,
            std::chrono::milliseconds idle_period) {
  constexpr auto kFailurePause = std::chrono::milliseconds(50);
  constexpr int kMaxFailures = 40;  // in a row, a pause each: two seconds
  int num_failures = 0;
  while (!stop) {
    errno = 0;
    const int handled = lcm->handleTimeout(static_cast<int>(idle_period.count()));
    if (handled > 0) {
      num_failures = 0;
      Drain(lcm, stop, idle_period);
    } else if (handled == 0 || errno == EINTR) {
      num_failures = 0;
    } else if (++num_failures > kMaxFailures) {
      return false;
    } else {
      std::this_thread::sleep_for(kFailurePause);
    }
    on_idle();
  }
  return true;
}

}  // namespace rimod
