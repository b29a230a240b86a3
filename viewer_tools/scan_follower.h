#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "io/bus_params.h"
#include "io/channels.h"
#include "io/section_joiner.h"
#include "rimod/feature_set_t.hpp"
#include "rimod/range_image_t.hpp"
#include "viewer_tools/viewed_scan.h"

namespace rimod {

// Brings together what the stages tell of a scan, live or recorded, in whatever order it comes.
// Remembers the last few scans only, so that its memory is bounded whatever comes.
class ScanFollower {
 public:
  using Clock = SectionJoiner<range_image_t>::Time;

  ScanFollower(const Channels& channels, const BusParams& params);

  // The names of the channels that Take() is interested in.
  std::vector<std::string> channel_names() const;

  // A message on a channel; others than those are ignored. Returns the cause when it cannot be
  // used, else an empty text.
  std::string Take(const std::string& channel, const void* bytes, std::size_t size, Clock now);

  // The scan, or the look at a sweep that still goes on, whose image is the newest; null before
  // the first image. Valid until the next Take().
  const ViewedScan* newest() const;
  // Changes whenever newest() is another one or has become more.
  std::int64_t newest_version() const { return version_; }

  // The scans and looks that became complete since the last call, in order: their detections are
  // there, or so many newer scans that none are to be expected. Those without an image are left
  // out.
  std::vector<ViewedScan> TakeFinished();
  // At the end of a log: also those that are still open.
  std::vector<ViewedScan> TakeRest();

 private:
  template <typename Message>
  std::string TakeSection(const void* bytes, std::size_t size, Clock now);
  template <typename Message>
  std::string TakePartial(const void* bytes, std::size_t size, Clock now);
  template <typename Message>
  std::string TakeResult(const void* bytes, std::size_t size);

  // Each puts its part where it belongs; returns the cause when it cannot be used.
  std::string Put(const std::vector<range_image_t>& sections, std::int64_t utime,
                  std::int64_t known_until);
  std::string Put(const std::vector<feature_set_t>& sections, std::int64_t utime,
                  std::int64_t known_until);
  std::string Put(const pose_hypotheses_t& message);
  std::string Put(const detections_t& message);
  std::string Put(const early_detections_t& message);

  struct Slot {
    ViewedScan scan;
    bool delivered = false;  // as finished
  };
  Slot* FindOrAdd(std::int64_t utime, std::int64_t known_until);
  // Counts a change of the newest scan.
  void Changed(const Slot& slot);
  void Deliver(Slot* slot);
  SectionJoiner<range_image_t>* JoinerFor(const range_image_t&, bool is_partial) {
    return is_partial ? &partial_image_joiner_ : &image_joiner_;
  }
  SectionJoiner<feature_set_t>* JoinerFor(const feature_set_t&, bool is_partial) {
    return is_partial ? &partial_feature_joiner_ : &feature_joiner_;
  }

  Channels channels_;
  SectionJoiner<range_image_t> image_joiner_;
  SectionJoiner<feature_set_t> feature_joiner_;
  SectionJoiner<range_image_t> partial_image_joiner_;
  SectionJoiner<feature_set_t> partial_feature_joiner_;
  std::deque<Slot> slots_;  // in the order of their images
  std::vector<ViewedScan> finished_;
  std::int64_t version_ = 0;
};

}  // namespace rimod
