#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "io/bus_params.h"

namespace rimod {

struct SectionJoinerParams {
  int max_open = 4;                      // wholes under way at a time; >= 1
  int max_sections = 4096;               // of one whole; >= 1
  std::int64_t max_bytes = 256'000'000;  // encoded, of everything under way
  std::chrono::milliseconds patience{
      5000};                              // a whole without a new section for so long is given up
  std::chrono::milliseconds memory{500};  // sections that repeat one completed so recently are late
};

// The default with the patience of the configuration.
SectionJoinerParams JoinerParamsFrom(const BusParams& bus);

// What happened to sections, by cause. Counts only grow.
struct SectionCounters {
  std::int64_t sections = 0;     // that came in
  std::int64_t completed = 0;    // wholes
  std::int64_t incomplete = 0;   // wholes given up: a section is missing
  std::int64_t conflicting = 0;  // wholes given up: two senders of the same whole disagree
  std::int64_t duplicated = 0;   // sections that were there already
  std::int64_t late = 0;         // sections of a whole that is complete or was given up
  std::int64_t bad_numbers = 0;  // sections: number or total out of range
};

// Joins the sections of a message type into wholes. Sections may arrive in any order, wholes
// interleaved. Only sections whose header fields (all but section number and lists) are equal are
// joined; of one whole a section that came twice with different content gives the whole up.
// Section: scan_t, range_image_t, feature_set_t, object_model_t or shard_candidates_t.
template <typename Section>
class SectionJoiner {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit SectionJoiner(const SectionJoinerParams& params = {});

  // Returns the whole that this section completes, sections in order; mostly nothing.
  std::optional<std::vector<Section>> Add(Section section, Time now);

  // Gives up what has waited too long. Add() does so itself.
  void GiveUpStale(Time now);

  const SectionCounters& counters() const { return counters_; }
  std::size_t num_open() const { return open_.size(); }

 private:
  struct Whole {
    Section header;  // without lists
    std::vector<std::optional<Section>> sections;
    int num_present = 0;
    std::int64_t bytes = 0;
    Time last_change;
  };
  struct Closed {
    Section header;
    Time when;
  };

  bool IsLate(const Section& section) const;
  Whole* FindOrOpen(const Section& section, Time now);
  Whole* Oldest();
  std::vector<Section> Complete(Whole* whole, Time now);
  // Forgets an open whole, except for telling that further sections of it are late.
  void GiveUp(Whole* whole, std::int64_t* cause, Time now);
  void KeepWithinBounds(Time now);

  SectionJoinerParams params_;
  SectionCounters counters_;
  std::vector<Whole> open_;
  std::deque<Closed> closed_;  // oldest first
};

}  // namespace rimod
