#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "io/bus_params.h"
#include "io/shard_messages.h"

namespace rimod {

struct ShardJoinerParams {
  std::chrono::milliseconds patience{5000};  // an answer is waited for so long after the first one
  std::chrono::milliseconds silence{3000};   // a shard that says nothing for so long is missing
  std::chrono::milliseconds listen{
      2000};  // so long shards are listened for before any scan is joined
  std::chrono::milliseconds memory{10000};    // answers to scans joined so recently are late
  std::chrono::milliseconds forget{600'000};  // a missing shard that none of its kind survives
  int max_open = 16;                          // scans under way
  std::int64_t max_open_bytes = 128'000'000;  // of their answers, about
};

ShardJoinerParams ShardJoinerParamsFrom(const BusParams& bus);

struct ShardCounters {
  std::int64_t answers = 0;
  std::int64_t late = 0;      // to a scan that was joined without them
  std::int64_t repeated = 0;  // by the same process
  std::int64_t twins = 0;     // by another process of the same name
  std::int64_t too_many = 0;  // shards: not heard
};

// A scan that nobody is waited for any more.
struct AnsweredScan {
  std::vector<ShardAnswer> answers;  // by the shards' names; at least one
  std::vector<std::string> without;  // shards that were expected and did not answer
};

// Keeps track of the shards that there are, and brings their answers to one scan together: answers
// are to one scan when utime and digest are equal, so that no two scans are mixed. A scan is waited
// for until all shards have answered that were there when it came; until it is known of the others
// that they went on to a later scan or are gone; or until patience ends. Of shards that split a
// folder all are expected as soon as one is heard.
class ShardJoiner {
 public:
  using Time = std::chrono::steady_clock::time_point;

  ShardJoiner(const ShardJoinerParams& params, Time now);

  // A sign of life.
  void Hear(const Shard& shard, Time now);
  void Add(ShardAnswer answer, Time now);
  // The scans that are decided now, in the order of their first answers.
  std::vector<AnsweredScan> TakeDecided(Time now);

  // Names of the shards that are there, and of those that are not any more or never were.
  std::vector<std::string> Present(Time now) const;
  std::vector<std::string> Missing(Time now) const;
  const ShardCounters& counters() const { return counters_; }
  std::size_t num_open() const { return open_.size(); }

 private:
  struct Known {
    int count = 0;  // of its kind; 0: chosen by name
    Time since;
    Time heard;  // where it never was: since when it is expected
    bool was_heard = false;
  };
  struct Reply {
    std::int64_t instance = 0;
    std::int64_t order = 0;  // of all replies
  };
  struct Scan {
    std::int64_t utime = 0, digest = 0;
    Time opened;
    std::int64_t bytes = 0;
    std::map<std::string, Reply> replies;  // by shard
    std::vector<ShardAnswer> answers;      // empty once joined
  };

  Known* FindOrAdd(const std::string& name, int count, Time now);
  // Counts it and returns true when the shard replied to this scan, or when the scan was joined.
  bool IsTooLate(const ShardAnswer& answer, Scan* scan, bool is_joined);
  static bool Precedes(const Scan& a, const Scan& b);
  bool HasGoneOn(const std::string& shard, const Scan& scan) const;
  std::vector<std::string> Awaited(const Scan& scan, Time now) const;
  AnsweredScan Close(std::size_t index, Time now);
  void Forget(Time now);

  ShardJoinerParams params_;
  Time begin_;
  ShardCounters counters_;
  std::map<std::string, Known> shards_;
  std::vector<Scan> open_;  // by their first answer
  struct Joined {
    Scan scan;
    Time when;
  };
  std::deque<Joined> joined_;  // oldest first
};

}  // namespace rimod
