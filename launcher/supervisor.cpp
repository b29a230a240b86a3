#include "launcher/supervisor.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <csignal>
#include <exception>
#include <thread>
#include <utility>

namespace rimod {
namespace {

constexpr auto kPeriod = std::chrono::milliseconds(20);

std::chrono::steady_clock::duration Seconds(double seconds) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(seconds));
}

}  // namespace

Supervisor::Supervisor(RunFile run_file) : run_file_(std::move(run_file)) {
  for (const RunProcess& settings : run_file_.processes) {
    Process process;
    process.settings = settings;
    process.next = Clock::now();
    processes_.push_back(std::move(process));
  }
}

int Supervisor::Run(const std::atomic<bool>& stop) {
  while (!stop && AnythingLeft()) {
    for (Process& process : processes_)
      if (!stop) Tend(&process);
    std::this_thread::sleep_for(kPeriod);
  }
  StopAll();
  return failed_ ? 1 : 0;
}

void Supervisor::Tend(Process* process) {
  if (process->child) {
    if (const std::optional<Ending> ending = process->child->Poll()) OnEnd(process, *ending);
  } else if (process->next && *process->next <= Clock::now()) {
    Start(process);
  }
}

void Supervisor::Start(Process* process) try {
  process->next.reset();
  process->started = Clock::now();
  process->child = std::make_unique<Child>(process->settings.command);
  spdlog::info("{} started, pid {}", process->settings.name, process->child->pid());
} catch (const std::exception& error) {
  spdlog::error("{} cannot be started: {}", process->settings.name, error.what());
  PlanRestart(process, 0.0);
}

void Supervisor::OnEnd(Process* process, const Ending& ending) {
  process->child.reset();
  const double lived = std::chrono::duration<double>(Clock::now() - process->started).count();
  const Restart restart = process->settings.restart;
  const bool again =
      restart == Restart::kAlways || (restart == Restart::kOnFailure && !ending.good());
  if (stopping_ || !again) {
    // Asked to end, its default action for SIGTERM is as good as an exit.
    const bool well = ending.good() || (stopping_ && ending.signal == SIGTERM);
    failed_ = failed_ || !well;
    spdlog::log(well ? spdlog::level::info : spdlog::level::warn, "{} ended {}",
                process->settings.name, Describe(ending));
    return;
  }
  PlanRestart(process, lived);
  spdlog::warn("{} ended {} after {:.1f} s; starts again in {:.2f} s", process->settings.name,
               Describe(ending), lived, process->pause);
}

void Supervisor::PlanRestart(Process* process, double lived) {
  process->pause = NextPause(run_file_, process->pause, lived);
  process->next = Clock::now() + Seconds(process->pause);
}

bool Supervisor::AnythingLeft() const {
  return std::any_of(processes_.begin(), processes_.end(), [](const Process& process) {
    return process.child != nullptr || process.next.has_value();
  });
}

void Supervisor::StopAll() {
  stopping_ = true;
  for (auto process = processes_.rbegin(); process != processes_.rend(); ++process) {
    process->next.reset();
    if (process->child) process->child->Signal(SIGTERM);
  }
  if (WaitForAll(Clock::now() + Seconds(run_file_.stop_patience))) return;
  for (const Process& process : processes_) {
    if (!process.child) continue;
    spdlog::warn("{} still runs {} s after SIGTERM: killed", process.settings.name,
                 run_file_.stop_patience);
    process.child->Signal(SIGKILL);
  }
  WaitForAll(Clock::time_point::max());
}

bool Supervisor::WaitForAll(Clock::time_point end) {
  while (true) {
    for (Process& process : processes_) Tend(&process);
    if (!AnythingLeft()) return true;
    if (Clock::now() >= end) return false;
    std::this_thread::sleep_for(kPeriod);
  }
}

}  // namespace rimod
