#pragma once

#include <string>

#include "rimod/object_model.h"
#include "tests/io/random_values.h"

namespace rimod {

// A valid model of random numbers, every list filled.
inline ObjectModel RandomModel(unsigned seed, int num_views, int num_points) {
  RandomValues random(seed);
  const auto vectors = [&random](int count) {
    std::vector<Eigen::Vector3f> list;
    for (int i = 0; i < count; ++i) list.push_back(random.Vector(2.0).cast<float>());
    return list;
  };
  ObjectModel model;
  model.name = "model_" + std::to_string(seed);
  model.source = "random numbers";
  model.box_min = -random.Vector(1.0).cwiseAbs();
  model.box_max = random.Vector(1.0).cwiseAbs();
  model.point_spacing = random.Between(0.005, 0.05);
  model.points = vectors(num_points + 1);
  model.normals = vectors(num_points + 1);
  model.descriptor_kind = "kind of test";
  model.descriptor_size = 36;
  for (int i = 0; i < num_views; ++i) {
    ModelView view;
    view.viewpoint = random.Vector(3.0);
    view.features = random.Features(random.Int(1, 80), model.descriptor_size).features;
    view.validation_points = vectors(random.Int(1, 100));
    view.validation_normals = vectors(static_cast<int>(view.validation_points.size()));
    view.outside_points = vectors(random.Int(1, 30));
    model.views.push_back(std::move(view));
  }
  return model;
}

inline bool SameBits(const Feature& a, const Feature& b) {
  return a.position == b.position && a.normal == b.normal && a.descriptor == b.descriptor;
}

inline bool SameBits(const ModelView& a, const ModelView& b) {
  if (a.features.size() != b.features.size()) return false;
  for (std::size_t i = 0; i < a.features.size(); ++i) {
    if (!SameBits(a.features[i], b.features[i])) return false;
  }
  return a.viewpoint == b.viewpoint && a.validation_points == b.validation_points &&
         a.validation_normals == b.validation_normals && a.outside_points == b.outside_points;
}

inline bool SameBits(const ObjectModel& a, const ObjectModel& b) {
  if (a.views.size() != b.views.size()) return false;
  for (std::size_t i = 0; i < a.views.size(); ++i) {
    if (!SameBits(a.views[i], b.views[i])) return false;
  }
  return a.name == b.name && a.source == b.source && a.box_min == b.box_min &&
         a.box_max == b.box_max && a.point_spacing == b.point_spacing && a.points == b.points &&
         a.normals == b.normals && a.descriptor_kind == b.descriptor_kind &&
         a.descriptor_size == b.descriptor_size;
}

}  // namespace rimod
