#include "rimod/model_surface.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <tuple>

#include "rimod/check.h"
#include "rimod/point_tree.h"
#include "rimod/range_image.h"

namespace rimod {
namespace {

constexpr double kMaxSurfacePoints = 200'000.0;

// Smallest principal axis of the points; nothing for fewer than three.
Eigen::Vector3d PlaneNormal(const std::vector<Eigen::Vector3d>& points,
                            const std::vector<int>& indices) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const int i : indices) mean += points[i];
  mean /= static_cast<double>(indices.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const int i : indices) covariance += (points[i] - mean) * (points[i] - mean).transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  return solver.eigenvectors().col(0).normalized();
}

// The points of one scan that belong to the object, in its frame, and where they were seen from.
struct Cutout {
  std::vector<Eigen::Vector3d> points;
  Eigen::Vector3d sensor = Eigen::Vector3d::Zero();
};

Cutout CutOut(const Scan& scan, const Recording& recording, const ModelSurfaceParams& params) {
  const Eigen::Isometry3d T_object_local = recording.T_local_object.inverse();
  Eigen::Vector3d low = recording.box_min.array() - params.box_margin;
  const Eigen::Vector3d high = recording.box_max.array() + params.box_margin;
  low.z() = recording.box_min.z() + params.ground_clearance;
  Cutout cutout;
  cutout.sensor = T_object_local * scan.T_local_sensor.translation();
  for (const Eigen::Vector3f& p_local : scan.points) {
    const Eigen::Vector3d p = T_object_local * p_local.cast<double>();
    if ((p.array() >= low.array()).all() && (p.array() <= high.array()).all())
      cutout.points.push_back(p);
  }
  return cutout;
}

// What another scan says of a point: +1 it measured a surface there, -1 it looked through, 0
// nothing.
int Opinion(const RangeImage& image, const Eigen::Vector3d& p_local, double see_through) {
  const Eigen::Vector3d p_sensor = image.T_local_sensor().inverse() * p_local;
  const PixelPosition position = Project(image.grid(), p_sensor);
  const int own_row = static_cast<int>(std::floor(position.row));
  const int own_column = static_cast<int>(std::floor(position.column));
  const double range = p_sensor.norm();
  bool measured = false;
  for (int row = own_row - 1; row <= own_row + 1; ++row) {
    for (int column = own_column - 1; column <= own_column + 1; ++column) {
      if (!image.grid().Contains(row, column) || !image.measured(row, column)) continue;
      measured = true;
      const double behind = image.range(row, column) - range;
      if (std::abs(behind) <= see_through) return 1;
      if (behind < 0.0) return 0;
    }
  }
  return measured ? -1 : 0;
}

// Free-space carving: drops the points that at least two other scans looked through and more looked
// through than saw. Flying pixels at depth jumps go this way.
void DropSeenThrough(const Recording& recording, const ModelSurfaceParams& params,
                     const Execution& execution, std::vector<Cutout>* cutouts) {
  const std::size_t count = recording.scans.size();
  std::vector<RangeImage> images(count);
  execution.parallel_for(count, [&](std::size_t i) {
    images[i] = MakeRangeImage(recording.scans[i], RangeImageParams{});
  });
  execution.parallel_for(count, [&](std::size_t i) {
    std::vector<Eigen::Vector3d> kept;
    for (const Eigen::Vector3d& point : (*cutouts)[i].points) {
      int seen = 0, seen_through = 0;
      for (std::size_t other = 0; other < count; ++other) {
        if (other == i) continue;
        const int opinion =
            Opinion(images[other], recording.T_local_object * point, params.see_through);
        seen += opinion > 0;
        seen_through += opinion < 0;
      }
      constexpr int kMinWitnesses = 2;
      if (seen_through < kMinWitnesses || seen_through <= seen) kept.push_back(point);
    }
    (*cutouts)[i].points = std::move(kept);
  });
}

struct OrientedPoint {
  Eigen::Vector3d point, normal;
};

// Normals from the neighbours in the same scan, towards its sensor. Where a scan sees a surface too
// sparsely (thin rods) the direction to the sensor is the normal, if other scans confirm the point.
std::vector<OrientedPoint> Orient(const std::vector<Cutout>& cutouts,
                                  const ModelSurfaceParams& params) {
  std::vector<Eigen::Vector3d> all;
  for (const Cutout& cutout : cutouts)
    all.insert(all.end(), cutout.points.begin(), cutout.points.end());
  const PointTree joined(all);
  std::vector<OrientedPoint> oriented;
  oriented.reserve(all.size());
  for (const Cutout& cutout : cutouts) {
    const PointTree own(cutout.points);
    for (const Eigen::Vector3d& point : cutout.points) {
      const Eigen::Vector3d to_sensor = (cutout.sensor - point).normalized();
      const std::vector<int> near = own.Within(point, params.normal_radius);
      if (static_cast<int>(near.size()) > params.min_neighbours) {
        const Eigen::Vector3d normal = PlaneNormal(cutout.points, near);
        oriented.push_back(
            {point, normal.dot(to_sensor) < 0.0 ? Eigen::Vector3d(-normal) : normal});
      } else if (joined.DistanceToNearest(point, params.min_neighbours + 1) <
                 params.normal_radius) {
        oriented.push_back({point, to_sensor});
      }
    }
  }
  return oriented;
}

