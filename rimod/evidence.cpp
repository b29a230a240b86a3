#include "rimod/evidence.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "rimod/check.h"
#include "rimod/rim_fit.h"
#include "rimod/surface_rendering.h"

namespace rimod {
namespace {

// Counts over the rendered pixels.
struct Counts {
  int rendered = 0, matched = 0, nearly = 0, through = 0, occluded = 0, no_return = 0;
  int jump = 0, goes_on = 0, hidden = 0, silhouette = 0;
  int strict = 0, close = 0, turned = 0, slightly_front = 0, slightly_behind = 0;
  std::array<int, 4> side_jump{}, side_goes_on{};  // right, left, below, above
  double residual = 0.0, signed_residual = 0.0, cosine = 0.0;
  double difference = 0.0, difference_sq = 0.0;
  int cosines = 0;
  Eigen::Matrix3f normal_products = Eigen::Matrix3f::Zero();
};

// The grid whose pixels have their centres where every step-th row and column has them.
PixelGrid EveryOther(PixelGrid grid, int step) {
  const double farther = 0.5 * (step - 1) * grid.resolution;
  grid.left += farther;
  grid.top += farther;
  grid.width = (grid.width + step - 1) / step;
  grid.height = (grid.height + step - 1) / step;
  grid.resolution *= step;
  return grid;
}

// One pose compared with the scene.
class Comparison {
 public:
  // step: every so many rows and columns are compared.
  Comparison(const Scene& scene, const JudgedModel& model, const Eigen::Isometry3d& T_sensor_object,
             const EvidenceParams& params, int step)
      : scene_(scene),
        step_(step),
        model_(model),
        params_(params),
        T_sensor_object_(T_sensor_object.cast<float>()),
        T_object_sensor_(T_sensor_object_.inverse()) {
    const Eigen::Vector3d centre =
        T_sensor_object * Eigen::Vector3d(0.5 * (model.model().box_min + model.model().box_max));
    distance_ = centre.norm();
    const PixelGrid grid = EveryOther(scene.grid(), step);
    pixel_size_ = PixelAngle(grid, centre) * distance_;
    surface_ = &model.Thinned(pixel_size_);
    rendered_ = RenderModel(*surface_, T_sensor_object, grid);
    fits_.width = rendered_.width;
    fits_.height = rendered_.height;
    fits_.pixels.assign(static_cast<std::size_t>(fits_.width) * fits_.height,
                        PixelFit::kNotRendered);
  }

  Evidence Gather() {
    for (int row = 0; row < rendered_.height; ++row) {
      for (int column = 0; column < rendered_.width; ++column) {
        if (rendered_.point(row, column) < 0) continue;
        fits_.pixels[row * fits_.width + column] = ComparePixel(row, column);
      }
    }
    Evidence evidence;
    if (counts_.rendered == 0) return evidence;
    LookAround();
    Fill(&evidence.values);
    std::sort(explained_.begin(), explained_.end());
    evidence.explained = std::move(explained_);
    return evidence;
  }

 private:
  int ScenePixel(int row, int column) const {
    const int r = (rendered_.first_row + row) * step_,
              c = (rendered_.first_column + column) * step_;
    return scene_.grid().Contains(r, c) ? r * scene_.grid().width + c : -1;
  }

  bool NeighbourMatches(int row, int column, float range, float tolerance) const {
    for (int r = row - 1; r <= row + 1; ++r) {
      for (int c = column - 1; c <= column + 1; ++c) {
        const int pixel = ScenePixel(r, c);
        if (pixel >= 0 && std::abs(scene_.range(pixel) - range) < tolerance) return true;
      }
    }
    return false;
  }

