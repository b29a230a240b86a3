// OpenCV's surface matching: point pair features (Drost et al. 2010), then its ICP.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/surface_matching.hpp>
#include <opencv2/surface_matching/ppf_helpers.hpp>

#include "benchmarks/peers/peer.h"

namespace {

using rimod::ObjectModel;
using rimod::peers::ObjectPoints;
using rimod::peers::Proposal;
namespace ppf = cv::ppf_match_3d;

// Of those tried (docs/benchmarks.md) these found most.
struct Settings {
  double sampling = 0.1;  // of the model: points by its box, distances by its diameter
  double num_angles = 30;
  double scene_spacing = 0.05;  // m, of points that have normals
  // Of those, as a share of the diameter; 0: all, so that the votes of models can be compared.
  double scene_sampling = 0.0;
  int normal_neighbours = 20;
  double scene_share = 0.1;         // of the scene's points are references
  double tile = 1.2;                // side in diameters of the model; tiles overlap by half
  double position_threshold = 0.1;  // m, of poses that are one
  double rotation_threshold = 15;   // deg
  std::size_t poses_per_tile = 6;
  std::size_t max_refined = 120;  // poses of a model
  int icp_iterations = 0;
  double icp_rejection = 2.5;
  int icp_levels = 3;
};

cv::Mat RowsOf(const std::vector<Eigen::Vector3f>& points,
               const std::vector<Eigen::Vector3f>& normals, const std::vector<int>& which) {
  cv::Mat rows(static_cast<int>(which.size()), 6, CV_32F);
  for (int i = 0; i < rows.rows; ++i) {
    const auto k = static_cast<std::size_t>(which[static_cast<std::size_t>(i)]);
    for (int j = 0; j < 3; ++j) {
      rows.at<float>(i, j) = points[k][j];
      rows.at<float>(i, 3 + j) = normals[k][j];
    }
  }
  return rows;
}

std::vector<int> EveryIndex(std::size_t count, std::size_t step) {
  std::vector<int> indices;
  for (std::size_t i = 0; i < count; i += step) indices.push_back(static_cast<int>(i));
  return indices;
}

// One point a cube, with normals.
cv::Mat SceneRows(const ObjectPoints& scan, const Settings& settings) {
  std::map<std::array<int, 3>, Eigen::Vector3f> cubes;
  for (const Eigen::Vector3f& p : scan.points) {
    const Eigen::Vector3d cube = p.cast<double>() / settings.scene_spacing;
    cubes.emplace(std::array<int, 3>{static_cast<int>(std::floor(cube.x())),
                                     static_cast<int>(std::floor(cube.y())),
                                     static_cast<int>(std::floor(cube.z()))},
                  p);
  }
  cv::Mat points(static_cast<int>(cubes.size()), 3, CV_32F);
  int row = 0;
  for (const auto& [cube, p] : cubes) {
    for (int j = 0; j < 3; ++j) points.at<float>(row, j) = p[j];
    ++row;
  }
  const Eigen::Vector3f eye = scan.eye.cast<float>();
  cv::Mat rows;
  ppf::computeNormalsPC3d(points, rows, settings.normal_neighbours, true,
                          cv::Vec3f(eye.x(), eye.y(), eye.z()));
  return rows;
}

// Squares seen from above, each the scene's rows that lie in it.
std::vector<cv::Mat> TilesOf(const cv::Mat& rows, double side) {
  constexpr int kFewest = 40;
  std::map<std::pair<int, int>, cv::Mat> tiles;
  for (int i = 0; i < rows.rows; ++i) {
    const int x = static_cast<int>(std::floor(rows.at<float>(i, 0) / (0.5 * side)));
    const int y = static_cast<int>(std::floor(rows.at<float>(i, 1) / (0.5 * side)));
    for (int k = 0; k < 4; ++k) tiles[{x - k % 2, y - k / 2}].push_back(rows.row(i));
  }
  std::vector<cv::Mat> filled;
  for (auto& [place, tile] : tiles) {
    if (tile.rows >= kFewest) filled.push_back(tile);
  }
  return filled;
}

// The longest edge of a cloud's box, which the library's sampling steps are relative to.
double ExtentOf(const cv::Mat& rows) {
  double extent = 0.0;
  for (int column = 0; column < 3; ++column) {
    double least = 0.0, most = 0.0;
    cv::minMaxLoc(rows.col(column), &least, &most);
    extent = std::max(extent, most - least);
  }
  return extent;
}

Eigen::Isometry3d IsometryOf(const cv::Matx44d& matrix) {
  Eigen::Matrix4d m;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) m(i, j) = matrix(i, j);
  return rimod::peers::PoseOf(m);
}