// Joins the points of a cell whose normals look to the same side.
std::vector<OrientedPoint> MergeCells(const std::vector<OrientedPoint>& points, double cell) {
  struct Group {
    Eigen::Vector3d point_sum, normal_sum;
    int count;
  };
  std::map<std::tuple<long, long, long>, std::vector<Group>> cells;
  for (const OrientedPoint& p : points) {
    std::vector<Group>& groups =
        cells[{std::lround(p.point.x() / cell), std::lround(p.point.y() / cell),
               std::lround(p.point.z() / cell)}];
    constexpr double kSameSide = 0.3;  // cosine of the angle to the group's mean normal
    const auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& g) {
      return g.normal_sum.normalized().dot(p.normal) > kSameSide;
    });
    if (group == groups.end()) {
      groups.push_back({p.point, p.normal, 1});
    } else {
      group->point_sum += p.point;
      group->normal_sum += p.normal;
      ++group->count;
    }
  }
  std::vector<OrientedPoint> merged;
  for (const auto& [key, groups] : cells)
    for (const Group& g : groups)
      merged.push_back({g.point_sum / g.count, g.normal_sum.normalized()});
  return merged;
}

// Moves each point along its normal into the plane of its neighbours of the same side.
std::vector<OrientedPoint> Smooth(const std::vector<OrientedPoint>& points, double radius) {
  std::vector<Eigen::Vector3d> positions;
  for (const OrientedPoint& p : points) positions.push_back(p.point);
  const PointTree tree(positions);
  std::vector<OrientedPoint> smooth = points;
  for (OrientedPoint& p : smooth) {
    double offset = 0.0;
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    int count = 0;
    for (const int i : tree.Within(p.point, radius)) {
      constexpr double kSameSurface = 0.7;  // cosine between the normals
      if (points[i].normal.dot(p.normal) < kSameSurface) continue;
      offset += p.normal.dot(points[i].point - p.point);
      normal += points[i].normal;
      ++count;
    }
    if (count == 0) continue;
    p.point += offset / count * p.normal;
    p.normal = normal.normalized();
  }
  return smooth;
}

// Typical distance to the fourth neighbour, which is the spacing of a square lattice.
double MeasuredSpacing(const PointTree& tree) {
  std::vector<double> distances;
  for (const Eigen::Vector3d& point : tree.points()) {
    const double distance = tree.DistanceToNearest(point, 5);
    if (std::isfinite(distance)) distances.push_back(distance);
  }
  if (distances.empty()) return 0.0;
  std::nth_element(distances.begin(), distances.begin() + distances.size() / 2, distances.end());
  return distances[distances.size() / 2];
}

Surface ToSurface(const std::vector<OrientedPoint>& points, double wanted_spacing) {
  Surface surface;
  std::vector<Eigen::Vector3d> positions;
  for (const OrientedPoint& p : points) {
    positions.push_back(p.point);
    surface.points.push_back(p.point.cast<float>());
    surface.normals.push_back(p.normal.cast<float>());
  }
  surface.point_spacing = std::max(wanted_spacing, MeasuredSpacing(PointTree(positions)));
  return surface;
}

std::vector<OrientedPoint> BothSides(const std::vector<OrientedPoint>& points) {
  std::vector<OrientedPoint> both;
  both.reserve(2 * points.size());
  for (const OrientedPoint& p : points) {
    both.push_back(p);
    both.push_back({p.point, -p.normal});
  }
  return both;
}

struct Triangle {
  Eigen::Vector3d apex, left, right;  // the side from left to right is the shortest
  Eigen::Vector3d normal;
  double area = 0.0;
  double length = 0.0;  // m, of the longer of the sides from the apex
};

Triangle MakeTriangle(const Mesh& mesh, const Eigen::Vector3i& indices) {
  const Eigen::Vector3d& a = mesh.vertices.at(indices[0]);
  const Eigen::Vector3d& b = mesh.vertices.at(indices[1]);
  const Eigen::Vector3d& c = mesh.vertices.at(indices[2]);
  Triangle triangle{a, b, c, (b - a).cross(c - a), 0.0, 0.0};
  triangle.area = 0.5 * triangle.normal.norm();
  triangle.normal.normalize();
  const double ab = (b - a).norm(), bc = (c - b).norm(), ca = (a - c).norm();
  if (ab <= bc && ab <= ca) {
    triangle.apex = c, triangle.left = a, triangle.right = b;
  } else if (ca <= ab && ca <= bc) {
    triangle.apex = b, triangle.left = c, triangle.right = a;
  }
  triangle.length =
      std::max((triangle.left - triangle.apex).norm(), (triangle.right - triangle.apex).norm());
  return triangle;
}

