#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "io/channels.h"
#include "rimod/status_t.hpp"
#include "viewer_tools/bus_report.h"
#include "viewer_tools/scan_latency.h"

namespace rimod {

// Over which time rates and latencies are told.
enum class WatchSpan {
  kLately,  // rates of the last ten seconds, latencies of the last hundred scans
  kAll      // of everything that came, latencies of the last million scans
};

// Listens to what the processes of the pipeline say, live or recorded, and sums it up. Its memory
// is bounded whatever comes.
class BusWatch {
 public:
  // clouds: where scans come as point clouds, too.
  BusWatch(const Channels& channels, WatchSpan span, const CloudChannels& clouds = {});

  // A message on a channel; others than the pipeline's are ignored. arrival: s, never falling.
  void Take(const std::string& channel, const void* bytes, std::size_t size, double arrival);

  // What is known now, s, on the clock of the arrivals.
  BusReport Report(double now) const;

  // The names of the channels that Take() is interested in.
  std::vector<std::string> channel_names() const;

 private:
  // One process between its first status and its last.
  struct Process {
    struct Sample {
      std::int64_t utime = 0;  // us, the process's wall clock
      std::int64_t num_out = 0, cpu_ms = 0;
    };
    status_t status;
    double last_arrival = 0.0;
    std::deque<Sample> samples;
  };
  struct Second {
    std::int64_t number = 0;
    std::int64_t wholes = 0, bytes = 0;
  };
  // Why a message cannot be used, and whether it completed something.
  struct Taken {
    std::string error;
    bool is_whole = false;
  };
  struct Channel {
    std::string name;
    bool is_optional = false;
    // Whether the message completes something; of optional channels.
    Taken (*take)(const void* bytes, std::size_t size) = nullptr;
    std::int64_t messages = 0, wholes = 0, bytes = 0;
    std::deque<Second> lately;
  };
  using ProcessKey = std::tuple<std::string, std::string, std::int32_t>;  // name, host, pid

  Taken TakeMessage(std::size_t channel, const void* bytes, std::size_t size, double arrival);
  Taken TakeStatus(const void* bytes, std::size_t size, double arrival);
  // Of one of the optional channels: the last of a message's sections completes something, whether
  // or not all others came.
  template <typename Message>
  static Taken TakeOptional(const void* bytes, std::size_t size);
  template <typename Message>
  void AddOptional(const std::string& name);
  template <typename Message>
  Taken TakeSection(StageOutput output, const void* bytes, std::size_t size, double arrival);
  void Count(Channel* channel, std::size_t size, bool is_whole, double arrival) const;
  void ForgetOneProcess();

  ProcessReport ReportOf(const Process& process, double now) const;
  ChannelReport ReportOf(const Channel& channel, double now) const;

  WatchSpan span_;
  double begin_ = -1.0;  // arrival of the first message; none yet
  ScanLatency latency_;
  std::vector<Channel> channels_;
  std::map<ProcessKey, Process> processes_;
  std::map<std::string, std::int64_t> unusable_;  // by channel and cause
};

}  // namespace rimod
