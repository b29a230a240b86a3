#include "io/section_joiner.h"

#include <algorithm>

#include "io/message_codec.h"
#include "io/section_header.h"

namespace rimod {

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
  if (IsLate(section)) {
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
    }
    return std::nullopt;
  }
  whole->bytes += section.getEncodedSize();
  whole->last_change = now;
  slot = std::move(section);
  ++whole->num_present;
  if (whole->num_present == static_cast<int>(whole->sections.size())) return Complete(whole, now);
  KeepWithinBounds(now);
  return std::nullopt;
}

template <typename Section>
void SectionJoiner<Section>::GiveUpStale(Time now) {
  while (!closed_.empty() && now - closed_.front().when > params_.memory) closed_.pop_front();
  for (std::size_t i = open_.size(); i-- > 0;) {
    if (now - open_[i].last_change > params_.patience) {
      GiveUp(&open_[i], &counters_.incomplete, now);
    }
  }
}

template <typename Section>
bool SectionJoiner<Section>::IsLate(const Section& section) const {
  return std::any_of(closed_.begin(), closed_.end(), [&section](const Closed& closed) {
    return SameHeader(closed.header, section);
  });
}

template <typename Section>
typename SectionJoiner<Section>::Whole* SectionJoiner<Section>::FindOrOpen(const Section& section,
                                                                           Time now) {
  for (Whole& whole : open_) {
    if (SameHeader(whole.header, section)) return &whole;
  }
  if (static_cast<int>(open_.size()) >= params_.max_open) {
    GiveUp(Oldest(), &counters_.incomplete, now);
  }
  open_.push_back({HeaderOf(section), {}, 0, 0, now});
  open_.back().sections.resize(static_cast<std::size_t>(section.num_sections));
  return &open_.back();
}

template <typename Section>
typename SectionJoiner<Section>::Whole* SectionJoiner<Section>::Oldest() {
  return &*std::min_element(open_.begin(), open_.end(), [](const Whole& a, const Whole& b) {
    return a.last_change < b.last_change;
  });
}

template <typename Section>
std::vector<Section> SectionJoiner<Section>::Complete(Whole* whole, Time now) {
  std::vector<Section> sections;
  sections.reserve(whole->sections.size());
  for (std::optional<Section>& section : whole->sections) sections.push_back(std::move(*section));
  GiveUp(whole, &counters_.completed, now);
  return sections;
}

template <typename Section>
void SectionJoiner<Section>::GiveUp(Whole* whole, std::int64_t* cause, Time now) {
  ++*cause;
  closed_.push_back({std::move(whole->header), now});
  constexpr std::size_t kMaxRemembered = 64;  // far more than end within the time of memory
  if (closed_.size() > kMaxRemembered) closed_.pop_front();
  open_.erase(open_.begin() + (whole - open_.data()));
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