class PairFeatures : public rimod::peers::Peer {
 public:
  void AddOptions(CLI::App* app) override {
    Settings& s = settings_;
    app->add_option("--sampling", s.sampling,
                    "Spacing on the model, of its box; step of distances, of its diameter");
    app->add_option("--num-angles", s.num_angles, "Steps of angles in a turn");
    app->add_option("--scene-spacing", s.scene_spacing, "m, of points with normals");
    app->add_option("--scene-sampling", s.scene_sampling, "Of the model's diameter; 0: all points");
    app->add_option("--normal-neighbours", s.normal_neighbours, "Points that give a normal");
    app->add_option("--scene-share", s.scene_share, "Of points that are references");
    app->add_option("--tile", s.tile, "Side of the squares searched, in diameters of the model");
    app->add_option("--position-threshold", s.position_threshold, "m, of poses that are one");
    app->add_option("--rotation-threshold", s.rotation_threshold, "deg, of poses that are one");
    app->add_option("--poses-per-tile", s.poses_per_tile, "Upright ones kept");
    app->add_option("--max-refined", s.max_refined, "Poses of a model that go to ICP");
    app->add_option("--icp-iterations", s.icp_iterations, "0: no ICP");
    app->add_option("--icp-rejection", s.icp_rejection, "Farther than that many deviations");
    app->add_option("--icp-levels", s.icp_levels, "Of its pyramid");
  }

  void Learn(const std::vector<ObjectModel>& models, int num_threads,
             const rimod::Execution& execution) override {
    cv::setNumThreads(num_threads);
    models_ = &models;
    execution_ = execution;
    for (std::size_t i = 0; i < models.size(); ++i) {
      // The library (4.6) takes a step of distances and uses the sampling in its place.
      detectors_.emplace_back(settings_.sampling, settings_.sampling, settings_.num_angles);
      detectors_.back().setSearchParams(settings_.position_threshold,
                                        settings_.rotation_threshold * CV_PI / 180.0, false);
    }
    execution_.parallel_for(models.size(), [&](std::size_t i) {
      const ObjectModel& model = models[i];
      detectors_[i].trainModel(
          RowsOf(model.points, model.normals, EveryIndex(model.points.size(), 1)));
    });
  }

  std::vector<Proposal> Find(const ObjectPoints& scan) override {
    const cv::Mat rows = SceneRows(scan, settings_);
    std::vector<std::vector<Proposal>> of_model(models_->size());
    execution_.parallel_for(models_->size(),
                            [&](std::size_t i) { of_model[i] = FindModel(i, scan, rows); });
    std::vector<Proposal> all;
    for (const auto& some : of_model) all.insert(all.end(), some.begin(), some.end());
    return all;
  }

 private:
  std::vector<Proposal> FindModel(std::size_t index, const ObjectPoints& scan,
                                  const cv::Mat& rows) {
    const ObjectModel& model = (*models_)[index];
    std::vector<std::pair<Proposal, cv::Mat>> proposed;
    const double spacing = settings_.scene_sampling > 0.0
                               ? settings_.scene_sampling * model.Diameter()
                               : settings_.scene_spacing;
    for (const cv::Mat& tile : TilesOf(rows, settings_.tile * model.Diameter())) {
      std::vector<ppf::Pose3DPtr> poses;
      detectors_[index].match(tile, poses, settings_.scene_share, spacing / ExtentOf(tile));
      std::size_t kept = 0;
      for (const ppf::Pose3DPtr& pose : poses) {
        const Eigen::Isometry3d T = IsometryOf(pose->pose);
        if (kept >= settings_.poses_per_tile) break;
        if (!rimod::peers::IsUpright(T)) continue;
        proposed.push_back({{index, T, static_cast<double>(pose->numVotes)}, tile});
        ++kept;
      }
    }
    std::stable_sort(proposed.begin(), proposed.end(), [](const auto& a, const auto& b) {
      return a.first.measure > b.first.measure;
    });
    if (proposed.size() > settings_.max_refined) proposed.resize(settings_.max_refined);
    std::vector<Proposal> proposals;
    for (const auto& [proposal, tile] : proposed)
      proposals.push_back(Refined(proposal, scan, tile));
    return proposals;
  }

  Proposal Refined(Proposal proposal, const ObjectPoints& scan, const cv::Mat& tile) const {
    if (settings_.icp_iterations == 0) return proposal;
    const ObjectModel& model = (*models_)[proposal.model];
    const std::vector<int> facing =
        rimod::peers::FacingPoints(model, proposal.T_scan_model, scan.eye);
    if (facing.size() < 50) return proposal;
    const ppf::Pose3DPtr pose(new ppf::Pose3D());
    cv::Matx44d start = cv::Matx44d::eye();
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) start(i, j) = proposal.T_scan_model.matrix()(i, j);
    pose->updatePose(start);
    std::vector<ppf::Pose3DPtr> poses = {pose};
    ppf::ICP icp(settings_.icp_iterations, 0.005f, static_cast<float>(settings_.icp_rejection),
                 settings_.icp_levels);
    icp.registerModelToScene(RowsOf(model.points, model.normals, facing), tile, poses);
    const Eigen::Isometry3d T = IsometryOf(poses[0]->pose);
    const bool near = (T.translation() - proposal.T_scan_model.translation()).norm() < 0.3;
    if (near && rimod::peers::IsUpright(T)) proposal.T_scan_model = T;
    return proposal;
  }

  Settings settings_;
  const std::vector<ObjectModel>* models_ = nullptr;
  rimod::Execution execution_;
  std::deque<ppf::PPF3DDetector> detectors_;  // copies would free their table twice
};

}  // namespace

int main(int argc, char** argv) {
  PairFeatures features;
  return rimod::peers::RunPeer(argc, argv, &features);
}
