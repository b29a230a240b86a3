#include "web_viewer/page_frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "io/pose_messages.h"
#include "rimod/range_image.h"

namespace rimod {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kAlignment = 8;
constexpr double kPi = 3.14159265358979323846;

std::size_t Padded(std::size_t size) { return (size + kAlignment - 1) / kAlignment * kAlignment; }

void AppendLittleEndian16(std::uint16_t value, std::string* bytes) {
  bytes->push_back(static_cast<char>(value & 0xff));
  bytes->push_back(static_cast<char>(value >> 8));
}

Json VectorJson(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Json PoseJson(const Eigen::Isometry3d& T) {
  const Eigen::Vector3d p = T.translation();
  const std::array<double, 4> q = QuaternionOf(T);
  return {p.x(), p.y(), p.z(), q[0], q[1], q[2], q[3]};
}

// Every stride-th of so many that at most max_drawn are left.
std::size_t StrideFor(std::size_t count, std::size_t max_drawn) {
  return count <= max_drawn ? 1 : (count + max_drawn - 1) / max_drawn;
}

// Points on a grid of 65536 steps along each axis of their bounding box.
struct SteppedPoints {
  Json header;  // count, origin, step
  std::string bytes;
};

SteppedPoints StepPoints(const std::vector<Eigen::Vector3f>& points) {
  constexpr double kSteps = 65535.0;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& point : points) box.extend(point.cast<double>().eval());
  if (points.empty()) box = Eigen::AlignedBox3d(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  const Eigen::Vector3d step = box.sizes() / kSteps;
  SteppedPoints stepped;
  stepped.header = {
      {"count", points.size()}, {"origin", VectorJson(box.min())}, {"step", VectorJson(step)}};
  stepped.bytes.reserve(points.size() * 6);
  for (const Eigen::Vector3f& point : points) {
    for (int axis = 0; axis < 3; ++axis) {
      const double offset = static_cast<double>(point[axis]) - box.min()[axis];
      const double steps = step[axis] > 0.0 ? std::clamp(offset / step[axis], 0.0, kSteps) : 0.0;
      AppendLittleEndian16(static_cast<std::uint16_t>(std::lround(steps)), &stepped.bytes);
    }
  }
  return stepped;
}

std::string FrameStart(std::string json) {
  json.resize(Padded(json.size() + 4) - 4, ' ');
  const auto size = static_cast<std::uint32_t>(json.size());
  std::string bytes;
  for (int shift = 0; shift < 32; shift += 8) {
    bytes.push_back(static_cast<char>(size >> shift & 0xff));
  }
  return bytes + json;
}

Frame FrameOf(const Json& header, const std::vector<std::string>& lists) {
  std::string bytes = FrameStart(header.dump(-1, ' ', false, Json::error_handler_t::replace));
  for (const std::string& list : lists) {
    bytes += list;
    bytes.resize(Padded(bytes.size()), '\0');
  }
  return std::make_shared<const std::string>(std::move(bytes));
}

std::vector<Eigen::Vector3f> DrawnPoints(const Scan& scan) {
  const Eigen::Vector3d sensor = scan.T_local_sensor.translation();
  const std::size_t stride = StrideFor(scan.points.size(), kMaxDrawnPoints);
  std::vector<Eigen::Vector3f> drawn;
  drawn.reserve(scan.points.size() / stride + 1);
  for (std::size_t i = 0; i < scan.points.size(); i += stride) {
    const double range = (scan.points[i].cast<double>() - sensor).norm();
    if (range <= kMaxDrawnRange) drawn.push_back(scan.points[i]);
  }
  return drawn;
}

// Which whole degrees of azimuth, and from where to where in elevation.
struct SeenDirections {
  std::array<bool, 360> degrees{};
  double bottom = kPi, top = -kPi;

  void Add(const Eigen::Vector3d& p_sensor) {
    if (!(p_sensor.squaredNorm() > 0.0)) return;
    const Direction direction = DirectionOf(p_sensor);
    const double degree = std::floor((direction.azimuth + kPi) * 180.0 / kPi);
    degrees[static_cast<std::size_t>(std::clamp(degree, 0.0, 359.0))] = true;
    bottom = std::min(bottom, direction.elevation);
    top = std::max(top, direction.elevation);
  }
};

// The longest run of unseen degrees around the circle: its first degree and its length.
std::pair<int, int> LongestGap(const std::array<bool, 360>& degrees) {
  std::pair<int, int> longest{0, 0};
  int length = 0;
  for (int i = 0; i < 720; ++i) {
    length = degrees[static_cast<std::size_t>(i % 360)] ? 0 : length + 1;
    if (length > longest.second && length <= 360) longest = {i - length + 1, length};
  }
  return longest;
}

Json DetectionJson(const Detection& detection) {
  return {{"class", detection.class_name},
          {"pose", PoseJson(detection.T_local_object)},
          {"box", {VectorJson(detection.box_min), VectorJson(detection.box_max)}},
          {"score", detection.score}};
}

Json HypothesesJson(const std::vector<PoseHypothesis>& hypotheses) {
  static constexpr std::array<const char*, 4> kStages = {"scored", "pruned", "no collision",
                                                         "validated"};
  Json list = Json::array();
  for (const PoseHypothesis& hypothesis : hypotheses) {
    if (list.size() == kMaxGhosts) break;
    list.push_back({{"class", hypothesis.class_name},
                    {"pose", PoseJson(hypothesis.T_local_object)},
                    {"score", hypothesis.score},
                    {"stage", kStages[static_cast<std::size_t>(hypothesis.stage)]}});
  }
  return list;
}

Json EarlyJson(const std::vector<EarlyObject>& objects) {
  Json list = Json::array();
  for (const EarlyObject& object : objects) {
    if (object.status == EarlyStatus::kWithdrawn) continue;
    Json item = DetectionJson(object.detection);
    item["id"] = object.id;
    item["unseen_share"] = object.unseen_share;
    list.push_back(std::move(item));
  }
  return list;
}

}  // namespace

Frame MakeFrame(std::string header) {
  return std::make_shared<const std::string>(FrameStart(std::move(header)));
}

FieldOfView FieldOfViewOf(const Scan& scan) {
  const Eigen::Isometry3d T_sensor_local = scan.T_local_sensor.inverse();
  SeenDirections seen;
  std::vector<double> ranges;
  ranges.reserve(scan.points.size());
  for (const Eigen::Vector3f& point : scan.points) {
    const Eigen::Vector3d p_sensor = T_sensor_local * point.cast<double>();
    seen.Add(p_sensor);
    ranges.push_back(p_sensor.norm());
  }
  for (const Eigen::Vector3f& direction : scan.no_return_directions) {
    seen.Add(T_sensor_local.linear() * direction.cast<double>());
  }
  if (seen.top < seen.bottom) return {};
  FieldOfView view;
  view.elevation_bottom = seen.bottom;
  view.elevation_top = seen.top;
  constexpr int kFullCircle = 10;  // degrees of gap that a full circle may have
  const auto [first, length] = LongestGap(seen.degrees);
  view.azimuth_right = length < kFullCircle ? -kPi : (first + length) * kPi / 180.0 - kPi;
  const int seen_degrees = length < kFullCircle ? 360 : 360 - length;
  view.azimuth_left = view.azimuth_right + seen_degrees * kPi / 180.0;
  if (!ranges.empty()) {
    const auto nine_tenths =
        ranges.begin() + static_cast<std::ptrdiff_t>(9 * (ranges.size() - 1) / 10);
    std::nth_element(ranges.begin(), nine_tenths, ranges.end());
    view.range = std::min(*nine_tenths, kMaxDrawnRange);
  }
  return view;
}

Frame ScanFrame(std::int64_t id, std::int64_t utime, const Scan& scan) {
  const FieldOfView view = FieldOfViewOf(scan);
  SteppedPoints points = StepPoints(DrawnPoints(scan));
  const Json header = {{"type", "scan"},
                       {"id", id},
                       {"utime", std::to_string(utime)},
                       {"sensor", PoseJson(scan.T_local_sensor)},
                       {"view",
                        {{"azimuth", {view.azimuth_right, view.azimuth_left}},
                         {"elevation", {view.elevation_bottom, view.elevation_top}},
                         {"range", view.range}}},
                       {"num_points", scan.points.size()},
                       {"points", std::move(points.header)}};
  return FrameOf(header, {points.bytes});
}

Frame ObjectsFrame(std::int64_t id, std::int64_t utime, const SceneObjects& objects) {
  Json header = {{"type", "objects"}, {"id", id}, {"utime", std::to_string(utime)}};
  header["detections"] = nullptr;
  if (objects.detections) {
    Json detections = Json::array();
    for (const Detection& detection : *objects.detections)
      detections.push_back(DetectionJson(detection));
    header["detections"] = std::move(detections);
  }
  header["num_models"] = objects.num_models;
  header["detection_ms"] = objects.detection_ms;
  header["sensor"] = nullptr;
  if (objects.T_local_sensor) header["sensor"] = PoseJson(*objects.T_local_sensor);
  header["hypotheses"] = HypothesesJson(objects.hypotheses);
  header["num_hypotheses"] = objects.num_hypotheses;
  header["early"] = EarlyJson(objects.early);
  return FrameOf(header, {});
}

Frame ModelFrame(const ObjectModel& model) {
  const std::size_t stride = StrideFor(model.points.size(), kMaxModelPoints);
  std::vector<Eigen::Vector3f> points;
  std::string normals;
  for (std::size_t i = 0; i < model.points.size(); i += stride) {
    points.push_back(model.points[i]);
    for (int axis = 0; axis < 3; ++axis) {
      const double steps = 127.0 * static_cast<double>(model.normals[i][axis]);
      normals.push_back(static_cast<char>(std::lround(std::clamp(steps, -127.0, 127.0))));
    }
    normals.push_back('\0');
  }
  SteppedPoints stepped = StepPoints(points);
  const Json header = {{"type", "model"},
                       {"name", model.name},
                       {"box", {VectorJson(model.box_min), VectorJson(model.box_max)}},
                       {"spacing", model.point_spacing * std::sqrt(static_cast<double>(stride))},
                       {"points", std::move(stepped.header)}};
  return FrameOf(header, {stepped.bytes, normals});
}

}  // namespace rimod
