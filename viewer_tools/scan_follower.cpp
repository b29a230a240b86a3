#include "viewer_tools/scan_follower.h"

#include <algorithm>
#include <utility>

#include "io/detection_messages.h"
#include "io/early_messages.h"
#include "io/feature_messages.h"
#include "io/message_codec.h"
#include "io/range_image_messages.h"
#include "rimod/partial_feature_set_t.hpp"
#include "rimod/partial_range_image_t.hpp"

namespace rimod {
namespace {

// Scans and looks that are remembered: results come some scans later at most.
constexpr std::size_t kMaxSlots = 8;

}  // namespace

ScanFollower::ScanFollower(const Channels& channels, const BusParams& params)
    : channels_(channels),
      image_joiner_(JoinerParamsFrom(params)),
      feature_joiner_(JoinerParamsFrom(params)),
      partial_image_joiner_(JoinerParamsFrom(params)),
      partial_feature_joiner_(JoinerParamsFrom(params)) {}

std::vector<std::string> ScanFollower::channel_names() const {
  return {channels_.range_image,     channels_.features,         channels_.hypotheses,
          channels_.detections,      channels_.early_detections, channels_.partial_range_image,
          channels_.partial_features};
}

std::string ScanFollower::Take(const std::string& channel, const void* bytes, std::size_t size,
                               Clock now) {
  if (channel == channels_.range_image) return TakeSection<range_image_t>(bytes, size, now);
  if (channel == channels_.features) return TakeSection<feature_set_t>(bytes, size, now);
  if (channel == channels_.hypotheses) return TakeResult<pose_hypotheses_t>(bytes, size);
  if (channel == channels_.detections) return TakeResult<detections_t>(bytes, size);
  if (channel == channels_.early_detections) return TakeResult<early_detections_t>(bytes, size);
  if (channel == channels_.partial_range_image)
    return TakePartial<partial_range_image_t>(bytes, size, now);
  if (channel == channels_.partial_features)
    return TakePartial<partial_feature_set_t>(bytes, size, now);
  return "";
}

template <typename Message>
std::string ScanFollower::TakeSection(const void* bytes, std::size_t size, Clock now) {
  Decoded<Message> decoded = DecodeMessage<Message>(bytes, size);
  if (!decoded.message) return decoded.error;
  const std::int64_t utime = decoded.message->utime;
  SectionJoiner<Message>* const joiner = JoinerFor(*decoded.message, /*is_partial=*/false);
  const auto sections = joiner->Add(std::move(*decoded.message), now);
  return sections ? Put(*sections, utime, 0) : "";
}

template <typename Message>
std::string ScanFollower::TakePartial(const void* bytes, std::size_t size, Clock now) {
  Decoded<Message> decoded = DecodeMessage<Message>(bytes, size);
  if (!decoded.message) return decoded.error;
  const std::int64_t known_until = decoded.message->section.utime;
  auto* const joiner = JoinerFor(decoded.message->section, /*is_partial=*/true);
  const auto sections = joiner->Add(std::move(decoded.message->section), now);
  return sections ? Put(*sections, decoded.message->utime, known_until) : "";
}

template <typename Message>
std::string ScanFollower::TakeResult(const void* bytes, std::size_t size) {
  const Decoded<Message> decoded = DecodeMessage<Message>(bytes, size);
  return decoded.message ? Put(*decoded.message) : decoded.error;
}

std::string ScanFollower::Put(const std::vector<range_image_t>& sections, std::int64_t utime,
                              std::int64_t known_until) {
  JoinedRangeImage joined = JoinRangeImageSections(sections);
  if (!joined.image) return joined.error;
  Slot slot = std::move(*FindOrAdd(utime, known_until));
  // A scan that is sent once more, longer: what was found in the shorter one is out of date.
  if (slot.scan.image) {
    slot = Slot();
    slot.scan.utime = utime;
    slot.scan.known_until = known_until;
  }
  slot.scan.image = std::move(joined.image);
  const auto has_key = [&](const Slot& other) {
    return other.scan.utime == utime && other.scan.known_until == known_until;
  };
  slots_.erase(std::find_if(slots_.begin(), slots_.end(), has_key));
  slots_.push_back(std::move(slot));
  ++version_;
  return "";
}

std::string ScanFollower::Put(const std::vector<feature_set_t>& sections, std::int64_t utime,
                              std::int64_t known_until) {
  JoinedFeatures joined = JoinFeatureSections(sections);
  if (!joined.features) return joined.error;
  Slot* const slot = FindOrAdd(utime, known_until);
  slot->scan.features = std::move(joined.features);
  Changed(*slot);
  return "";
}

std::string ScanFollower::Put(const pose_hypotheses_t& message) {
  HypothesesFromMessage converted = FromMessage(message);
  if (!converted.hypotheses) return converted.error;
  Slot* const slot = FindOrAdd(message.utime, 0);
  slot->scan.hypotheses = {message.num_found, std::move(*converted.hypotheses)};
  Changed(*slot);
  return "";
}

std::string ScanFollower::Put(const detections_t& message) {
  DetectionsFromMessage converted = FromMessage(message);
  if (!converted.detections) return converted.error;
  Slot* const slot = FindOrAdd(message.utime, 0);
  slot->scan.detections = std::move(converted.detections);
  Changed(*slot);
  Deliver(slot);
  return "";
}

std::string ScanFollower::Put(const early_detections_t& message) {
  EarlyObjectsFromMessage converted = FromMessage(message);
  if (!converted.early) return converted.error;
  if (converted.early->is_final) return "";  // the detections themselves tell it
  Slot* const slot = FindOrAdd(message.utime, message.utime_end);
  slot->scan.early = std::move(converted.early);
  Changed(*slot);
  Deliver(slot);
  return "";
}

ScanFollower::Slot* ScanFollower::FindOrAdd(std::int64_t utime, std::int64_t known_until) {
  for (Slot& slot : slots_)
    if (slot.scan.utime == utime && slot.scan.known_until == known_until) return &slot;
  Slot added;
  added.scan.utime = utime;
  added.scan.known_until = known_until;
  // What was told of the sweep stays in sight until this look at it says something new.
  for (const Slot& slot : slots_)
    if (slot.scan.utime == utime && slot.scan.is_partial()) added.scan.early = slot.scan.early;
  if (slots_.size() >= kMaxSlots) {
    Deliver(&slots_.front());
    slots_.pop_front();
  }
  // Before those with an image, which are ordered by it.
  slots_.push_front(std::move(added));
  return &slots_.front();
}

void ScanFollower::Changed(const Slot& slot) {
  if (&slot.scan == newest()) ++version_;
}

void ScanFollower::Deliver(Slot* slot) {
  if (slot->delivered || !slot->scan.image) return;
  slot->delivered = true;
  if (finished_.size() >= kMaxSlots) finished_.erase(finished_.begin());  // nobody takes them
  finished_.push_back(slot->scan);
}

const ViewedScan* ScanFollower::newest() const {
  return slots_.empty() || !slots_.back().scan.image ? nullptr : &slots_.back().scan;
}

std::vector<ViewedScan> ScanFollower::TakeFinished() { return std::exchange(finished_, {}); }

std::vector<ViewedScan> ScanFollower::TakeRest() {
  for (Slot& slot : slots_) Deliver(&slot);
  return TakeFinished();
}

}  // namespace rimod
