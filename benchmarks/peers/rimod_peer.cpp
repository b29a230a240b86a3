// rimod itself in the frame of the peers: the same clocks around the same span, from a scan's
// points to its detections.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "benchmarks/peers/run_log.h"
#include "io/config.h"
#include "io/model_file.h"
#include "io/scan_source.h"
#include "io/thread_pool.h"
#include "rimod/detector.h"
#include "rimod/feature_extraction.h"

int main(int argc, char** argv) {
  CLI::App app("Finds objects with rimod, for benchmarks/peers/run");
  std::string models_folder;
  std::vector<std::string> scans;
  int num_threads = 1;
  app.add_option("--models", models_folder, "Folder of .rimod files")->required();
  app.add_option("--threads", num_threads, "Threads that compute");
  app.add_option("SCAN", scans)->required();
  CLI11_PARSE(app, argc, argv);

  const rimod::PipelineParams params =
      rimod::DefaultConfiguration(rimod::Method::kDefault).pipeline;
  rimod::ThreadPool pool(num_threads);
  const rimod::Execution execution = pool.MakeExecution();
  rimod::peers::RunLog log("");
  const rimod::peers::Times start = rimod::peers::Now();
  const rimod::ModelDatabase database(rimod::LoadModelFolder(models_folder).models, params,
                                      execution);
  log.TellLearnt(database.models().size(), rimod::peers::Now() - start);
  bool all_read = !database.models().empty();
  for (const std::string& path : scans) {
    const auto report = rimod::ReadScans(path, params.sweep, [&](const rimod::NamedScan& named) {
      const rimod::peers::Times begin = rimod::peers::Now();
      const rimod::RangeImage image = rimod::ComputeRangeImage(named.scan, params, execution);
      const rimod::DetectionResult result = rimod::DetectObjects(
          image, rimod::ExtractFeatures(image, params, execution), database, params, execution);
      const rimod::peers::Times took = rimod::peers::Now() - begin;
      log.Write(rimod::peers::Measure::kJudged, named.name, result.detections);
      log.Tell(named.name, named.scan.points.size(),
               static_cast<std::size_t>(result.num_hypotheses_found), took, {});
    });
    all_read = all_read && report.errors.empty();
  }
  log.TellAll();
  return all_read ? 0 : 1;
}
