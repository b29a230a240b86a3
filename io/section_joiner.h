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
  // Sections come in order but for what a network may change. One that does not, after a pause of
  // more than this, is of another whole of the same name.
  std::chrono::milliseconds disorder{200};
};

// The default with the patience of the configuration.
SectionJoinerParams JoinerParamsFrom(const BusParams& bus);

// What happened to sections, by cause. Counts only grow.
struct SectionCounters {
  std::int64_t sections = 0;     // that came in
  std::int64_t completed = 0;    // wholes
  std::int64_t incomplete = 0;   // wholes given up: a section is missing
  std::int64_t conflicting = 0;  // wholes given up: two senders of the same whole disagree
  std::int64_t same_name = 0;    // wholes not begun: another with this header has only just ended
  std::int64_t duplicated = 0;   // sections that were there already
  std::int64_t late = 0;         // sections of a whole that is complete or was given up
  std::int64_t bad_numbers = 0;  // sections: number or total out of range
};

// Joins the sections of a message type into wholes. Sections may arrive in any order, wholes
// interleaved. Only sections whose header fields (all but section number and lists) are equal are
// joined; of one whole a section that came twice with different content gives the whole up. While
// wholes with different content and equal headers follow each other within the time of memory, as
// from a sensor whose clock stands still, only the first of them is joined: which section belongs
// to which of the others could not be told. Section: scan_t, range_image_t, feature_set_t,
// object_model_t or shard_candidates_t.
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
    int highest = -1;  // number of a section that is there
    std::int64_t bytes = 0;
    Time last_change;
  };
  struct Closed {
    Section header;
    std::vector<std::uint64_t> digests;  // of its sections; 0 where none came
    Time when;                           // it ended, or the last of its name was turned away
    std::vector<bool> turned_away;       // sections of the whole of its name that comes now
  };

  // Whether the section is of a whole that has ended, or has the name of one.
  bool IsLate(const Section& section, Time now);
  void TurnAway(std::size_t number, Closed* closed, Time now);
  Whole* FindOrOpen(const Section& section, Time now);
  // Whether the sender must have begun another whole of the same name.
  bool BeginsAnew(const Whole& whole, const Section& section, Time now) const;
  Whole* Oldest();
  std::vector<Section> Complete(Whole* whole, Time now);
  // Forgets an open whole, except for telling that further sections of it are late.
  void GiveUp(Whole* whole, std::int64_t* cause, Time now);
  // What tells late sections of it, and others of its name.
  void Remember(Whole* whole, Time now);
  void KeepWithinBounds(Time now);

  SectionJoinerParams params_;
  SectionCounters counters_;
  std::vector<Whole> open_;
  std::deque<Closed> closed_;  // oldest first
};

}  // namespace rimod
