#include "rimod/refinement.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "rimod/check.h"

namespace rimod {
namespace {

using Vector6f = Eigen::Matrix<float, 6, 1>;
using Matrix6f = Eigen::Matrix<float, 6, 6>;

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

// Points of a surface and the scene's points that they are drawn to, by coordinate. Has room for
// lanes to be filled up.
class Pairs {
 public:
  using Lanes = Eigen::Array4f;
  static constexpr std::size_t kLanes = 4;

  explicit Pairs(std::size_t most) {
    for (std::vector<float>& column : columns_) column.resize(most + kLanes);
  }
  void Clear() { size_ = 0; }
  // The arm: m, from the middle of the surface; the residual: m, along the surface's normal.
  void Add(const Eigen::Vector3f& arm, const Eigen::Vector3f& normal, float residual,
           float weight) {
    const std::array<float, 8> values = {arm.x(),    arm.y(),    arm.z(),  normal.x(),
                                         normal.y(), normal.z(), residual, weight};
    for (std::size_t i = 0; i < values.size(); ++i) columns_[i][size_] = values[i];
    ++size_;
  }
  // Makes the number of pairs a multiple of kLanes with some that weigh nothing.
  void FillUp() {
    while (size_ % kLanes != 0) Add(Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero(), 0.0f, 0.0f);
  }
  std::size_t size() const { return size_; }
  // The values of pairs [i, i + kLanes), in the order of Add().
  std::array<Lanes, 8> At(std::size_t i) const {
    std::array<Lanes, 8> values;
    for (std::size_t k = 0; k < values.size(); ++k)
      values[k] = Eigen::Map<const Lanes>(columns_[k].data() + i);
    return values;
  }

 private:
  std::array<std::vector<float>, 8> columns_;
  std::size_t size_ = 0;
};

void PairUp(const Scene& scene, const FacingSurface& surface,
            const Eigen::Isometry3f& T_sensor_object, const Eigen::Vector3f& centre, float gate,
            ProjectedPoints* projected, Pairs* pairs) {
  pairs->Clear();
  scene.Project(surface.points, T_sensor_object, 0, surface.points.size(), projected);
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    if (projected->pixels[i] < 0) continue;
    const Eigen::Vector3f p = T_sensor_object * surface.points.At(i);
    const Eigen::Vector3f n = T_sensor_object.linear() * surface.normals[i];
    if (n.dot(p) > 0.0f) continue;  // faces away
    const int pixel = scene.NearestPixel(projected->pixels[i], p, gate);
    if (pixel < 0) continue;
    constexpr float kMinCosine = 0.5f;  // between the normals: 60 degrees
    const Eigen::Vector3f& scene_normal = scene.normal(pixel);
    if (scene_normal.squaredNorm() > 0.0f && scene_normal.dot(n) < kMinCosine) continue;
    const Eigen::Vector3f apart = scene.point(pixel) - p;
    const float share = apart.squaredNorm() / (gate * gate);
    const float weight = (1.0f - share) * (1.0f - share);  // Tukey's
    pairs->Add(p - centre, n, n.dot(apart), weight);
  }
}

// Normal equations of sum w (n . (q - p - omega x (p - centre) - v))^2.
struct Equations {
  Matrix6f A = Matrix6f::Zero();
  Vector6f b = Vector6f::Zero();
};

Equations Linearise(const Pairs& pairs) {
  using Lanes = Pairs::Lanes;
  std::array<std::array<Lanes, 6>, 6> A;
  std::array<Lanes, 6> b;
  for (std::array<Lanes, 6>& row : A) row.fill(Lanes::Zero());
  b.fill(Lanes::Zero());
  for (std::size_t i = 0; i < pairs.size(); i += Pairs::kLanes) {
    const auto [x, y, z, nx, ny, nz, residual, weight] = pairs.At(i);
    const std::array<Lanes, 6> jacobian = {
        y * nz - z * ny, z * nx - x * nz, x * ny - y * nx, nx, ny, nz};
    for (int row = 0; row < 6; ++row) {
      const Lanes weighted = weight * jacobian[row];
      b[row] += residual * weighted;
      for (int column = row; column < 6; ++column) A[row][column] += weighted * jacobian[column];
    }
  }
  Equations equations;
  for (int row = 0; row < 6; ++row) {
    equations.b[row] = b[row].sum();
    for (int column = row; column < 6; ++column)
      equations.A(row, column) = equations.A(column, row) = A[row][column].sum();
  }
  return equations;
}

// The step, rotation vector and translation.
Vector6f Solve(Equations equations, std::size_t num_pairs, double damping, double tilt_damping,
               float radius) {
  const float count = static_cast<float>(num_pairs);
  const float weight = static_cast<float>(damping) * count;
  const float tilt_weight = static_cast<float>(tilt_damping) * count * radius * radius;
  Vector6f resistance;
  resistance << tilt_weight, tilt_weight, weight * radius * radius, weight, weight, weight;
  equations.A.diagonal() += resistance;
  return equations.A.ldlt().solve(equations.b);
}

// The steps of one surface's refinement.
class Refiner {
 public:
  Refiner(const Scene& scene, const SurfaceSample& surface,
          const Eigen::Isometry3f& T_sensor_object)
      : scene_(scene),
        facing_(FacingPart(surface, T_sensor_object)),
        pairs_(facing_.points.size()),
        T_(T_sensor_object) {
    for (const Eigen::Vector3f& point : surface.points) middle_ += point;
    middle_ /= static_cast<float>(surface.points.size());
    for (const Eigen::Vector3f& point : surface.points)
      radius_ = std::max(radius_, (point - middle_).norm());
  }

