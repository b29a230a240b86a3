#include "viewer_tools/meldis_messages.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

#include "io/message_codec.h"
#include "viewer_tools/palette.h"
#include "viewer_tools/range_colours.h"

namespace rimod {
namespace {

using Geometry = drake::lcmt_viewer_geometry_data;

constexpr int kFixedBytes = 2000;         // all but the records of a cloud, generously
constexpr std::size_t kRecordBytes = 16;  // x, y, z, colour
constexpr std::size_t kMaxBoxes = 500;    // some 150 bytes each in a scene
constexpr char kSensorName[] = "rimod::sensor";

static_assert(kFixedBytes + 300 * kMaxBoxes < kMaxMessageBytes, "all boxes fit");

std::string LinkName(const Detection& detection, std::size_t rank) {
  return "rimod::" + detection.class_name + "_" + std::to_string(rank);
}

void SetIdentity(float (&quaternion)[4]) {
  quaternion[0] = 1.0f;
  quaternion[1] = quaternion[2] = quaternion[3] = 0.0f;
}

Geometry Shape(std::int8_t type, const Eigen::Vector3d& centre, const Colour& colour, float opacity,
               std::vector<float> sizes) {
  Geometry shape = {};
  shape.type = type;
  for (int i = 0; i < 3; ++i) {
    shape.position[i] = static_cast<float>(centre[i]);
    shape.color[i] = static_cast<float>(colour[2 - i]) / 255.0f;  // ours: blue, green, red
  }
  SetIdentity(shape.quaternion);
  shape.color[3] = opacity;
  shape.num_float_data = static_cast<std::int32_t>(sizes.size());
  shape.float_data = std::move(sizes);
  return shape;
}

drake::lcmt_viewer_link_data Link(std::string name, Geometry shape) {
  drake::lcmt_viewer_link_data link = {};
  link.name = std::move(name);
  link.geom.push_back(std::move(shape));
  link.num_geom = 1;
  return link;
}

void AddPose(std::string name, const Eigen::Isometry3d& T_local_link,
             drake::lcmt_viewer_draw* message) {
  const Eigen::Quaternionf turn(Eigen::Quaterniond(T_local_link.linear()));
  message->link_name.push_back(std::move(name));
  message->robot_num.push_back(0);
  message->position.push_back({static_cast<float>(T_local_link.translation().x()),
                               static_cast<float>(T_local_link.translation().y()),
                               static_cast<float>(T_local_link.translation().z())});
  message->quaternion.push_back({turn.w(), turn.x(), turn.y(), turn.z()});
  ++message->num_links;
}

drake::lcmt_point_cloud_field Field(const char* name, std::int32_t offset, std::int8_t type) {
  drake::lcmt_point_cloud_field field = {};
  field.name = name;
  field.byte_offset = offset;
  field.datatype = type;
  field.count = 1;
  return field;
}

// A record as meldis wants it: three floats, then red, green, blue and a spare byte.
void AppendRecord(const Eigen::Vector3f& p_local, const Colour& colour,
                  std::vector<std::uint8_t>* data) {
  const std::size_t at = data->size();
  data->resize(at + kRecordBytes);
  std::memcpy(data->data() + at, p_local.data(), 3 * sizeof(float));
  for (std::size_t i = 0; i < 3; ++i) (*data)[at + 12 + i] = colour[static_cast<int>(2 - i)];
}

struct Placed {
  Eigen::Vector3f p_local;
  float range = 0.0f;
};

std::vector<Placed> PlacedPoints(const RangeImage& image) {
  std::vector<Placed> points;
  const Eigen::Isometry3f T_local_sensor = image.T_local_sensor().cast<float>();
  for (int row = 0; row < image.height(); ++row)
    for (int column = 0; column < image.width(); ++column)
      if (image.measured(row, column))
        points.push_back({T_local_sensor * image.point(row, column), image.range(row, column)});
  return points;
}

}  // namespace

drake::lcmt_viewer_load_robot MeldisScene(const std::vector<Detection>& detections) {
  std::vector<std::string> names;
  for (const Detection& detection : detections) names.push_back(detection.class_name);
  const std::vector<Colour> colours = ColoursByName(names);
  drake::lcmt_viewer_load_robot message = {};
  message.link.push_back(Link(kSensorName, Shape(Geometry::SPHERE, Eigen::Vector3d::Zero(),
                                                 Colour(255, 255, 255), 1.0f, {0.05f})));
  for (std::size_t i = 0; i < std::min(detections.size(), kMaxBoxes); ++i) {
    constexpr float kOpacity = 0.45f;
    constexpr double kLeastSize = 1e-3;  // m; viewers refuse flat boxes
    const Detection& detection = detections[i];
    const Eigen::Vector3f size =
        (detection.box_max - detection.box_min).cwiseMax(kLeastSize).cast<float>();
    message.link.push_back(Link(LinkName(detection, i),
                                Shape(Geometry::BOX, 0.5 * (detection.box_min + detection.box_max),
                                      colours[i], kOpacity, {size.x(), size.y(), size.z()})));
  }
  message.num_links = static_cast<std::int32_t>(message.link.size());
  return message;
}

drake::lcmt_viewer_draw MeldisPoses(const std::vector<Detection>& detections,
                                    const Eigen::Isometry3d& T_local_sensor, std::int64_t utime) {
  drake::lcmt_viewer_draw message = {};
  message.timestamp = utime / 1000;
  AddPose(kSensorName, T_local_sensor, &message);
  for (std::size_t i = 0; i < std::min(detections.size(), kMaxBoxes); ++i)
    AddPose(LinkName(detections[i], i), detections[i].T_local_object, &message);
  return message;
}

drake::lcmt_point_cloud MeldisCloud(const RangeImage& image, std::int64_t utime) {
  const std::vector<Placed> points = PlacedPoints(image);
  std::vector<float> ranges;
  for (const Placed& point : points) ranges.push_back(point.range);
  const RangeSpan span = SpanOf(std::move(ranges), 0.01, 0.1);
  constexpr std::size_t kMaxPoints = (kMaxMessageBytes - kFixedBytes) / kRecordBytes;
  const std::size_t step = points.size() / kMaxPoints + 1;

  drake::lcmt_point_cloud message = {};
  message.utime = utime;
  message.frame_name = "local";
  for (std::size_t i = 0; i < points.size(); i += step)
    AppendRecord(points[i].p_local, RangeColour(span.Share(points[i].range)), &message.data);
  message.data_size = static_cast<std::int64_t>(message.data.size());
  message.width = message.data_size / static_cast<std::int64_t>(kRecordBytes);
  message.height = 1;
  message.fields = {Field("x", 0, drake::lcmt_point_cloud_field::FLOAT32),
                    Field("y", 4, drake::lcmt_point_cloud_field::FLOAT32),
                    Field("z", 8, drake::lcmt_point_cloud_field::FLOAT32),
                    Field("rgb", 12, drake::lcmt_point_cloud_field::UINT32)};
  message.num_fields = static_cast<std::int32_t>(message.fields.size());
  message.flags = drake::lcmt_point_cloud::IS_STRICTLY_FINITE;
  message.point_step = kRecordBytes;
  message.row_step = message.data_size;
  return message;
}

}  // namespace rimod