  PixelFit ComparePixel(int row, int column) {
    const int pixel = ScenePixel(row, column);
    const float measured = scene_.range(pixel);
    if (measured == 0.0f) return PixelFit::kUnknown;
    ++counts_.rendered;
    if (std::isinf(measured)) {
      ++counts_.no_return;
      return PixelFit::kUnknown;
    }
    const int surfel = rendered_.point(row, column);
    const Eigen::Vector3f normal = T_sensor_object_.linear() * surface_->normals[surfel];
    const Eigen::Vector3f beam = scene_.point(pixel) / measured;
    // Where the very beam that was measured meets the surface; the pixel's centre may lie a bit
    // beside.
    const float cosine = std::max(0.1f, -normal.dot(beam));
    const float on_plane = -normal.dot(T_sensor_object_ * surface_->points[surfel]) / cosine;
    const float spacing = static_cast<float>(pixel_size_);
    const float rendered = rendered_.range(row, column);
    const float range = std::clamp(on_plane, rendered - spacing, rendered + spacing);
    const float slope = std::sqrt(1.0f - std::min(cosine * cosine, 1.0f)) / cosine;
    const float tolerance =
        std::min(static_cast<float>(params_.max_tolerance),
                 static_cast<float>(params_.depth_tolerance +
                                    params_.slope_tolerance * pixel_size_ * slope));
    const float behind = measured - range;
    if (std::abs(behind) < tolerance) {
      ++counts_.matched;
      counts_.residual += std::abs(behind) / tolerance;
      counts_.signed_residual += behind / tolerance;
      if (std::abs(behind) < 0.5f * tolerance) ++counts_.strict;
      if (std::abs(behind) < 0.25f * tolerance) ++counts_.close;
      const float off_surface = behind * cosine;
      counts_.difference += off_surface;
      counts_.difference_sq += off_surface * off_surface;
      explained_.push_back(pixel);
      const Eigen::Vector3f& scene_normal = scene_.normal(pixel);
      if (scene_normal.squaredNorm() > 0.0f) {
        constexpr float kTurned = 0.7071f;  // cosine of 45 degrees
        const float alike = scene_normal.dot(normal);
        counts_.cosine += alike;
        ++counts_.cosines;
        if (alike < kTurned) ++counts_.turned;
      }
      counts_.normal_products += normal * normal.transpose();
      CompareSilhouette(row, column, range);
      return PixelFit::kFits;
    }
    const float slight = static_cast<float>(params_.slight_difference);
    if (NeighbourMatches(row, column, range, tolerance)) {
      ++counts_.nearly;
      CompareSilhouette(row, column, range);
    } else if (behind > 0.0f) {
      ++counts_.through;
      if (behind < slight) ++counts_.slightly_behind;
    } else {
      ++counts_.occluded;
      if (behind > -slight) ++counts_.slightly_front;
    }
    return behind > slight ? PixelFit::kSeenThrough : PixelFit::kUnknown;
  }

  // Where the model ends beside a matched pixel: does the scene end, too?
  void CompareSilhouette(int row, int column, float range) {
    const int gap =
        std::max(1, static_cast<int>(std::lround(params_.silhouette_gap / pixel_size_)));
    constexpr std::array<std::array<int, 2>, 4> kSides = {{{0, 1}, {0, -1}, {1, 0}, {-1, 0}}};
    for (std::size_t i = 0; i < kSides.size(); ++i) {
      const std::array<int, 2>& side = kSides[i];
      if (Rendered(row + side[0], column + side[1])) continue;
      const int r = row + gap * side[0], c = column + gap * side[1];
      if (Rendered(r, c)) continue;
      const int pixel = ScenePixel(r, c);
      if (pixel < 0 || scene_.range(pixel) == 0.0f) continue;
      const float behind = scene_.range(pixel) - range;
      if (behind <= params_.continue_tolerance) {
        const float height = (T_object_sensor_ * scene_.point(pixel)).z() -
                             static_cast<float>(model_.model().box_min.z());
        if (height < params_.support_height) continue;  // what the object stands on
      }
      ++counts_.silhouette;
      if (behind > params_.continue_tolerance) {
        ++counts_.jump;
        ++counts_.side_jump[i];
      } else if (behind < -params_.continue_tolerance) {
        ++counts_.hidden;
      } else {
        ++counts_.goes_on;
        ++counts_.side_goes_on[i];
      }
    }
  }

  bool Rendered(int row, int column) const {
    return row >= 0 && row < rendered_.height && column >= 0 && column < rendered_.width &&
           rendered_.point(row, column) >= 0;
  }

