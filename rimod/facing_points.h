#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "rimod/object_model.h"
#include "rimod/pixel_grid.h"

namespace rimod {

// Surfaces seen at a flatter angle (cosine) give no reliable range.
constexpr float kMinFacingCosine = 0.08f;

// Points that face the sensor, by coordinate (m, frame of the grid's axis), and where they are
// seen.
struct FacingPoints {
  std::vector<int> indices;   // in the model
  std::vector<float> planes;  // m: a beam along unit vector u meets a disc at plane / n.u
  std::vector<float> x, y, z;
  std::vector<float> ranges;  // m
  // Pixels; the reach is that of the ball around a disc.
  std::vector<float> rows, columns, reach_rows, reach_columns;
};

// Those of a model as seen from the pose, as discs of a radius (m), wherever they fall.
FacingPoints FindFacing(const ObjectModel& model, const Eigen::Isometry3f& T_axis_object,
                        float radius, const PixelGrid& grid);

}  // namespace rimod
