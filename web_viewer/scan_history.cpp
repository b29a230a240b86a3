#include "web_viewer/scan_history.h"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

namespace rimod {
namespace {

using Json = nlohmann::ordered_json;

Scan ScanOf(const RangeImage& image) {
  Scan scan;
  scan.T_local_sensor = image.T_local_sensor();
  for (int row = 0; row < image.height(); ++row) {
    for (int column = 0; column < image.width(); ++column) {
      if (!image.measured(row, column)) continue;
      const Eigen::Vector3d p_local =
          image.T_local_sensor() * image.point(row, column).cast<double>();
      scan.points.push_back(p_local.cast<float>());
    }
  }
  return scan;
}

double TotalOf(const StageTimes& times) {
  for (const auto& [stage, ms] : times)
    if (stage == "total") return ms;
  return 0.0;
}

}  // namespace

std::size_t ScanHistory::Entry::bytes() const {
  constexpr std::size_t kFixed = 1000;  // of an entry without frames, generously
  std::size_t sum = kFixed;
  if (scan.frame) sum += scan.frame->size();
  if (objects_part.frame) sum += 2 * objects_part.frame->size();  // and the objects themselves
  return sum;
}

void ScanHistory::SetScan(std::int64_t utime, const Scan& scan) {
  StoreScan(utime, scan, Source::kScan);
}

void ScanHistory::SetRangeImage(std::int64_t utime, const RangeImage& image) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const Entry& entry : entries_)
      if (entry.utime == utime && entry.source == Source::kScan) return;
  }
  StoreScan(utime, ScanOf(image), Source::kRangeImage);
}

void ScanHistory::StoreScan(std::int64_t utime, const Scan& scan, Source source) {
  std::int64_t id = 0;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    id = FindOrAdd(utime)->id;
  }
  Frame frame = ScanFrame(id, utime, scan);  // takes milliseconds: nobody waits meanwhile
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto entry = std::find_if(entries_.begin(), entries_.end(),
                                    [id](const Entry& other) { return other.id == id; });
    if (entry == entries_.end()) return;
    entry->source = source;
    entry->num_points = scan.points.size();
    entry->scan = {++last_version_, std::move(frame)};
    entries_.splice(entries_.end(), entries_, entry);
    MarkChanged();
  }
  on_change_();
}

void ScanHistory::SetDetections(const StampedDetections& detections) {
  ChangeObjects(detections.utime, [&](SceneObjects* objects) {
    objects->detections = detections.detections;
    objects->num_models = detections.num_models;
    objects->detection_ms = TotalOf(detections.stage_times);
    objects->T_local_sensor = detections.T_local_sensor;
  });
}

void ScanHistory::SetHypotheses(std::int64_t utime, std::vector<PoseHypothesis> hypotheses,
                                int num_found) {
  ChangeObjects(utime, [&](SceneObjects* objects) {
    objects->hypotheses = std::move(hypotheses);
    objects->num_hypotheses = num_found;
  });
}

void ScanHistory::SetEarlyObjects(const StampedEarlyObjects& early) {
  ChangeObjects(early.utime, [&](SceneObjects* objects) {
    objects->early.clear();
    if (early.is_final) return;
    objects->early = early.objects;
    objects->num_models = early.num_models;
    objects->T_local_sensor = early.T_local_sensor;
  });
}

void ScanHistory::ChangeObjects(std::int64_t utime,
                                const std::function<void(SceneObjects*)>& change) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    Entry* const entry = FindOrAdd(utime);
    change(&entry->objects);
    entry->objects_part = {++last_version_, ObjectsFrame(entry->id, utime, entry->objects)};
    MarkChanged();
  }
  on_change_();
}

ScanHistory::Entry* ScanHistory::FindOrAdd(std::int64_t utime) {
  for (Entry& entry : entries_)
    if (entry.utime == utime) return &entry;
  Entry entry;
  entry.id = ++last_id_;
  entry.utime = utime;
  entries_.push_back(std::move(entry));
  ForgetOldest();
  return &entries_.back();
}

const ScanHistory::Entry* ScanHistory::Find(std::int64_t id) const {
  for (const Entry& entry : entries_)
    if (entry.id == id) return &entry;
  return nullptr;
}

void ScanHistory::MarkChanged() {
  timeline_version_ = ++last_version_;
  ForgetOldest();
}

void ScanHistory::ForgetOldest() {
  std::size_t bytes = 0;
  for (const Entry& entry : entries_) bytes += entry.bytes();
  while (entries_.size() > 1 &&
         (entries_.size() > limits_.max_scans || bytes > limits_.max_bytes)) {
    bytes -= entries_.front().bytes();
    entries_.pop_front();
  }
}

ScanHistory::Part ScanHistory::ScanPart(std::optional<std::int64_t> id) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (id) {
    const Entry* const entry = Find(*id);
    return entry == nullptr ? Part{} : entry->scan;
  }
  for (auto entry = entries_.rbegin(); entry != entries_.rend(); ++entry)
    if (entry->scan.frame) return entry->scan;
  return {};
}

ScanHistory::Part ScanHistory::ObjectsPart(std::optional<std::int64_t> id) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (id) {
    const Entry* const entry = Find(*id);
    return entry == nullptr ? Part{} : entry->objects_part;
  }
  for (auto entry = entries_.rbegin(); entry != entries_.rend(); ++entry)
    if (entry->objects.detections || !entry->objects.early.empty()) return entry->objects_part;
  return {};
}

ScanHistory::Part ScanHistory::TimelinePart() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (timeline_.frame && timeline_.version == timeline_version_) return timeline_;
  Json scans = Json::array();
  for (const Entry& entry : entries_) {
    Json scan = {{"id", entry.id},
                 {"utime", std::to_string(entry.utime)},
                 {"num_points", entry.num_points},
                 {"num_detections", nullptr}};
    if (entry.objects.detections) scan["num_detections"] = entry.objects.detections->size();
    scans.push_back(std::move(scan));
  }
  const Json header = {{"type", "timeline"}, {"scans", std::move(scans)}};
  timeline_ = {timeline_version_, MakeFrame(header.dump())};
  return timeline_;
}

bool ScanHistory::Has(std::int64_t id) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return Find(id) != nullptr;
}

}  // namespace rimod
