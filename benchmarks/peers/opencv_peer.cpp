// OpenCV's surface matching: point pair features (Drost et al. 2010), then its ICP.

#include <deque>
#include <opencv2/core.hpp>
#include <opencv2/surface_matching.hpp>
#include <opencv2/surface_matching/ppf_helpers.hpp>

#include "benchmarks/peers/peer.h"

namespace {

using rimod::ObjectModel;
using rimod::peers::Candidate;
using rimod::peers::Scene;
namespace ppf = cv::ppf_match_3d;

// Of those tried (docs/benchmarks.md) these found most.
constexpr double kSampling = 0.05;  // of the model's diameter
constexpr double kNumAngles = 30;
constexpr double kSceneShare = 1.0 / 5.0;  // of the scene's points are references
constexpr float kSceneSpacing = 0.03f;     // m
constexpr std::size_t kMaxRefined = 30;    // poses of a model
constexpr int kIcpIterations = 20;

cv::Mat RowsOf(const std::vector<Eigen::Vector3f>& points,
               const std::vector<Eigen::Vector3f>& normals) {
  cv::Mat rows(static_cast<int>(points.size()), 6, CV_32F);
  for (int i = 0; i < rows.rows; ++i) {
    const auto k = static_cast<std::size_t>(i);
    for (int j = 0; j < 3; ++j) {
      rows.at<float>(i, j) = points[k][j];
      rows.at<float>(i, 3 + j) = normals[k][j];
    }
  }
  return rows;
}

cv::Mat SceneRows(const Scene& scene) {
  cv::Mat points(static_cast<int>(scene.scan.points.size()), 3, CV_32F);
  for (int i = 0; i < points.rows; ++i) {
    for (int j = 0; j < 3; ++j)
      points.at<float>(i, j) = scene.scan.points[static_cast<std::size_t>(i)][j];
  }
  const auto span = [&](int column) {
    double least = 0.0, most = 0.0;
    cv::minMaxLoc(points.col(column), &least, &most);
    return cv::Vec2f(static_cast<float>(least), static_cast<float>(most));
  };
  cv::Vec2f x = span(0), y = span(1), z = span(2);
  const cv::Vec3f size(x[1] - x[0], y[1] - y[0], z[1] - z[0]);
  const float step = kSceneSpacing / std::max({size[0], size[1], size[2]});
  const cv::Mat sampled = ppf::samplePCByQuantization(points, x, y, z, step, 0);
  const Eigen::Vector3d eye = scene.scan.T_local_sensor.translation();
  cv::Mat rows;
  ppf::computeNormalsPC3d(sampled, rows, 12, true,
                          cv::Vec3f(static_cast<float>(eye.x()), static_cast<float>(eye.y()),
                                    static_cast<float>(eye.z())));
  return rows;
}

Eigen::Isometry3d PoseOf(const cv::Matx44d& matrix) {
  Eigen::Matrix4d m;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) m(i, j) = matrix(i, j);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = m.block<3, 1>(0, 3);
  T.linear() = Eigen::Quaterniond(Eigen::Matrix3d(m.block<3, 3>(0, 0))).normalized().matrix();
  return T;
}

class PairFeatures {
 public:
  void Learn(const std::vector<ObjectModel>& models) {
    for (const ObjectModel& model : models) {
      rows_.push_back(RowsOf(model.points, model.normals));
      detectors_.emplace_back(kSampling, kSampling, kNumAngles);
      detectors_.back().trainModel(rows_.back());
    }
  }
  std::vector<Candidate> Find(const Scene& scene) {
    const cv::Mat rows = SceneRows(scene);
    std::vector<Candidate> candidates;
    for (std::size_t i = 0; i < detectors_.size(); ++i) {
      std::vector<ppf::Pose3DPtr> poses;
      detectors_[i].match(rows, poses, kSceneShare, kSampling);
      std::vector<ppf::Pose3DPtr> upright;
      for (const ppf::Pose3DPtr& pose : poses) {
        if (upright.size() < kMaxRefined && rimod::peers::IsUpright(PoseOf(pose->pose)))
          upright.push_back(pose);
      }
      if (upright.empty()) continue;
      ppf::ICP icp(kIcpIterations, 0.005f, 2.5f, 4);
      icp.registerModelToScene(rows_[i], rows, upright);
      for (const ppf::Pose3DPtr& pose : upright) {
        const Eigen::Isometry3d T = PoseOf(pose->pose);
        if (T.matrix().allFinite() && rimod::peers::IsUpright(T)) candidates.push_back({i, T, 0.0});
      }
    }
    return candidates;
  }

 private:
  std::vector<cv::Mat> rows_;
  std::deque<ppf::PPF3DDetector> detectors_;  // copies would free their table twice
};

}  // namespace

int main(int argc, char** argv) {
  PairFeatures features;
  return rimod::peers::RunPeer(
      argc, argv,
      {[&](const std::vector<ObjectModel>& models) { features.Learn(models); },
       [&](const Scene& scene) { return features.Find(scene); }});
}
