#include "rimod/model_views.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "rimod/check.h"
#include "rimod/surface_rendering.h"

namespace rimod {
namespace {

constexpr double kPi = 3.14159265358979323846;

Eigen::Vector3d CentreOf(const ObjectModel& model) { return 0.5 * (model.box_min + model.box_max); }

// The level pose at the viewpoint that looks towards the object's centre.
Eigen::Isometry3d ViewPose(const ObjectModel& model, const Eigen::Vector3d& viewpoint) {
  const Eigen::Vector3d forward = CentreOf(model) - viewpoint;
  Eigen::Isometry3d T_object_sensor = Eigen::Isometry3d::Identity();
  T_object_sensor.linear() =
      Eigen::AngleAxisd(std::atan2(forward.y(), forward.x()), Eigen::Vector3d::UnitZ())
          .toRotationMatrix();
  T_object_sensor.translation() = viewpoint;
  return T_object_sensor;
}

// A grid that holds the ball around the model, with a margin of some pixels.
PixelGrid GridAround(const ObjectModel& model, const Eigen::Isometry3d& T_object_sensor,
                     double resolution) {
  constexpr int kMargin = 4;
  const Eigen::Vector3d centre = T_object_sensor.inverse() * CentreOf(model);
  const double angle = std::asin(std::min(0.5 * model.Diameter() / centre.norm(), 0.9));
  const Direction middle = DirectionOf(centre);
  const double widening = 1.0 / std::max(std::cos(middle.elevation), 0.2);
  const int half_rows = static_cast<int>(std::ceil(angle / resolution)) + kMargin;
  const int half_columns = static_cast<int>(std::ceil(angle * widening / resolution)) + kMargin;
  PixelGrid grid;
  grid.resolution = resolution;
  grid.width = 2 * half_columns;
  grid.height = 2 * half_rows;
  grid.left = middle.azimuth + half_columns * resolution;
  grid.top = middle.elevation + half_rows * resolution;
  return grid;
}

RoundedPixel CentredPixel(double range) {
  const double steps = std::clamp(std::round(range / PixelRounding::kRangeUnit), 1.0,
                                  double{PixelRounding::kMaxRangeSteps});
  return {static_cast<std::uint16_t>(steps), 0, 0};
}

// Range (m) of the ground around the model's box along a beam; 0 where there is none.
double GroundRange(const ObjectModel& model, const Eigen::Isometry3d& T_object_sensor,
                   double margin, const Eigen::Vector3d& beam_sensor) {
  if (margin <= 0.0) return 0.0;
  const Eigen::Vector3d beam = T_object_sensor.linear() * beam_sensor;
  const double height = T_object_sensor.translation().z() - model.box_min.z();
  if (!(beam.z() * height < 0.0)) return 0.0;
  const double range = -height / beam.z();
  const Eigen::Vector3d p = T_object_sensor.translation() + range * beam;
  const bool near = p.x() > model.box_min.x() - margin && p.x() < model.box_max.x() + margin &&
                    p.y() > model.box_min.y() - margin && p.y() < model.box_max.y() + margin;
  return near ? range : 0.0;
}

// Up to count different indices below size, spread evenly by steps of the golden ratio.
std::vector<std::size_t> SpreadIndices(std::size_t size, int count) {
  constexpr double kGoldenRatio = 0.6180339887498949;
  const std::size_t wanted = std::min(size, static_cast<std::size_t>(count));
  std::vector<char> taken(size, 0);
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; indices.size() < wanted; ++i) {
    const double phase = kGoldenRatio * static_cast<double>(i + 1);
    std::size_t k =
        static_cast<std::size_t>((phase - std::floor(phase)) * static_cast<double>(size));
    while (taken[k]) k = (k + 1) % size;
    taken[k] = 1;
    indices.push_back(k);
  }
  return indices;
}

// Points beside the silhouette (sensor frame): pixels exactly gap away from the model along a row
// or column, at the range of the nearest pixel of the model there.
std::vector<Eigen::Vector3d> OutsidePoints(const RenderedModel& rendered, const PixelGrid& grid,
                                           int gap) {
  const auto range_at = [&](int row, int column) {
    const bool inside = row >= 0 && row < rendered.height && column >= 0 && column < rendered.width;
    return inside ? rendered.range(row, column) : 0.0f;
  };
  std::vector<Eigen::Vector3d> points;
  for (int row = -gap; row < rendered.height + gap; ++row) {
    for (int column = -gap; column < rendered.width + gap; ++column) {
      float nearest = 0.0f;
      bool too_near = false;
      for (int d = 0; d <= gap && !too_near; ++d) {
        for (const float range : {range_at(row - d, column), range_at(row + d, column),
                                  range_at(row, column - d), range_at(row, column + d)}) {
          if (range <= 0.0f) continue;
          if (d < gap) too_near = true;
          if (nearest == 0.0f || range < nearest) nearest = range;
        }
      }
      if (too_near || nearest == 0.0f) continue;
      points.push_back(nearest * PixelBeam(grid, rendered.first_row + row + 0.5,
                                           rendered.first_column + column + 0.5));
    }
  }
  return points;
}

}  // namespace

