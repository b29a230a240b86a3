#include "benchmarks/recorded_input.h"

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>

#include "io/recording.h"
#include "io/scan_source.h"
#include "rimod/model_building.h"

namespace rimod {
namespace {

const std::string kLogs = RIMOD_SOURCE_DIR "/logs/";

[[noreturn]] void Fail(const std::string& message) {
  std::cerr << "rimod-benchmark: " << message << '\n';
  std::exit(1);
}

Scan ReadOffice(const PipelineParams& params) {
  Scan office;
  const ScanSourceReport report = ReadScans(
      kLogs + "office.lcm", params.sweep, [&](NamedScan named) { office = std::move(named.scan); });
  for (const std::string& error : report.errors) Fail(error);
  return office;
}

std::vector<ObjectModel> BuildModels(const PipelineParams& params, const Execution& execution) {
  std::vector<ObjectModel> models;
  for (const auto& entry : std::filesystem::directory_iterator(kLogs + "recordings")) {
    const RecordingResult read = ReadRecording(entry.path().string());
    if (!read.recording) Fail(read.error);
    models.push_back(BuildModel(*read.recording, params, execution));
  }
  return models;
}

int num_found = 0;

}  // namespace

RecordedInput::RecordedInput(const Execution& execution)
    : params(DefaultParams(Method::kDefault)),
      scan(ReadOffice(params)),
      database(BuildModels(params, execution), params, execution),
      image(ComputeRangeImage(scan, params, execution)),
      interest_points(FindInterestPoints(image, params.interest_points)),
      features(ExtractFeatures(image, params, execution)),
      scene(image, params.evidence.normal_radius, execution),
      matches(MatchToModels(features, database, params, execution)),
      proposed(
          ProposeHypotheses(scene, features, matches, database, params, execution, &num_found)),
      ranked(RankHypotheses(scene, proposed, database, params, execution)),
      judged(JudgeCandidates(scene, features, matches, ranked, database, params, execution)) {}

const RecordedInput& Input() {
  static const RecordedInput input = [] {
    ThreadPool pool(0);
    return RecordedInput(pool.MakeExecution());
  }();
  return input;
}

}  // namespace rimod