  // Scene points in the object's box, and what it stands on.
  void LookAround() {
    const Eigen::Vector3f low = model_.model().box_min.cast<float>();
    const Eigen::Vector3f high = model_.model().box_max.cast<float>();
    const float bottom_band = static_cast<float>(params_.support_height);
    constexpr int kMargin = 3;                 // pixels around the rendered window
    constexpr float kFootprintMargin = 0.15f;  // m, around the box's bottom
    for (int row = -kMargin; row < rendered_.height + kMargin; ++row) {
      for (int column = -kMargin; column < rendered_.width + kMargin; ++column) {
        const int pixel = ScenePixel(row, column);
        if (pixel < 0 || scene_.range(pixel) == 0.0f || std::isinf(scene_.range(pixel))) continue;
        const Eigen::Vector3f p = T_object_sensor_ * scene_.point(pixel);
        const bool above =
            p.x() > low.x() - kFootprintMargin && p.x() < high.x() + kFootprintMargin &&
            p.y() > low.y() - kFootprintMargin && p.y() < high.y() + kFootprintMargin;
        constexpr float kUpright = 0.8f;
        if (above && std::abs(p.z() - low.z()) < bottom_band && scene_.normal(pixel).z() > kUpright)
          ++support_points_;
        const bool inside = (p.array() > low.array()).all() && (p.array() < high.array()).all() &&
                            p.z() > low.z() + bottom_band;
        if (!inside) continue;
        ++box_points_;
        if (!model_.OnSurface(p)) ++unexplained_points_;
      }
    }
  }