void ModelViewParams::Validate() const {
  CheckWithin("model_views azimuths", azimuths, 1, 360);
  CheckWithin("model_views elevations", elevations, 1, 30);
  CheckWithin("model_views min_elevation", min_elevation, -1.4, 1.4);
  CheckWithin("model_views max_elevation", max_elevation, min_elevation, 1.4);
  CheckWithin("model_views distance", distance, 0.1, 100.0);
  CheckWithin("model_views validation_points", validation_points, 1, 10000);
  CheckWithin("model_views outside_points", outside_points, 0, 10000);
  CheckWithin("model_views ground_margin", ground_margin, 0.0, 5.0);
  CheckWithin("model_views outside_gap", outside_gap, 0.005, 0.5);
}

std::string ModelViewParams::Kind() const {
  std::ostringstream kind;
  kind << "views " << azimuths << " x " << elevations << ' ' << min_elevation << ' '
       << max_elevation << " at " << distance << ' ' << validation_points << ' ' << outside_points
       << ' ' << outside_gap << " ground " << ground_margin;
  return kind.str();
}

std::vector<Eigen::Vector3d> Viewpoints(const ObjectModel& model, const ModelViewParams& params) {
  params.Validate();
  const double distance = std::max(params.distance, 1.5 * model.Diameter());
  const double step = params.elevations > 1
                          ? (params.max_elevation - params.min_elevation) / (params.elevations - 1)
                          : 0.0;
  std::vector<Eigen::Vector3d> viewpoints;
  for (int e = 0; e < params.elevations; ++e) {
    for (int a = 0; a < params.azimuths; ++a) {
      const Direction direction{2.0 * kPi * a / params.azimuths, params.min_elevation + e * step};
      viewpoints.push_back(CentreOf(model) + distance * UnitVector(direction));
    }
  }
  return viewpoints;
}

RangeImage RenderView(const ObjectModel& model, const Eigen::Vector3d& viewpoint, double resolution,
                      double ground_margin) {
  const Eigen::Isometry3d T_object_sensor = ViewPose(model, viewpoint);
  const PixelGrid grid = GridAround(model, T_object_sensor, resolution);
  const RenderedModel rendered = RenderModel(model, T_object_sensor.inverse(), grid);
  RangeImage image(grid, T_object_sensor);
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      const double range = GroundRange(model, T_object_sensor, ground_margin,
                                       PixelBeam(grid, row + 0.5, column + 0.5));
      if (range > 0.0) {
        image.SetMeasured(row, column, CentredPixel(range));
      } else {
        image.SetNoReturn(row, column);
      }
    }
  }
  for (int row = 0; row < rendered.height; ++row) {
    for (int column = 0; column < rendered.width; ++column) {
      if (rendered.point(row, column) < 0) continue;
      image.SetMeasured(rendered.first_row + row, rendered.first_column + column,
                        CentredPixel(rendered.range(row, column)));
    }
  }
  return image;
}

void SampleViewPoints(const ObjectModel& model, double resolution, const ModelViewParams& params,
                      ModelView* view) {
  const Eigen::Isometry3d T_object_sensor = ViewPose(model, view->viewpoint);
  const PixelGrid grid = GridAround(model, T_object_sensor, resolution);
  const RenderedModel rendered = RenderModel(model, T_object_sensor.inverse(), grid);

  std::vector<int> seen;
  for (std::size_t i = 0; i < rendered.points.size(); ++i)
    if (rendered.points[i] >= 0) seen.push_back(rendered.points[i]);
  view->validation_points.clear();
  view->validation_normals.clear();
  for (const std::size_t k : SpreadIndices(seen.size(), params.validation_points)) {
    view->validation_points.push_back(model.points[seen[k]]);
    view->validation_normals.push_back(model.normals[seen[k]]);
  }

  const double distance = (CentreOf(model) - view->viewpoint).norm();
  const int gap =
      std::max(1, static_cast<int>(std::lround(params.outside_gap / (distance * resolution))));
  const std::vector<Eigen::Vector3d> outside = OutsidePoints(rendered, grid, gap);
  view->outside_points.clear();
  for (const std::size_t k : SpreadIndices(outside.size(), params.outside_points))
    view->outside_points.push_back((T_object_sensor * outside[k]).cast<float>());
}

}  // namespace rimod
