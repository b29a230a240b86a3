#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "rimod/object_model.h"
#include "rimod/range_image.h"

namespace rimod {

// Where a model's surface would be seen in a range image: the part of the grid that it covers.
struct RenderedModel {
  int first_row = 0;  // in the grid
  int first_column = 0;
  int height = 0;  // 0: nothing of the model falls into the grid
  int width = 0;
  std::vector<float> ranges;  // m, row by row; 0: the model is not seen in this pixel
  std::vector<int> points;    // index of the model's point that is seen, -1: none

  float range(int row, int column) const { return ranges[row * width + column]; }
  int point(int row, int column) const { return points[row * width + column]; }
  int CountSeen() const;
};

// Renders a model's surface points as discs facing along their normals, z-buffered; points that
// face away are not seen. Ranges are those of the surface at the pixels' centres.
RenderedModel RenderModel(const ObjectModel& model, const Eigen::Isometry3d& T_sensor_object,
                          const PixelGrid& grid);

}  // namespace rimod