  const Eigen::Isometry3f& pose() const { return T_; }

  // One iteration; false when there was too little to go by.
  bool Step(float gate, double damping, double tilt_damping) {
    const Eigen::Vector3f centre = T_ * middle_;
    PairUp(scene_, facing_, T_, centre, gate, &projected_, &pairs_);
    const std::size_t num_pairs = pairs_.size();
    constexpr std::size_t kMinPairs = 6;  // as many as degrees of freedom
    if (num_pairs < kMinPairs) return false;
    pairs_.FillUp();
    const Vector6f step = Solve(Linearise(pairs_), num_pairs, damping, tilt_damping, radius_);
    if (!step.allFinite()) return false;
    const float angle = step.head<3>().norm();
    Eigen::Matrix3f turn = Eigen::Matrix3f::Identity();
    if (angle > 1e-9f) turn = Eigen::AngleAxisf(angle, step.head<3>() / angle).toRotationMatrix();
    Turn(turn, step.tail<3>());
    return true;
  }

  void StandUpright() {
    Turn(Eigen::Quaternionf::FromTwoVectors(T_.linear().col(2), Eigen::Vector3f::UnitZ())
             .toRotationMatrix(),
         Eigen::Vector3f::Zero());
  }

 private:
  // About the surface's middle, then moved.
  void Turn(const Eigen::Matrix3f& turn, const Eigen::Vector3f& shift) {
    const Eigen::Vector3f centre = T_ * middle_;
    Eigen::Isometry3f move = Eigen::Isometry3f::Identity();
    move.linear() = turn;
    move.translation() = centre + shift - turn * centre;
    T_ = move * T_;
  }

  const Scene& scene_;
  FacingSurface facing_;
  Pairs pairs_;
  ProjectedPoints projected_;
  Eigen::Isometry3f T_;
  Eigen::Vector3f middle_ = Eigen::Vector3f::Zero();
  float radius_ = 0.0f;  // m, of the surface about its middle
};

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
  CheckWithin("refinement upright_tilt", upright_tilt, 0.0, 0.5);
  CheckWithin("refinement min_leaning_odds", min_leaning_odds, 1.0, 1e9);
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
  Refiner refiner(scene, surface, T_sensor_object);
  for (int i = 0; i < schedule.iterations; ++i) {
    const double progress =
        schedule.iterations > 1 ? static_cast<double>(i) / (schedule.iterations - 1) : 1.0;
    const double gate =
        schedule.first_gate * std::pow(schedule.last_gate / schedule.first_gate, progress);
    if (!refiner.Step(static_cast<float>(gate), schedule.damping, schedule.tilt_damping)) break;
  }
  return refiner.pose();
}

Eigen::Isometry3f StandUpright(const Scene& scene, const SurfaceSample& surface,
                               const Eigen::Isometry3f& T_sensor_object,
                               const RefinementSchedule& schedule) {
  if (surface.points.empty()) return T_sensor_object;
  Refiner refiner(scene, surface, T_sensor_object);
  refiner.StandUpright();
  constexpr int kUprightIterations = 3;
  constexpr double kNoTilt = 1e6;  // damping
  for (int i = 0; i < kUprightIterations; ++i)
    if (!refiner.Step(static_cast<float>(schedule.last_gate), schedule.damping, kNoTilt)) break;
  return refiner.pose();
}

float TiltOf(const Eigen::Isometry3f& T_sensor_object) {
  return std::acos(std::clamp(T_sensor_object.linear()(2, 2), -1.0f, 1.0f));
}

}  // namespace rimod