  static double Share(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

  double Relief() const {
    if (explained_.size() < 3) return 0.0;
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    for (const int pixel : explained_) mean += scene_.point(pixel);
    mean /= static_cast<float>(explained_.size());
    Eigen::Matrix3f products = Eigen::Matrix3f::Zero();
    for (const int pixel : explained_) {
      const Eigen::Vector3f offset = scene_.point(pixel) - mean;
      products += offset * offset.transpose();
    }
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
    solver.computeDirect(products);
    const Eigen::Vector3f normal = solver.eigenvectors().col(0);
    constexpr float kOffPlane = 0.04f;  // m
    const auto off = std::count_if(explained_.begin(), explained_.end(), [&](int pixel) {
      return std::abs(normal.dot(scene_.point(pixel) - mean)) > kOffPlane;
    });
    return Share(static_cast<double>(off), static_cast<double>(explained_.size()));
  }

  void Fill(std::array<double, kEvidenceCount>* values) const {
    std::array<double, kEvidenceCount>& v = *values;
    const double n = counts_.rendered;
    v[kMatched] = counts_.matched / n;
    v[kNearlyMatched] = counts_.nearly / n;
    v[kSeenThrough] = counts_.through / n;
    v[kOccluded] = counts_.occluded / n;
    v[kNoReturnShare] = counts_.no_return / n;
    const double fits = counts_.matched + 0.5 * counts_.nearly;
    v[kMatchedOfKnown] = Share(fits, fits + counts_.through + counts_.no_return);
    v[kResidual] = Share(counts_.residual, counts_.matched);
    v[kNormalAgreement] = Share(counts_.cosine, counts_.cosines);
    v[kSilhouetteJump] = Share(counts_.jump, counts_.silhouette);
    v[kSilhouetteContinues] = Share(counts_.goes_on, counts_.silhouette);
    v[kSilhouetteOccluded] = Share(counts_.hidden, counts_.silhouette);
    v[kSilhouetteKnown] = Share(counts_.jump, counts_.jump + counts_.goes_on);
    v[kUnexplained] = Share(unexplained_points_, box_points_);
    constexpr int kSupportPoints = 5;
    const int pixels = step_ * step_;  // that each compared one stands for
    v[kSupported] = pixels * support_points_ >= kSupportPoints ? 1.0 : 0.0;
    v[kLogMatchedPixels] = std::log1p(pixels * counts_.matched);
    v[kLogRenderedPixels] = std::log1p(pixels * counts_.rendered);
    v[kDistance] = distance_;
    v[kTilt] = std::acos(std::clamp(T_sensor_object_.linear()(2, 2), -1.0f, 1.0f));
    if (counts_.matched > 0) {
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
      solver.computeDirect(counts_.normal_products / static_cast<float>(counts_.matched));
      v[kSecondNormal] = solver.eigenvalues()(1);
      v[kThirdNormal] = solver.eigenvalues()(0);
    }
    v[kRelief] = Relief();
    v[kStrictlyMatched] = counts_.strict / n;
    v[kBias] = Share(counts_.signed_residual, counts_.matched);
    v[kClosely] = Share(counts_.close, counts_.matched);
    const double mean = Share(counts_.difference, counts_.matched);
    v[kSpread] =
        std::sqrt(std::max(Share(counts_.difference_sq, counts_.matched) - mean * mean, 0.0));
    v[kTurnedNormals] = Share(counts_.turned, counts_.cosines);
    v[kSlightlyInFront] = counts_.slightly_front / n;
    v[kSlightlyBehind] = counts_.slightly_behind / n;
    FillRim(values);
    v[kWorstSide] = 1.0;
    for (std::size_t i = 0; i < counts_.side_jump.size(); ++i) {
      constexpr int kMinPixels = 2;
      const int known = counts_.side_jump[i] + counts_.side_goes_on[i];
      if (known < kMinPixels) continue;
      v[kWorstSide] = std::min(v[kWorstSide], Share(counts_.side_jump[i], known));
      v[kKnownSides] += 0.25;
    }
  }

  void FillRim(std::array<double, kEvidenceCount>* values) const {
    const int inset = std::max(1, static_cast<int>(std::lround(params_.rim_inset / pixel_size_)));
    const RimFit rim = FitOfRim(fits_, inset);
    (*values)[kRimWorst] = rim.worst;
    (*values)[kRimSecondWorst] = rim.second_worst;
    (*values)[kRimMean] = rim.mean;
    (*values)[kThroughRegion] = Share(LargestSeenThroughRegion(fits_), counts_.rendered);
  }

  const Scene& scene_;
  const int step_;
  const JudgedModel& model_;
  const EvidenceParams& params_;
  const Eigen::Isometry3f T_sensor_object_;
  const Eigen::Isometry3f T_object_sensor_;
  const ObjectModel* surface_ = nullptr;
  double distance_ = 0.0;    // m, to the object's centre
  double pixel_size_ = 0.0;  // m, at that distance
  RenderedModel rendered_;
  FitImage fits_;  // of the rendered pixels
  Counts counts_;
  int support_points_ = 0, box_points_ = 0, unexplained_points_ = 0;
  std::vector<int> explained_;
};

}  // namespace

void EvidenceParams::Validate() const {
  CheckWithin("evidence normal_radius", normal_radius, 1e-3, 1.0);
  CheckWithin("evidence depth_tolerance", depth_tolerance, 1e-3, 1.0);
  CheckWithin("evidence slope_tolerance", slope_tolerance, 0.0, 10.0);
  CheckWithin("evidence max_tolerance", max_tolerance, depth_tolerance, 10.0);
  CheckWithin("evidence silhouette_gap", silhouette_gap, 1e-3, 1.0);
  CheckWithin("evidence rim_inset", rim_inset, 1e-3, 1.0);
  CheckWithin("evidence continue_tolerance", continue_tolerance, 1e-3, 10.0);
  CheckWithin("evidence slight_difference", slight_difference, max_tolerance, 10.0);
  CheckWithin("evidence support_height", support_height, 1e-3, 1.0);
}

Evidence GatherEvidence(const Scene& scene, const JudgedModel& model,
                        const Eigen::Isometry3d& T_sensor_object, const EvidenceParams& params) {
  return Comparison(scene, model, T_sensor_object, params, 1).Gather();
}

Evidence GatherCoarseEvidence(const Scene& scene, const JudgedModel& model,
                              const Eigen::Isometry3d& T_sensor_object,
                              const EvidenceParams& params) {
  Evidence evidence = Comparison(scene, model, T_sensor_object, params, 2).Gather();
  evidence.explained.clear();
  return evidence;
}

}  // namespace rimod
