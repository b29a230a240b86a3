#include "benchmarks/peers/peer.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <nlohmann/json.hpp>

#include "io/config.h"
#include "io/model_file.h"
#include "io/pose_messages.h"
#include "io/scan_source.h"
#include "rimod/detector.h"

namespace rimod::peers {
namespace {

Times Now() {
  timespec cpu{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
  const std::chrono::duration<double, std::milli> wall =
      std::chrono::steady_clock::now().time_since_epoch();
  return {wall.count(),
          1e3 * static_cast<double>(cpu.tv_sec) + 1e-6 * static_cast<double>(cpu.tv_nsec)};
}

void Print(const std::string& scan, const ObjectModel& model, const Candidate& candidate) {
  const auto q = QuaternionOf(candidate.T_scan_model);
  const Eigen::Vector3d t = candidate.T_scan_model.translation();
  nlohmann::ordered_json line = {{"scan", scan}, {"class", model.name}};
  line["pose"] = {t.x(), t.y(), t.z(), q[0], q[1], q[2], q[3]};
  line["score"] = candidate.score;
  std::printf("%s\n", line.dump().c_str());
  std::fflush(stdout);
}

double MedianOf(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

}  // namespace

std::vector<int> FacingPoints(const ObjectModel& model, const Eigen::Isometry3d& T_scan_model,
                              const Eigen::Vector3d& sensor) {
  const Eigen::Vector3d eye = T_scan_model.inverse() * sensor;
  std::vector<int> facing;
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    const Eigen::Vector3d sight = eye - model.points[i].cast<double>();
    if (model.normals[i].cast<double>().dot(sight) > 0.2 * sight.norm())
      facing.push_back(static_cast<int>(i));
  }
  return facing;
}

double FitOf(const ObjectModel& model, const Eigen::Isometry3d& T_scan_model, const Scene& scene) {
  constexpr double kNear = 0.04;    // m, along the beam
  constexpr double kEnough = 60.0;  // pixels
  const Eigen::Isometry3d T_sensor_model = scene.image.T_local_sensor().inverse() * T_scan_model;
  const SphericalGrid& grid = scene.image.grid();
  std::vector<std::uint8_t> seen(static_cast<std::size_t>(grid.size()), 0);
  double matched = 0.0, through = 0.0;
  for (const int i :
       FacingPoints(model, T_scan_model, scene.image.T_local_sensor().translation())) {
    const Eigen::Vector3d p_sensor =
        T_sensor_model * model.points[static_cast<std::size_t>(i)].cast<double>();
    const PixelPosition position = Project(grid, p_sensor);
    const int row = static_cast<int>(std::floor(position.row));
    const int column = static_cast<int>(std::floor(position.column));
    if (!grid.Contains(row, column) || !scene.image.measured(row, column)) continue;
    std::uint8_t& pixel = seen[static_cast<std::size_t>(row * grid.width + column)];
    const double behind = scene.image.range(row, column) - p_sensor.norm();
    const std::uint8_t kind = behind > kNear ? 1 : behind >= -kNear ? 2 : 0;
    if (kind <= pixel) continue;  // a pixel counts once, for what fits it best
    if (pixel == 1) through -= 1.0;
    (kind == 2 ? matched : through) += 1.0;
    pixel = kind;
  }
  if (matched <= through) return 0.0;
  return (matched - through) / (matched + through) * std::min(1.0, matched / kEnough);
}

bool IsUpright(const Eigen::Isometry3d& T_scan_model) {
  return T_scan_model.linear()(2, 2) > std::cos(20.0 * M_PI / 180.0);
}

std::vector<Candidate> BestOfEachPlace(std::vector<Candidate> candidates,
                                       const std::vector<ObjectModel>& models, double min_score) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  const auto centre = [&](const Candidate& c) -> Eigen::Vector3d {
    return c.T_scan_model * (0.5 * (models[c.model].box_min + models[c.model].box_max));
  };
  std::vector<Candidate> best;
  for (const Candidate& candidate : candidates) {
    if (candidate.score < min_score) break;
    const bool taken = std::any_of(best.begin(), best.end(), [&](const Candidate& other) {
      const double near =
          0.25 * std::min(models[candidate.model].Diameter(), models[other.model].Diameter());
      return (centre(candidate) - centre(other)).norm() < near;
    });
    if (!taken) best.push_back(candidate);
  }
  return best;
}

int RunPeer(int argc, char** argv, const Peer& peer) {
  CLI::App app("Finds objects with another library, for benchmarks/peers");
  std::string models_folder;
  std::vector<std::string> scans;
  double min_score = 0.3;
  app.add_option("--models", models_folder)->required();
  app.add_option("--min-score", min_score);
  app.add_option("SCAN", scans)->required();
  CLI11_PARSE(app, argc, argv);

  const PipelineParams params = DefaultConfiguration(Method::kDefault).pipeline;
  const std::vector<ObjectModel> models = LoadModelFolder(models_folder).models;
  const Times start = Now();
  peer.learn(models);
  std::fprintf(stderr, "%zu models learnt in %.0f ms\n", models.size(),
               Now().wall_ms - start.wall_ms);
  std::vector<double> wall, cpu;
  for (const std::string& path : scans) {
    ReadScans(path, params.sweep, [&](const NamedScan& named) {
      Scene scene;
      scene.scan = named.scan;
      scene.image = ComputeRangeImage(named.scan, params, Execution());
      const Times begin = Now();
      std::vector<Candidate> candidates = peer.find(scene);
      const std::size_t num_candidates = candidates.size();
      for (Candidate& c : candidates) c.score = FitOf(models[c.model], c.T_scan_model, scene);
      const auto best = BestOfEachPlace(std::move(candidates), models, min_score);
      const Times end = Now();
      for (const Candidate& candidate : best) Print(named.name, models[candidate.model], candidate);
      wall.push_back(end.wall_ms - begin.wall_ms);
      cpu.push_back(end.cpu_ms - begin.cpu_ms);
      std::fprintf(stderr, "%s: %zu candidates, %zu detections, %.0f ms, processor %.0f ms\n",
                   named.name.c_str(), num_candidates, best.size(), wall.back(), cpu.back());
    });
  }
  std::fprintf(stderr, "median of %zu scans: %.0f ms, processor %.0f ms\n", wall.size(),
               MedianOf(wall), MedianOf(cpu));
  return 0;
}

}  // namespace rimod::peers
