// Runs every stage once, on one thread, on the recorded office with models of a few recordings, and
// has callgrind write how many instructions each took. benchmarks/instruction_budget runs it.

#include <valgrind/callgrind.h>

#include <cstdlib>
#include <iostream>
#include <string>
#include <utility>

#include "io/recording.h"
#include "io/scan_source.h"
#include "rimod/detector.h"
#include "rimod/model_building.h"
#include "rimod/wide_loops.h"

namespace rimod {
namespace {

const std::string kLogs = RIMOD_SOURCE_DIR "/logs/";

[[noreturn]] void Fail(const std::string& message) {
  std::cerr << "rimod-stage-counts: " << message << '\n';
  std::exit(1);
}

void Begin() { CALLGRIND_ZERO_STATS; }

// Instructions since Begin(), in a file of callgrind's that names the stage.
void End(const std::string& stage) { CALLGRIND_DUMP_STATS_AT(stage.c_str()); }

Execution Counted() {
  Execution execution;
  execution.on_stage_begin = [](const std::string&) { Begin(); };
  execution.on_stage_end = [](const std::string& stage) { End(stage); };
  return execution;
}

Scan ReadOffice(const PipelineParams& params) {
  Scan office;
  Begin();
  const ScanSourceReport report = ReadScans(
      kLogs + "office.lcm", params.sweep, [&](NamedScan named) { office = std::move(named.scan); });
  End("assembly");
  for (const std::string& error : report.errors) Fail(error);
  return office;
}

ObjectModel ModelOf(const std::string& name, const PipelineParams& params) {
  const RecordingResult read = ReadRecording(kLogs + "recordings/" + name);
  if (!read.recording) Fail(read.error);
  Begin();
  ObjectModel model = BuildModel(*read.recording, params, Execution());
  End("model_building");
  return model;
}

void RunAll() {
  const PipelineParams params = DefaultParams(Method::kDefault);
  // Counting is slow: all models but one are built without it.
  std::vector<ObjectModel> models;
  for (const std::string name : {"monitor", "wooden_chair"})
    models.push_back(ModelOf(name, params));
  CALLGRIND_START_INSTRUMENTATION;
  models.push_back(ModelOf("fan", params));
  const Scan office = ReadOffice(params);
  Begin();
  const ModelDatabase database(std::move(models), params, Execution());
  End("model_database");
  const Execution execution = Counted();
  const RangeImage image = ComputeRangeImage(office, params, execution);
  const FeatureSet features = ExtractFeatures(image, params, execution);
  const DetectionResult result = DetectObjects(image, features, database, params, execution);
  CALLGRIND_STOP_INSTRUMENTATION;
  if (result.detections.empty()) Fail("nothing was found: the counts would say nothing");
}

}  // namespace
}  // namespace rimod

int main() {
  if (RUNNING_ON_VALGRIND == 0) {
    std::cerr << "rimod-stage-counts: to be run by benchmarks/instruction_budget\n";
    return 2;
  }
  rimod::RunAll();
  std::cout << (rimod::LoopsHaveEightLanes() ? "eight_lanes" : "four_lanes") << '\n';
  return 0;
}
