#include "benchmarks/peers/run_log.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "io/pose_messages.h"

namespace rimod::peers {
namespace {

double MedianOf(const std::vector<Times>& all, double Times::*which) {
  std::vector<double> values;
  for (const Times& times : all) values.push_back(times.*which);
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : values[values.size() / 2];
}

}  // namespace

Times operator-(const Times& a, const Times& b) {
  return {a.wall_ms - b.wall_ms, a.cpu_ms - b.cpu_ms};
}

Times Now() {
  timespec cpu{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
  const std::chrono::duration<double, std::milli> wall =
      std::chrono::steady_clock::now().time_since_epoch();
  return {wall.count(),
          1e3 * static_cast<double>(cpu.tv_sec) + 1e-6 * static_cast<double>(cpu.tv_nsec)};
}

RunLog::RunLog(const std::string& own_file) {
  if (own_file.empty()) return;
  own_.reset(std::fopen(own_file.c_str(), "w"));
  if (!own_) throw std::runtime_error("cannot write " + own_file);
}

void RunLog::Write(Measure measure, const std::string& scan,
                   const std::vector<Detection>& detections) {
  std::FILE* const file = measure == Measure::kJudged ? stdout : own_.get();
  if (!file) return;
  for (const Detection& detection : detections) {
    const auto q = QuaternionOf(detection.T_local_object);
    const Eigen::Vector3d t = detection.T_local_object.translation();
    nlohmann::ordered_json line = {{"scan", scan}, {"class", detection.class_name}};
    line["pose"] = {t.x(), t.y(), t.z(), q[0], q[1], q[2], q[3]};
    line["score"] = detection.score;
    std::fprintf(file, "%s\n", line.dump().c_str());
  }
  std::fflush(file);
}

void RunLog::TellLearnt(std::size_t num_models, const Times& took) {
  std::fprintf(stderr, "%zu models learnt in %.0f ms, processor %.0f ms\n", num_models,
               took.wall_ms, took.cpu_ms);
}

void RunLog::Tell(const std::string& scan, std::size_t num_points, std::size_t num_proposals,
                  const Times& found, const Times& judged) {
  found_.push_back(found);
  judged_.push_back(judged);
  std::fprintf(stderr, "%s: %zu points, %zu poses, %.0f ms, processor %.0f ms, judging %.0f ms\n",
               scan.c_str(), num_points, num_proposals, found.wall_ms, found.cpu_ms, judged.cpu_ms);
}

void RunLog::TellAll() const {
  std::fprintf(stderr, "median of %zu scans: %.0f ms, processor %.0f ms, judging %.0f ms\n",
               found_.size(), MedianOf(found_, &Times::wall_ms), MedianOf(found_, &Times::cpu_ms),
               MedianOf(judged_, &Times::cpu_ms));
}

}  // namespace rimod::peers
