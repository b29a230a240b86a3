#include "scanner_proc/ground_truth.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "io/pose_messages.h"

namespace rimod::simulation {
namespace {

// Numbers of people's interest, without the noise of their last digits.
double Rounded(double value, double step) {
  const double rounded = std::round(value / step) * step;
  // Through text, so that 0.1 stays 0.1; adding 0 turns -0 into 0.
  return std::stod(std::to_string(rounded)) + 0.0;
}

constexpr double kMicro = 1e-6;

nlohmann::ordered_json VectorJson(const Eigen::Vector3d& vector) {
  return {Rounded(vector.x(), kMicro), Rounded(vector.y(), kMicro), Rounded(vector.z(), kMicro)};
}

nlohmann::ordered_json PoseJson(const Eigen::Isometry3d& T) {
  nlohmann::ordered_json pose = VectorJson(T.translation());
  for (const double value : QuaternionOf(T)) pose.push_back(Rounded(value, kMicro));
  return pose;
}

}  // namespace

struct GroundTruth::Watched {
  Watched(const SceneObject& object, int index_in_scene)
      : class_name(object.class_name), index(index_in_scene), alone({object}) {
    const ObjectFrame frame = ObjectFrameOf(object);
    T_scene_object = frame.T_scene_object;
    const Eigen::AlignedBox3d box = BoundingBox(object);
    centre = object.T_scene_object * box.center();
    radius = 0.5 * box.diagonal().norm();
  }

  bool MayMeet(const Ray& ray) const {
    return ray.direction.cross(centre - ray.origin).norm() <= radius;
  }

  std::string class_name;
  int index;
  Eigen::Isometry3d T_scene_object;
  RayCaster alone;  // the object with nothing else
  Eigen::Vector3d centre;
  double radius;
  int num_points = 0;
  int num_hit = 0;        // beams that meet it
  int num_hit_alone = 0;  // beams that would without the others
  std::optional<Eigen::Vector3d> first_origin;
};

GroundTruth::GroundTruth(const Scene& scene) : max_range_(scene.sensor.max_range) {
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.objects[i].class_name.empty()) continue;
    objects_.push_back(std::make_unique<Watched>(scene.objects[i], static_cast<int>(i)));
  }
}

GroundTruth::~GroundTruth() = default;

void GroundTruth::Add(const ScannedLine& line) {
  for (const std::unique_ptr<Watched>& object : objects_) {
    for (const Beam& beam : line.beams) {
      if (!object->first_origin) object->first_origin = beam.ray.origin;
      if (beam.object_measured == object->index) ++object->num_points;
      if (beam.object_hit == object->index) {
        ++object->num_hit;
        ++object->num_hit_alone;
      } else if (object->MayMeet(beam.ray) && object->alone.Cast(beam.ray, max_range_)) {
        ++object->num_hit_alone;
      }
    }
  }
}

std::vector<ObjectTruth> GroundTruth::Take() {
  std::vector<ObjectTruth> truths;
  for (const std::unique_ptr<Watched>& object : objects_) {
    ObjectTruth truth;
    truth.class_name = object->class_name;
    truth.T_scene_object = object->T_scene_object;
    truth.num_points = object->num_points;
    if (object->num_hit_alone > 0) {
      truth.visible = object->num_hit / static_cast<double>(object->num_hit_alone);
    }
    const Eigen::Vector3d origin = object->first_origin.value_or(Eigen::Vector3d::Zero());
    truth.distance = (object->T_scene_object.translation() - origin).head<2>().norm();
    truths.push_back(truth);
    object->num_points = object->num_hit = object->num_hit_alone = 0;
    object->first_origin.reset();
  }
  return truths;
}

std::string TruthJson(const std::vector<ScanTruth>& scans) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ScanTruth& scan : scans) {
    nlohmann::ordered_json objects = nlohmann::ordered_json::array();
    for (const ObjectTruth& object : scan.objects) {
      objects.push_back({{"class", object.class_name},
                         {"pose", PoseJson(object.T_scene_object)},
                         {"points", object.num_points},
                         {"visible", Rounded(object.visible, 1e-4)},
                         {"distance", Rounded(object.distance, 1e-3)}});
    }
    list.push_back({{"scan", scan.scan}, {"objects", objects}});
  }
  return nlohmann::ordered_json({{"scans", list}}).dump(1) + "\n";
}

std::string ModelJson(const SceneObject& object) {
  const ObjectFrame frame = ObjectFrameOf(object);
  const nlohmann::ordered_json box = {{"min", VectorJson(frame.box.min())},
                                      {"max", VectorJson(frame.box.max())}};
  const nlohmann::ordered_json model = {{"class", object.class_name},
                                        {"object_pose", PoseJson(frame.T_scene_object)},
                                        {"box", box},
                                        {"symmetry", object.symmetry},
                                        {"up", {0, 0, 1}}};
  return model.dump(1) + "\n";
}

}  // namespace rimod::simulation
