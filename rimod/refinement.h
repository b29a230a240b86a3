#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "rimod/scene.h"

namespace rimod {

// A piece of a model's surface: unit normals, object frame, m.
struct SurfaceSample {
  std::vector<Eigen::Vector3f> points;
  std::vector<Eigen::Vector3f> normals;
};

// How one refinement goes.
struct RefinementSchedule {
  int iterations = 10;
  double first_gate = 0.15;    // m, farther pairs are left out at first ..; > 0
  double last_gate = 0.05;     // m, .. and in the end; > 0
  double damping = 0.02;       // of the points' number, keeps what they do not determine; > 0
  double tilt_damping = 0.05;  // the same for the tilt from the vertical; > 0
};

struct RefinementParams {
  int coarse_iterations = 6;        // of every hypothesis that is ranked; 0 .. 100
  int screening_iterations = 4;     // of the candidates that are judged, before a first look
  int fine_iterations = 10;         // of those that pass it; 0 .. 100
  double coarse_gate = 0.15;        // m, farther pairs are left out at first ..; > 0
  double fine_gate = 0.05;          // m, .. and in the end; > 0
  double judged_first_gate = 0.08;  // m, the same for the refinement before judging
  double judged_last_gate = 0.03;   // m
  double damping = 0.02;            // of the points' number, keeps what they do not determine; > 0
  double tilt_damping = 0.05;       // the same for the tilt from the vertical; > 0
  double upright_tilt = 0.044;      // rad, what leans less may be upright; 0 = nothing .. 0.5
  double min_leaning_odds = 5.0;    // .. unless leaning it is so many times as probable; >= 1
  void Validate() const;
  RefinementSchedule BeforeRanking() const;
  RefinementSchedule BeforeScreening() const;
  RefinementSchedule BeforeJudging() const;
};

// Projective point-to-plane ICP: each surface point facing the sensor is paired with the nearest
// scene point of the 3 x 3 pixels where it falls; the pose moves along the surface's normals. The
// gate shrinks from first_gate to last_gate over the iterations. All six degrees of freedom.
Eigen::Isometry3f RefinePose(const Scene& scene, const SurfaceSample& surface,
                             const Eigen::Isometry3f& T_sensor_object,
                             const RefinementSchedule& schedule);

// The pose turned upright about the surface's middle, then heading and place refined anew at the
// schedule's last gate: most things stand, and a tilt of a degree is what noise makes of them. As
// it was where the surface has no points.
Eigen::Isometry3f StandUpright(const Scene& scene, const SurfaceSample& surface,
                               const Eigen::Isometry3f& T_sensor_object,
                               const RefinementSchedule& schedule);

// Between the object's z-axis and that of the level sensor frame, rad.
float TiltOf(const Eigen::Isometry3f& T_sensor_object);

}  // namespace rimod
