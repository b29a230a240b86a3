#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "io/bus_params.h"
#include "io/channels.h"
#include "io/section_joiner.h"
#include "rimod/range_image_t.hpp"
#include "rimod/scan_t.hpp"
#include "web_viewer/scan_history.h"

namespace rimod {

// What a message was good for.
struct TakenMessage {
  std::string error;            // the cause why it cannot be used; empty when it can
  bool completed_scan = false;  // points came
  bool has_detections = false;
};

// Puts what the pipeline says, live or recorded, into the history.
class SceneFeed {
 public:
  using Time = SectionJoiner<scan_t>::Time;

  // history must outlive it.
  SceneFeed(const Channels& channels, const BusParams& bus, ScanHistory* history);

  // A message on a channel; others than the channel_names() are ignored.
  TakenMessage Take(const std::string& channel, const void* bytes, std::size_t size, Time now);
  void GiveUpStale(Time now);

  std::vector<std::string> channel_names() const;
  const SectionCounters& scan_counters() const { return scan_joiner_.counters(); }
  const SectionCounters& image_counters() const { return image_joiner_.counters(); }

 private:
  TakenMessage TakeScan(const void* bytes, std::size_t size, Time now);
  TakenMessage TakeRangeImage(const void* bytes, std::size_t size, Time now);
  TakenMessage TakeDetections(const void* bytes, std::size_t size);
  TakenMessage TakeHypotheses(const void* bytes, std::size_t size);
  TakenMessage TakeEarlyDetections(const void* bytes, std::size_t size);

  Channels channels_;
  SectionJoiner<scan_t> scan_joiner_;
  SectionJoiner<range_image_t> image_joiner_;
  ScanHistory* history_;
};

}  // namespace rimod
