#include "rimod/refinement.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "rimod/check.h"

namespace rimod {
namespace {

using Vector6f = Eigen::Matrix<float, 6, 1>;
using Matrix6f = Eigen::Matrix<float, 6, 6>;

// The scene point nearest to p among the 3 x 3 pixels around its own, nearer than gate; -1: none.
int PairedPixel(const Scene& scene, int own, const Eigen::Vector3f& p, float gate) {
  const int width = scene.grid().width, height = scene.grid().height;
  const int row = own / width, column = own % width;
  int paired = -1;
  float best_sq = gate * gate;
  for (int r = std::max(row - 1, 0); r <= std::min(row + 1, height - 1); ++r) {
    for (int c = std::max(column - 1, 0); c <= std::min(column + 1, width - 1); ++c) {
      const int pixel = r * width + c;
      const float range = scene.range(pixel);
      if (range == 0.0f || std::isinf(range)) continue;
      const float distance_sq = (scene.point(pixel) - p).squaredNorm();
      if (distance_sq >= best_sq) continue;
      best_sq = distance_sq;
      paired = pixel;
    }
  }
  return paired;
}

// The part of a surface that may face the sensor near a pose.
struct FacingSurface {
  PointColumns points;
  std::vector<Eigen::Vector3f> normals;  // object frame
};

FacingSurface FacingPart(const SurfaceSample& surface, const Eigen::Isometry3f& T_sensor_object) {
  constexpr float kTurn = 0.2f;  // cosine; refinement does not turn the surface further
  const Eigen::Vector3f sensor = T_sensor_object.inverse().translation();
  FacingSurface part;
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    const Eigen::Vector3f to_sensor = sensor - surface.points[i];
    if (surface.normals[i].dot(to_sensor) <= -kTurn * to_sensor.norm()) continue;
    part.points.Add(surface.points[i]);
    part.normals.push_back(surface.normals[i]);
  }
  return part;
}

// Normal equations of sum w (n . (q - p - omega x (p - centre) - v))^2.
struct Equations {
  Matrix6f A = Matrix6f::Zero();
  Vector6f b = Vector6f::Zero();
  int count = 0;
};

Equations Linearise(const Scene& scene, const FacingSurface& surface,
                    const Eigen::Isometry3f& T_sensor_object, const Eigen::Vector3f& centre,
                    float gate, ProjectedPoints* projected) {
  Equations equations;
  scene.Project(surface.points, T_sensor_object, 0, surface.points.size(), projected);
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    if (projected->pixels[i] < 0) continue;
    const Eigen::Vector3f p = T_sensor_object * surface.points.At(i);
    const Eigen::Vector3f n = T_sensor_object.linear() * surface.normals[i];
    if (n.dot(p) > 0.0f) continue;  // faces away
    const int pixel = PairedPixel(scene, projected->pixels[i], p, gate);
    if (pixel < 0) continue;
    constexpr float kMinCosine = 0.5f;  // between the normals: 60 degrees
    const Eigen::Vector3f& scene_normal = scene.normal(pixel);
    if (scene_normal.squaredNorm() > 0.0f && scene_normal.dot(n) < kMinCosine) continue;
    const Eigen::Vector3f apart = scene.point(pixel) - p;
    const float residual = n.dot(apart);
    const float share = apart.squaredNorm() / (gate * gate);
    const float weight = (1.0f - share) * (1.0f - share);  // Tukey's
    const Eigen::Vector3f arm = p - centre;
    Vector6f jacobian;
    jacobian << arm.y() * n.z() - arm.z() * n.y(), arm.z() * n.x() - arm.x() * n.z(),
        arm.x() * n.y() - arm.y() * n.x(), n.x(), n.y(), n.z();
    const Vector6f weighted = weight * jacobian;
    for (int column = 0; column < 6; ++column)
      equations.A.col(column) += weighted[column] * jacobian;
    equations.b += residual * weighted;
    ++equations.count;
  }
  return equations;
}

// The step, rotation vector and translation.
Vector6f Solve(Equations equations, double damping, double tilt_damping, float radius) {
  const float count = static_cast<float>(equations.count);
  const float weight = static_cast<float>(damping) * count;
  const float tilt_weight = static_cast<float>(tilt_damping) * count * radius * radius;
  Vector6f resistance;
  resistance << tilt_weight, tilt_weight, weight * radius * radius, weight, weight, weight;
  equations.A.diagonal() += resistance;
  return equations.A.ldlt().solve(equations.b);
}

}  // namespace

void RefinementParams::Validate() const {
  CheckWithin("refinement coarse_iterations", coarse_iterations, 0, 100);
  CheckWithin("refinement screening_iterations", screening_iterations, 0, 100);
  CheckWithin("refinement fine_iterations", fine_iterations, 0, 100);
  CheckWithin("refinement coarse_gate", coarse_gate, 1e-3, 10.0);
  CheckWithin("refinement fine_gate", fine_gate, 1e-3, 10.0);
  CheckWithin("refinement judged_first_gate", judged_first_gate, 1e-3, 10.0);
  CheckWithin("refinement judged_last_gate", judged_last_gate, 1e-3, 10.0);
  CheckWithin("refinement damping", damping, 1e-6, 10.0);
  CheckWithin("refinement tilt_damping", tilt_damping, 1e-6, 1e6);
}

RefinementSchedule RefinementParams::BeforeRanking() const {
  return {coarse_iterations, coarse_gate, fine_gate, damping, tilt_damping};
}

RefinementSchedule RefinementParams::BeforeScreening() const {
  return {screening_iterations, judged_first_gate, judged_last_gate, damping, tilt_damping};
}

RefinementSchedule RefinementParams::BeforeJudging() const {
  return {fine_iterations, judged_first_gate, judged_last_gate, damping, tilt_damping};
}

Eigen::Isometry3f RefinePose(const Scene& scene, const SurfaceSample& surface,
                             const Eigen::Isometry3f& T_sensor_object,
                             const RefinementSchedule& schedule) {
  if (surface.points.empty()) return T_sensor_object;
  const FacingSurface facing = FacingPart(surface, T_sensor_object);
  ProjectedPoints projected;
  Eigen::Vector3f middle = Eigen::Vector3f::Zero();
  for (const Eigen::Vector3f& point : surface.points) middle += point;
  middle /= static_cast<float>(surface.points.size());
  float radius = 0.0f;
  for (const Eigen::Vector3f& point : surface.points)
    radius = std::max(radius, (point - middle).norm());

  Eigen::Isometry3f T = T_sensor_object;
  for (int i = 0; i < schedule.iterations; ++i) {
    const double progress =
        schedule.iterations > 1 ? static_cast<double>(i) / (schedule.iterations - 1) : 1.0;
    const float gate = static_cast<float>(
        schedule.first_gate * std::pow(schedule.last_gate / schedule.first_gate, progress));
    const Eigen::Vector3f centre = T * middle;
    const Equations equations = Linearise(scene, facing, T, centre, gate, &projected);
    constexpr int kMinPairs = 6;  // as many as degrees of freedom
    if (equations.count < kMinPairs) break;
    const Vector6f step = Solve(equations, schedule.damping, schedule.tilt_damping, radius);
    if (!step.allFinite()) break;
    const float angle = step.head<3>().norm();
    Eigen::Isometry3f move = Eigen::Isometry3f::Identity();
    if (angle > 1e-9f)
      move.linear() = Eigen::AngleAxisf(angle, step.head<3>() / angle).toRotationMatrix();
    move.translation() = centre + step.tail<3>() - move.linear() * centre;
    T = move * T;
  }
  return T;
}

}  // namespace rimod