// Points on rows parallel to the shortest side, no farther apart than spacing.
void SampleTriangle(const Triangle& triangle, double spacing, std::vector<OrientedPoint>* points) {
  const int rows = static_cast<int>(std::ceil(triangle.length / spacing));
  for (int i = 0; i < rows; ++i) {
    const double t = (i + 0.5) / rows;
    const Eigen::Vector3d left = triangle.apex + t * (triangle.left - triangle.apex);
    const Eigen::Vector3d right = triangle.apex + t * (triangle.right - triangle.apex);
    const int columns = std::max(1, static_cast<int>(std::ceil((right - left).norm() / spacing)));
    for (int j = 0; j < columns; ++j)
      points->push_back({left + (j + 0.5) / columns * (right - left), triangle.normal});
  }
}

}  // namespace

void ModelSurfaceParams::Validate() const {
  CheckWithin("model_surface point_spacing", point_spacing, 0.002, 0.1);
  CheckWithin("model_surface box_margin", box_margin, 0.0, 1.0);
  CheckWithin("model_surface ground_clearance", ground_clearance, 0.0, 1.0);
  CheckWithin("model_surface normal_radius", normal_radius, 0.005, 0.5);
  CheckWithin("model_surface see_through", see_through, 1e-3, 10.0);
  CheckWithin("model_surface min_neighbours", min_neighbours, 3, 1000);
}

Surface SurfaceOfRecording(const Recording& recording, const ModelSurfaceParams& params,
                           const Execution& execution) {
  params.Validate();
  std::vector<Cutout> cutouts(recording.scans.size());
  execution.parallel_for(cutouts.size(), [&](std::size_t i) {
    cutouts[i] = CutOut(recording.scans[i], recording, params);
  });
  DropSeenThrough(recording, params, execution, &cutouts);
  const std::vector<OrientedPoint> merged =
      MergeCells(Orient(cutouts, params), params.point_spacing);
  return ToSurface(Smooth(merged, params.normal_radius), params.point_spacing);
}

Surface SurfaceOfPoints(const std::vector<Eigen::Vector3f>& points,
                        const ModelSurfaceParams& params) {
  params.Validate();
  std::vector<OrientedPoint> unoriented;
  for (const Eigen::Vector3f& point : points)
    if (point.allFinite()) unoriented.push_back({point.cast<double>(), Eigen::Vector3d::UnitZ()});
  const std::vector<OrientedPoint> merged = MergeCells(unoriented, params.point_spacing);
  std::vector<Eigen::Vector3d> positions;
  for (const OrientedPoint& p : merged) positions.push_back(p.point);
  const PointTree tree(positions);
  const double radius = std::max(params.normal_radius, 2.5 * MeasuredSpacing(tree));
  std::vector<OrientedPoint> oriented;
  for (const OrientedPoint& p : merged) {
    const std::vector<int> near = tree.Within(p.point, radius);
    if (static_cast<int>(near.size()) < params.min_neighbours) continue;
    oriented.push_back({p.point, PlaneNormal(positions, near)});
  }
  Surface surface = ToSurface(oriented, params.point_spacing);
  const double spacing = surface.point_spacing;
  surface = ToSurface(BothSides(oriented), params.point_spacing);
  surface.point_spacing = spacing;
  return surface;
}

Surface SurfaceOfMesh(const Mesh& mesh, const ModelSurfaceParams& params) {
  params.Validate();
  std::vector<Triangle> triangles;
  double area = 0.0, length = 0.0;
  for (const Eigen::Vector3i& indices : mesh.triangles) {
    const Triangle triangle = MakeTriangle(mesh, indices);
    if (!(triangle.area > 0.0)) continue;
    area += triangle.area;
    length += triangle.length;
    triangles.push_back(triangle);
  }
  if (!std::isfinite(area) || !std::isfinite(length))
    throw std::invalid_argument("mesh with vertices that are not finite");
  // Large meshes get a wider spacing rather than more points than a model may have.
  const double spacing = std::max({params.point_spacing, std::sqrt(2.0 * area / kMaxSurfacePoints),
                                   2.0 * length / kMaxSurfacePoints});
  std::vector<OrientedPoint> points;
  for (const Triangle& triangle : triangles) SampleTriangle(triangle, spacing, &points);
  return ToSurface(MergeCells(BothSides(points), spacing), spacing);
}

}  // namespace rimod
