// Writes what the default method knows of its candidates, as training data for the judgement:
// experiments/train_judgement.py makes weights of it.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "io/config.h"
#include "io/model_file.h"
#include "io/pose_messages.h"
#include "io/scan_source.h"
#include "io/thread_pool.h"
#include "rimod/default_method.h"
#include "rimod/detector.h"
#include "rimod/judgement.h"
#include "rimod/model_work.h"

namespace rimod {
namespace {

// Proposals written for each that is refined.
constexpr int kProposedOfRefined = 3;

struct Options {
  std::string models, config, out;
  CloudChannels clouds;
  std::vector<std::string> scans;
};

// One line a candidate: kind (P proposed, R ranked, J judged), scan, class, pose, then the figures.
class FigureWriter {
 public:
  explicit FigureWriter(const std::string& path) : out_(path) { out_.precision(9); }
  bool good() const { return out_.good(); }

  void Write(char kind, const std::string& scan, const std::string& class_name,
             const Eigen::Isometry3d& T_local_object, const std::vector<double>& figures) {
    const Eigen::Vector3d p = T_local_object.translation();
    out_ << kind << ',' << scan << ',' << class_name << ',' << p.x() << ',' << p.y() << ','
         << p.z();
    for (const double q : QuaternionOf(T_local_object)) out_ << ',' << q;
    for (const double figure : figures) out_ << ',' << figure;
    out_ << '\n';
  }

 private:
  std::ofstream out_;
};

void DumpScan(const NamedScan& named, const ModelDatabase& database, const PipelineParams& params,
              const Execution& execution, FigureWriter* writer) {
  const RangeImage image = ComputeRangeImage(named.scan, params, execution);
  const FeatureSet features = ExtractFeatures(image, params, execution);
  const Scene scene(image, params.evidence.normal_radius, execution);
  const Eigen::Isometry3d& T_local_sensor = image.T_local_sensor();
  const auto name = [&](int model) { return database.models()[model].name; };
  const auto write = [&](char kind, const Hypothesis& h) {
    writer->Write(kind, named.name, name(h.model),
                  T_local_sensor * h.T_sensor_object.cast<double>(), RankFigures(h.figures));
  };
  PipelineParams all = params;
  const int everything = kProposedOfRefined * params.ranking.refined.most;
  all.ranking.refined = all.ranking.judged = {everything, everything, 0.0};
  all.ranking.min_screened_score = 0.0;
  int num_found = 0;
  const ModelMatches matches = MatchToModels(features, database, params, execution);
  std::vector<Hypothesis> hypotheses =
      ProposeHypotheses(scene, features, matches, database, all, execution, &num_found);
  for (const Hypothesis& h : hypotheses) write('P', h);
  hypotheses = BestOfEachModel(hypotheses, params.ranking.refined);
  std::vector<Hypothesis> ranked =
      RankHypotheses(scene, std::move(hypotheses), database, all, execution);
  for (const Hypothesis& h : ranked) write('R', h);
  ranked = BestOfEachModel(ranked, params.ranking.judged);
  for (const JudgedCandidate& j :
       JudgeCandidates(scene, features, matches, ranked, database, all, execution)) {
    writer->Write('J', named.name, name(j.candidate.model),
                  T_local_sensor * j.candidate.T_sensor_object,
                  JudgementFigures(j.evidence, j.figures, j.support));
  }
}

int Run(const Options& options) {
  const ConfigurationResult read = ReadConfiguration(options.config);
  ModelFolder folder = LoadModelFolder(options.models);
  if (!read.configuration || !folder.error.empty()) {
    std::cerr << read.error << folder.error << '\n';
    return 1;
  }
  const PipelineParams& params = read.configuration->pipeline;
  ThreadPool pool(0);
  const ModelDatabase database(std::move(folder.models), params, pool.MakeExecution());
  FigureWriter writer(options.out);
  ScanSourceParams source;
  source.sweep = params.sweep;
  source.cloud = params.cloud;
  source.cloud_channels = options.clouds;
  bool good = true;
  for (const std::string& path : options.scans) {
    const ScanSourceReport report = ReadScans(path, source, [&](const NamedScan& scan) {
      DumpScan(scan, database, params, pool.MakeExecution(), &writer);
    });
    for (const std::string& error : report.errors) std::cerr << error << '\n';
    good = good && report.errors.empty();
  }
  return good && writer.good() ? 0 : 1;
}

}  // namespace
}  // namespace rimod

int main(int argc, char** argv) {
  CLI::App app("Writes the figures of the default method's candidates as CSV, for training.");
  rimod::Options options;
  app.add_option("--models", options.models, "Folder with .rimod files")->required();
  app.add_option("--config", options.config, "Configuration file");
  app.add_option("--out", options.out, "CSV file to write")->required();
  CLI::Option* const cloud =
      app.add_option("--cloud-channel", options.clouds.clouds, "Logs' scans are its point clouds");
  app.add_option("--cloud-pose-channel", options.clouds.poses, "Poses of the clouds' carrier")
      ->needs(cloud);
  app.add_option("scans", options.scans, "Scan files or LCM logs")->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return rimod::Run(options);
}
