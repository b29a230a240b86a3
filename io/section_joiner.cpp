#include "io/section_joiner.h"

#include <algorithm>
#include <functional>
#include <string_view>

#include "io/message_codec.h"
#include "io/section_header.h"

namespace rimod {
namespace {

// Of the section's bytes; never 0. Of this process only.
template <typename Section>
std::uint64_t DigestOf(const Section& section) {
  const std::vector<std::uint8_t> bytes = EncodeMessage(section);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return std::hash<std::string_view>()(text) | 1u;
}

}  // namespace

SectionJoinerParams JoinerParamsFrom(const BusParams& bus) {
  SectionJoinerParams params;
  params.patience = std::chrono::milliseconds(static_cast<int>(1e3 * bus.join_patience));
  return params;
}

template <typename Section>
SectionJoiner<Section>::SectionJoiner(const SectionJoinerParams& params) : params_(params) {}

template <typename Section>
std::optional<std::vector<Section>> SectionJoiner<Section>::Add(Section section, Time now) {
  ++counters_.sections;
  GiveUpStale(now);
  if (section.num_sections < 1 || section.num_sections > params_.max_sections ||
      section.section < 0 || section.section >= section.num_sections) {
    ++counters_.bad_numbers;
    return std::nullopt;
  }
  if (IsLate(section, now)) {
    ++counters_.late;
    return std::nullopt;
  }
  Whole* const whole = FindOrOpen(section, now);
  std::optional<Section>& slot = whole->sections[static_cast<std::size_t>(section.section)];
  if (slot) {
    if (EncodeMessage(*slot) == EncodeMessage(section)) {
      ++counters_.duplicated;
    } else {
      GiveUp(whole, &counters_.conflicting, now);
      Closed& closed = closed_.back();
      closed.turned_away.assign(closed.digests.size(), false);
      closed.turned_away[static_cast<std::size_t>(section.section)] = true;
    }
    return std::nullopt;
  }
  whole->bytes += section.getEncodedSize();
  whole->last_change = now;
  whole->highest = std::max(whole->highest, static_cast<int>(section.section));
  slot = std::move(section);
  ++whole->num_present;
  if (whole->num_present == static_cast<int>(whole->sections.size())) return Complete(whole, now);
  KeepWithinBounds(now);
  return std::nullopt;
}

template <typename Section>
void SectionJoiner<Section>::GiveUpStale(Time now) {
  closed_.erase(
      std::remove_if(closed_.begin(), closed_.end(),
                     [&](const Closed& item) { return now - item.when > params_.memory; }),
      closed_.end());
  for (std::size_t i = open_.size(); i-- > 0;) {
    if (now - open_[i].last_change > params_.patience) {
      GiveUp(&open_[i], &counters_.incomplete, now);
    }
  }
}

template <typename Section>
bool SectionJoiner<Section>::IsLate(const Section& section, Time now) {
  const auto closed = std::find_if(closed_.begin(), closed_.end(), [&section](const Closed& item) {
    return SameHeader(item.header, section);
  });
  if (closed == closed_.end()) return false;
  const auto number = static_cast<std::size_t>(section.section);
  const std::uint64_t known = closed->digests[number];
  const bool is_another = known != 0 && known != DigestOf(section);
  if (is_another || !closed->turned_away.empty()) TurnAway(number, &*closed, now);
  return true;
}

// As long as others of the name go on coming, none of them is begun in its midst.
template <typename Section>
void SectionJoiner<Section>::TurnAway(std::size_t number, Closed* closed, Time now) {
  if (closed->turned_away.empty() || closed->turned_away[number]) {
    ++counters_.same_name;
    closed->turned_away.assign(closed->digests.size(), false);
  }
  closed->turned_away[number] = true;
  closed->when = now;
}

template <typename Section>
typename SectionJoiner<Section>::Whole* SectionJoiner<Section>::FindOrOpen(const Section& section,
                                                                           Time now) {
  const auto same = std::find_if(open_.begin(), open_.end(), [&section](const Whole& whole) {
    return SameHeader(whole.header, section);
  });
  if (same != open_.end() && !BeginsAnew(*same, section, now)) return &*same;
  if (same != open_.end()) {
    ++counters_.incomplete;
    open_.erase(same);  // not remembered: this one has its name
  }
  if (static_cast<int>(open_.size()) >= params_.max_open) {
    GiveUp(Oldest(), &counters_.incomplete, now);
  }
  open_.push_back({HeaderOf(section), {}, 0, -1, 0, now});
  open_.back().sections.resize(static_cast<std::size_t>(section.num_sections));
  return &open_.back();
}

template <typename Section>
bool SectionJoiner<Section>::BeginsAnew(const Whole& whole, const Section& section,
                                        Time now) const {
  return section.section <= whole.highest && now - whole.last_change > params_.disorder;
}

template <typename Section>
typename SectionJoiner<Section>::Whole* SectionJoiner<Section>::Oldest() {
  return &*std::min_element(open_.begin(), open_.end(), [](const Whole& a, const Whole& b) {
    return a.last_change < b.last_change;
  });
}

template <typename Section>
std::vector<Section> SectionJoiner<Section>::Complete(Whole* whole, Time now) {
  Remember(whole, now);
  std::vector<Section> sections;
  sections.reserve(whole->sections.size());
  for (std::optional<Section>& section : whole->sections) sections.push_back(std::move(*section));
  open_.erase(open_.begin() + (whole - open_.data()));
  ++counters_.completed;
  return sections;
}

template <typename Section>
void SectionJoiner<Section>::GiveUp(Whole* whole, std::int64_t* cause, Time now) {
  ++*cause;
  Remember(whole, now);
  open_.erase(open_.begin() + (whole - open_.data()));
}

template <typename Section>
void SectionJoiner<Section>::Remember(Whole* whole, Time now) {
  std::vector<std::uint64_t> digests;
  digests.reserve(whole->sections.size());
  for (const std::optional<Section>& section : whole->sections)
    digests.push_back(section ? DigestOf(*section) : 0);
  closed_.push_back({std::move(whole->header), std::move(digests), now, {}});
  constexpr std::size_t kMaxRemembered = 64;  // far more than end within the time of memory
  if (closed_.size() > kMaxRemembered) closed_.pop_front();
}

template <typename Section>
void SectionJoiner<Section>::KeepWithinBounds(Time now) {
  const auto total_bytes = [this] {
    std::int64_t bytes = 0;
    for (const Whole& whole : open_) bytes += whole.bytes;
    return bytes;
  };
  while (!open_.empty() && total_bytes() > params_.max_bytes) {
    GiveUp(Oldest(), &counters_.incomplete, now);
  }
}

template class SectionJoiner<scan_t>;
template class SectionJoiner<range_image_t>;
template class SectionJoiner<feature_set_t>;
template class SectionJoiner<object_model_t>;
template class SectionJoiner<shard_candidates_t>;

}  // namespace rimod
