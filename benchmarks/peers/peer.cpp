#include "benchmarks/peers/peer.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "benchmarks/peers/judge.h"
#include "benchmarks/peers/run_log.h"
#include "io/config.h"
#include "io/model_file.h"
#include "io/scan_source.h"
#include "io/thread_pool.h"
#include "rimod/range_image.h"

namespace rimod::peers {
namespace {

// How a scan is prepared.
struct PointOptions {
  double above_floor = 0.04;  // m, what is lower is floor
  double max_height = 1.5;    // m above the floor: no object reaches higher
  double wall_height = 1.7;   // m; columns that reach higher are walls and shelves. 0: kept
};

// The lowest 5 cm that hold a hundredth of the points.
double FloorHeight(const std::vector<Eigen::Vector3f>& points) {
  constexpr double kLayer = 0.05;
  std::map<int, std::size_t> layers;
  for (const Eigen::Vector3f& p : points) ++layers[static_cast<int>(std::lround(p.z() / kLayer))];
  for (const auto& [layer, count] : layers) {
    if (count * 100 > points.size()) return layer * kLayer;
  }
  return 0.0;
}

std::vector<Eigen::Vector3f> WithoutRoom(const std::vector<Eigen::Vector3f>& points,
                                         const PointOptions& options) {
  constexpr double kColumn = 0.1;  // m
  const double floor = FloorHeight(points);
  const auto column = [](const Eigen::Vector3f& p) {
    return std::make_pair(static_cast<int>(std::floor(p.x() / kColumn)),
                          static_cast<int>(std::floor(p.y() / kColumn)));
  };
  std::set<std::pair<int, int>> walls;
  for (const Eigen::Vector3f& p : points) {
    if (options.wall_height > 0.0 && p.z() - floor > options.wall_height) walls.insert(column(p));
  }
  std::vector<Eigen::Vector3f> kept;
  for (const Eigen::Vector3f& p : points) {
    const double height = p.z() - floor;
    if (height < options.above_floor || height > options.max_height) continue;
    if (walls.count(column(p)) == 0) kept.push_back(p);
  }
  return kept;
}

// Finds in one scan, writes what was found and how long that took.
void Process(const NamedScan& named, const PointOptions& options, const Judge& judge, Peer* peer,
             RunLog* log) {
  const Judge::PreparedScan prepared = judge.Prepare(named.scan);
  const Times begin = Now();
  const ObjectPoints scan{WithoutRoom(named.scan.points, options),
                          named.scan.T_local_sensor.translation()};
  const std::vector<Proposal> proposals = peer->Find(scan);
  const Times found = Now();
  const std::vector<Detection> judged = judge.Choose(prepared, proposals);
  const Times end = Now();
  log->Write(Measure::kJudged, named.name, judged);
  log->Write(Measure::kOwn, named.name, BestOfEachPlace(proposals, judge.models()));
  log->Tell(named.name, scan.points.size(), proposals.size(), found - begin, end - found);
}

}  // namespace

std::vector<int> FacingPoints(const ObjectModel& model, const Eigen::Isometry3d& T_scan_model,
                              const Eigen::Vector3d& eye) {
  const Eigen::Vector3d eye_model = T_scan_model.inverse() * eye;
  std::vector<int> facing;
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    const Eigen::Vector3d sight = eye_model - model.points[i].cast<double>();
    if (model.normals[i].cast<double>().dot(sight) > 0.2 * sight.norm())
      facing.push_back(static_cast<int>(i));
  }
  return facing;
}

std::vector<int> VisiblePoints(const ObjectModel& model, const Eigen::Vector3d& eye_model) {
  constexpr double kBehind = 0.05;  // m, along the beam
  Eigen::Isometry3d T_eye_model = Eigen::Isometry3d::Identity();
  T_eye_model.translation() = -eye_model;
  const double cell = 1.5 * model.point_spacing / eye_model.norm();  // rad
  std::map<std::pair<int, int>, double> nearest;
  std::vector<std::pair<std::pair<int, int>, double>> seen;
  const std::vector<int> facing = FacingPoints(model, T_eye_model, Eigen::Vector3d::Zero());
  for (const int i : facing) {
    const Eigen::Vector3d p =
        T_eye_model * model.points[static_cast<std::size_t>(i)].cast<double>();
    const Direction direction = DirectionOf(p);
    const std::pair<int, int> key(static_cast<int>(std::floor(direction.azimuth / cell)),
                                  static_cast<int>(std::floor(direction.elevation / cell)));
    seen.emplace_back(key, p.norm());
    const auto at = nearest.emplace(key, p.norm()).first;
    at->second = std::min(at->second, p.norm());
  }
  std::vector<int> visible;
  for (std::size_t k = 0; k < facing.size(); ++k) {
    if (seen[k].second < nearest[seen[k].first] + kBehind) visible.push_back(facing[k]);
  }
  return visible;
}

bool IsUpright(const Eigen::Isometry3d& T_scan_model) {
  return T_scan_model.linear()(2, 2) > std::cos(20.0 * M_PI / 180.0);
}

Eigen::Isometry3d PoseOf(const Eigen::Matrix4d& T) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (!T.allFinite()) return pose;
  pose.translation() = T.block<3, 1>(0, 3);
  pose.linear() = Eigen::Quaterniond(Eigen::Matrix3d(T.block<3, 3>(0, 0))).normalized().matrix();
  return pose;
}

int RunPeer(int argc, char** argv, Peer* peer) {
  CLI::App app("Finds objects with another library, for benchmarks/peers/run");
  std::string models_folder, own_file;
  std::vector<std::string> scans;
  int num_threads = 1;
  PointOptions options;
  app.option_defaults()->always_capture_default();
  app.add_option("--models", models_folder, "Folder of .rimod files")->required();
  app.add_option("--threads", num_threads, "Threads that compute");
  app.add_option("--own", own_file, "Detections scored by the library's own measure go there");
  app.add_option("--above-floor", options.above_floor, "m, what is lower is floor");
  app.add_option("--max-height", options.max_height, "m above the floor: no object reaches higher");
  app.add_option("--wall-height", options.wall_height, "m; columns that reach higher are walls");
  peer->AddOptions(&app);
  app.add_option("SCAN", scans)->required();
  CLI11_PARSE(app, argc, argv);

  const PipelineParams params = DefaultConfiguration(Method::kDefault).pipeline;
  ThreadPool pool(num_threads);
  const Execution execution = pool.MakeExecution();
  const Judge judge(LoadModelFolder(models_folder).models, params, execution);
  RunLog log(own_file);
  const Times start = Now();
  peer->Learn(judge.models(), num_threads, execution);
  log.TellLearnt(judge.models().size(), Now() - start);
  bool all_read = !judge.models().empty();
  for (const std::string& path : scans) {
    const ScanSourceReport report = ReadScans(path, params.sweep, [&](const NamedScan& named) {
      Process(named, options, judge, peer, &log);
    });
    all_read = all_read && report.errors.empty();
  }
  log.TellAll();
  return all_read ? 0 : 1;
}

}  // namespace rimod::peers
