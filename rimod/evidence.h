#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "rimod/judged_model.h"
#include "rimod/scene.h"

namespace rimod {

// What speaks for and against an object at a pose, from comparing the scene with the rendered model
// at full resolution. Goes past the paper's section III-D, which uses the score of eq. 2 alone.

struct EvidenceParams {
  double normal_radius = 0.05;  // m, a scene normal is that of the points this near; > 0
  double depth_tolerance =
      0.03;  // m, measured against rendered depth on a surface seen head-on; > 0
  double slope_tolerance = 0.25;  // of a pixel's size times the surface's slope, added to it; >= 0
  double max_tolerance = 0.10;    // m, on surfaces seen at a flat angle; >= depth_tolerance
  double silhouette_gap = 0.03;   // m, how far beside the silhouette is looked; > 0
  double rim_inset = 0.02;        // m, how far inside it its rim is looked at; > 0
  double continue_tolerance = 0.06;  // m, a surface going on past the silhouette; > 0
  double slight_difference = 0.12;  // m, depth differences up to this are "slight"; > max_tolerance
  double support_height = 0.04;     // m, around the object's bottom; > 0
  void Validate() const;
};

// Names of the figures, in the order of Evidence::values.
enum EvidenceIndex {
  kMatched,              // share of the rendered pixels that are measured at the model's depth
  kNearlyMatched,        // share where only a neighbouring pixel is
  kSeenThrough,          // share where the laser went through
  kOccluded,             // share with something in front
  kNoReturnShare,        // share without a return
  kMatchedOfKnown,       // matched and nearly matched of those neither occluded nor unknown
  kResidual,             // mean absolute depth difference of matched pixels over the tolerance
  kNormalAgreement,      // mean cosine of the angle between measured and model normals
  kSilhouetteJump,       // share of the silhouette behind which the scene lies deeper
  kSilhouetteContinues,  // share past which the surface goes on
  kSilhouetteOccluded,   // share hidden by something in front
  kSilhouetteKnown,      // share of jump among jump and continue
  kUnexplained,          // scene points in the object's box that are not on its surface, share
  kSupported,            // 1: a horizontal surface is seen around the bottom
  kLogMatchedPixels,     // natural logarithm of 1 + matched pixels
  kLogRenderedPixels,    // of 1 + rendered pixels
  kDistance,             // m
  kTilt,                 // rad, of the object's z-axis
  kSecondNormal,     // spread of the matched normals: second eigenvalue of their products, 0 .. 0.5
  kThirdNormal,      // third eigenvalue, 0 .. 0.33
  kRelief,           // share of matched pixels that lie off the plane through all matched ones
  kStrictlyMatched,  // share of the rendered pixels that match twice as well
  kBias,             // mean signed depth difference of matched pixels over the tolerance
  kSlightlyInFront,  // share where the scene is nearer, but by little: rather wrong than occluded
  kSlightlyBehind,   // share where the scene is farther by little
  kWorstSide,        // least jump / (jump + continue) of the silhouette's four sides
  kKnownSides,       // sides of which that is known, share
  kClosely,          // share of matched pixels whose depth differs by less than a quarter tolerance
  kSpread,           // standard deviation of the signed difference of matched pixels, m
  kTurnedNormals,    // share of matched pixels with normals more than 45 degrees apart
  kRimWorst,         // share of the rim seen through on the worst of its four sides (rim_fit) ..
  kRimSecondWorst,   // .. on the second worst ..
  kRimMean,          // .. on all
  kThroughRegion,    // largest connected region seen through, share of the rendered pixels
  kEvidenceCount
};

struct Evidence {
  std::array<double, kEvidenceCount> values{};
  std::vector<int> explained;  // pixels of the scene that the object explains, rising
};

// Evidence for a pose. No pixel rendered: all zero, nothing explained.
Evidence GatherEvidence(const Scene& scene, const JudgedModel& model,
                        const Eigen::Isometry3d& T_sensor_object, const EvidenceParams& params);

// About the same, from every other row and column: for a first look. Explains nothing.
Evidence GatherCoarseEvidence(const Scene& scene, const JudgedModel& model,
                              const Eigen::Isometry3d& T_sensor_object,
                              const EvidenceParams& params);

}  // namespace rimod
