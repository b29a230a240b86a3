#include <cstdio>
#include <map>
#include <string>

#include "viewer_tools/pictures.h"

namespace rimod {

std::vector<DrawnObject> MakeDrawnObjects(const std::vector<Detection>& detections,
                                          const std::vector<ObjectModel>& models) {
  std::map<std::string, const ObjectModel*> by_name;
  for (const ObjectModel& model : models) by_name.emplace(model.name, &model);
  std::vector<std::string> names;
  names.reserve(detections.size());
  for (const Detection& detection : detections) names.push_back(detection.class_name);
  const std::vector<Colour> colours = ColoursByName(names);

  std::vector<DrawnObject> objects;
  objects.reserve(detections.size());
  for (std::size_t i = 0; i < detections.size(); ++i) {
    const auto model = by_name.find(detections[i].class_name);
    char score[16];
    std::snprintf(score, sizeof(score), " %.2f", detections[i].score);
    objects.push_back({detections[i], model == by_name.end() ? nullptr : model->second, colours[i],
                       detections[i].class_name + score});
  }
  return objects;
}

std::vector<Eigen::Vector3d> BoxCorners(const Detection& detection) {
  std::vector<Eigen::Vector3d> corners;
  corners.reserve(8);
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d corner((i & 1) ? detection.box_max.x() : detection.box_min.x(),
                                 (i & 2) ? detection.box_max.y() : detection.box_min.y(),
                                 (i & 4) ? detection.box_max.z() : detection.box_min.z());
    corners.push_back(detection.T_local_object * corner);
  }
  return corners;
}

}  // namespace rimod
