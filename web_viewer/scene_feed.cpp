#include "web_viewer/scene_feed.h"

#include <utility>

#include "io/detection_messages.h"
#include "io/early_messages.h"
#include "io/message_codec.h"
#include "io/range_image_messages.h"
#include "io/scan_messages.h"

namespace rimod {

SceneFeed::SceneFeed(const Channels& channels, const BusParams& bus, ScanHistory* history)
    : channels_(channels),
      scan_joiner_(JoinerParamsFrom(bus)),
      image_joiner_(JoinerParamsFrom(bus)),
      history_(history) {}

std::vector<std::string> SceneFeed::channel_names() const {
  return {channels_.scan, channels_.range_image, channels_.detections, channels_.hypotheses,
          channels_.early_detections};
}

TakenMessage SceneFeed::Take(const std::string& channel, const void* bytes, std::size_t size,
                             Time now) {
  if (channel == channels_.scan) return TakeScan(bytes, size, now);
  if (channel == channels_.range_image) return TakeRangeImage(bytes, size, now);
  if (channel == channels_.detections) return TakeDetections(bytes, size);
  if (channel == channels_.hypotheses) return TakeHypotheses(bytes, size);
  if (channel == channels_.early_detections) return TakeEarlyDetections(bytes, size);
  return {};
}

void SceneFeed::GiveUpStale(Time now) {
  scan_joiner_.GiveUpStale(now);
  image_joiner_.GiveUpStale(now);
}

TakenMessage SceneFeed::TakeScan(const void* bytes, std::size_t size, Time now) {
  Decoded<scan_t> decoded = DecodeMessage<scan_t>(bytes, size);
  if (!decoded.message) return {decoded.error};
  const auto sections = scan_joiner_.Add(std::move(*decoded.message), now);
  if (!sections) return {};
  const JoinedScan joined = JoinScanSections(*sections);
  if (!joined.scan) return {joined.error};
  history_->SetScan(joined.scan->utime, joined.scan->scan);
  return {"", /*completed_scan=*/true, false};
}

TakenMessage SceneFeed::TakeRangeImage(const void* bytes, std::size_t size, Time now) {
  Decoded<range_image_t> decoded = DecodeMessage<range_image_t>(bytes, size);
  if (!decoded.message) return {decoded.error};
  const std::int64_t utime = decoded.message->utime;
  const auto sections = image_joiner_.Add(std::move(*decoded.message), now);
  if (!sections) return {};
  const JoinedRangeImage joined = JoinRangeImageSections(*sections);
  if (!joined.image) return {joined.error};
  history_->SetRangeImage(utime, *joined.image);
  return {"", /*completed_scan=*/true, false};
}

TakenMessage SceneFeed::TakeDetections(const void* bytes, std::size_t size) {
  const Decoded<detections_t> decoded = DecodeMessage<detections_t>(bytes, size);
  if (!decoded.message) return {decoded.error};
  const DetectionsFromMessage converted = FromMessage(*decoded.message);
  if (!converted.detections) return {converted.error};
  history_->SetDetections(*converted.detections);
  return {"", false, /*has_detections=*/true};
}

TakenMessage SceneFeed::TakeHypotheses(const void* bytes, std::size_t size) {
  const Decoded<pose_hypotheses_t> decoded = DecodeMessage<pose_hypotheses_t>(bytes, size);
  if (!decoded.message) return {decoded.error};
  HypothesesFromMessage converted = FromMessage(*decoded.message);
  if (!converted.hypotheses) return {converted.error};
  history_->SetHypotheses(decoded.message->utime, std::move(*converted.hypotheses),
                          decoded.message->num_found);
  return {};
}

TakenMessage SceneFeed::TakeEarlyDetections(const void* bytes, std::size_t size) {
  const Decoded<early_detections_t> decoded = DecodeMessage<early_detections_t>(bytes, size);
  if (!decoded.message) return {decoded.error};
  const EarlyObjectsFromMessage converted = FromMessage(*decoded.message);
  if (!converted.early) return {converted.error};
  history_->SetEarlyObjects(*converted.early);
  return {};
}

}  // namespace rimod
