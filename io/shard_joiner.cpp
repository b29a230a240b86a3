#include "io/shard_joiner.h"

#include <algorithm>
#include <utility>

namespace rimod {
namespace {

constexpr std::size_t kMaxJoined = 256;

std::int64_t BytesOf(const JudgedScan& judged) {
  std::size_t bytes = judged.models.size() * sizeof(CandidateModel);
  for (const ExplainingCandidate& candidate : judged.candidates)
    bytes += sizeof candidate + candidate.explained.size() * sizeof(PixelRun);
  return static_cast<std::int64_t>(bytes);
}

}  // namespace

ShardJoinerParams ShardJoinerParamsFrom(const BusParams& bus) {
  ShardJoinerParams params;
  params.patience = std::chrono::milliseconds(static_cast<int>(1e3 * bus.shard_patience));
  return params;
}

ShardJoiner::ShardJoiner(const ShardJoinerParams& params, Time now)
    : params_(params), begin_(now) {}

ShardJoiner::Known* ShardJoiner::FindOrAdd(const std::string& name, int count, Time now) {
  const auto found = shards_.find(name);
  if (found != shards_.end()) return &found->second;
  if (shards_.size() >= static_cast<std::size_t>(kMaxShards)) {
    ++counters_.too_many;
    return nullptr;
  }
  return &shards_.emplace(name, Known{count, now, now, false}).first->second;
}

void ShardJoiner::Hear(const Shard& shard, Time now) {
  Forget(now);
  Known* const known = FindOrAdd(shard.name, shard.count, now);
  if (known == nullptr) return;
  if (now - known->heard > params_.silence) known->since = now;  // it has come back
  known->heard = now;
  known->was_heard = true;
  for (int i = 1; i <= shard.count; ++i)
    FindOrAdd(std::to_string(i) + "/" + std::to_string(shard.count), shard.count, now);
}

void ShardJoiner::Add(ShardAnswer answer, Time now) {
  ++counters_.answers;
  Hear(answer.shard, now);
  if (shards_.count(answer.shard.name) == 0) return;
  const auto is_its_scan = [&](const Scan& scan) {
    return scan.utime == answer.utime && scan.digest == answer.scan;
  };
  auto scan = std::find_if(open_.begin(), open_.end(), is_its_scan);
  if (scan != open_.end()) {
    if (IsTooLate(answer, &*scan, /*is_joined=*/false)) return;
  } else {
    for (Joined& joined : joined_)
      if (is_its_scan(joined.scan) && IsTooLate(answer, &joined.scan, /*is_joined=*/true)) return;
    open_.push_back({answer.utime, answer.scan, now, 0, {}, {}});
    scan = open_.end() - 1;
  }
  scan->replies[answer.shard.name] = {answer.shard.instance, counters_.answers};
  scan->bytes += BytesOf(answer.judged);
  scan->answers.push_back(std::move(answer));
}

bool ShardJoiner::IsTooLate(const ShardAnswer& answer, Scan* scan, bool is_joined) {
  const auto reply = scan->replies.find(answer.shard.name);
  if (reply == scan->replies.end()) {
    if (!is_joined) return false;
    ++counters_.late;
  } else if (reply->second.instance != answer.shard.instance) {
    ++counters_.twins;
  } else if (is_joined) {
    return false;  // the same scan again, as when a log is replayed
  } else {
    ++counters_.repeated;
  }
  if (is_joined) scan->replies[answer.shard.name] = {answer.shard.instance, counters_.answers};
  return true;
}

// What a shard answered first came first; where none answered both, time decides.
bool ShardJoiner::Precedes(const Scan& a, const Scan& b) {
  for (const auto& [shard, reply] : a.replies) {
    const auto other = b.replies.find(shard);
    if (other != b.replies.end()) return reply.order < other->second.order;
  }
  return a.utime < b.utime;
}

bool ShardJoiner::HasGoneOn(const std::string& shard, const Scan& scan) const {
  const auto shows_it = [&](const Scan& other) {
    return other.replies.count(shard) != 0 && Precedes(scan, other);
  };
  return std::any_of(open_.begin(), open_.end(), shows_it) ||
         std::any_of(joined_.begin(), joined_.end(),
                     [&](const Joined& joined) { return shows_it(joined.scan); });
}

std::vector<std::string> ShardJoiner::Awaited(const Scan& scan, Time now) const {
  std::vector<std::string> awaited;
  for (const auto& [name, known] : shards_) {
    const bool was_there = known.since <= scan.opened;
    const bool is_there = now - known.heard <= params_.silence;
    if (was_there && is_there && scan.replies.count(name) == 0 && !HasGoneOn(name, scan))
      awaited.push_back(name);
  }
  return awaited;
}

std::vector<AnsweredScan> ShardJoiner::TakeDecided(Time now) {
  Forget(now);
  std::vector<AnsweredScan> decided;
  const auto num_bytes = [this] {
    std::int64_t bytes = 0;
    for (const Scan& scan : open_) bytes += scan.bytes;
    return bytes;
  };
  while (open_.size() > static_cast<std::size_t>(params_.max_open) ||
         (!open_.empty() && num_bytes() > params_.max_open_bytes)) {
    decided.push_back(Close(0, now));
  }
  for (std::size_t i = 0; i < open_.size();) {
    const bool heard_enough = now - begin_ >= params_.listen && Awaited(open_[i], now).empty();
    if (heard_enough || now - open_[i].opened >= params_.patience) {
      decided.push_back(Close(i, now));
    } else {
      ++i;
    }
  }
  return decided;
}

AnsweredScan ShardJoiner::Close(std::size_t index, Time now) {
  Scan scan = std::move(open_[index]);
  open_.erase(open_.begin() + static_cast<std::ptrdiff_t>(index));
  AnsweredScan answered;
  answered.answers = std::move(scan.answers);
  scan.answers.clear();
  std::sort(answered.answers.begin(), answered.answers.end(),
            [](const ShardAnswer& a, const ShardAnswer& b) { return a.shard.name < b.shard.name; });
  for (const auto& [name, known] : shards_)
    if (known.since <= scan.opened && scan.replies.count(name) == 0)
      answered.without.push_back(name);
  joined_.push_back({std::move(scan), now});
  return answered;
}

std::vector<std::string> ShardJoiner::Present(Time now) const {
  std::vector<std::string> names;
  for (const auto& [name, known] : shards_)
    if (known.was_heard && now - known.heard <= params_.silence) names.push_back(name);
  return names;
}

std::vector<std::string> ShardJoiner::Missing(Time now) const {
  std::vector<std::string> names;
  for (const auto& [name, known] : shards_)
    if (now - known.heard > params_.silence) names.push_back(name);
  return names;
}

void ShardJoiner::Forget(Time now) {
  while (!joined_.empty() &&
         (now - joined_.front().when > params_.memory || joined_.size() > kMaxJoined)) {
    joined_.pop_front();
  }
  const auto is_there = [&](const Known& known) { return now - known.heard <= params_.silence; };
  for (auto it = shards_.begin(); it != shards_.end();) {
    const int count = it->second.count;
    const bool kind_is_there =
        count > 0 && std::any_of(shards_.begin(), shards_.end(), [&](const auto& other) {
          return other.second.count == count && other.second.was_heard && is_there(other.second);
        });
    const bool is_gone = now - it->second.heard > params_.forget && !kind_is_there;
    it = is_gone ? shards_.erase(it) : std::next(it);
  }
}

}  // namespace rimod
