// The paper's figure 5: what descriptors of other resolutions and supports find, with the rejection
// of false positives off (section IV); experiments/studies/figure5.py draws it.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "io/config.h"
#include "io/label_file.h"
#include "io/model_file.h"
#include "io/scan_source.h"
#include "rimod/detector.h"
#include "rimod/hit_counting.h"
#include "rimod/interest_points.h"
#include "rimod/paper_method.h"

namespace rimod {
namespace {

struct Options {
  std::string models, recordings, labels, config, descriptor;
  std::vector<int> resolutions;
  std::vector<double> supports, max_distances;
  std::vector<std::string> scans;
  int dimensions = 0;
};

// Milliseconds of this process' processor time, which other processes do not lengthen.
double ProcessorMs() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

// Processor time of each stage, ms.
using Times = std::map<std::string, double>;

Execution TimedExecution(Times* times) {
  Execution execution;
  execution.on_stage_begin = [times](const std::string& stage) {
    (*times)[stage] -= ProcessorMs();
  };
  execution.on_stage_end = [times](const std::string& stage) { (*times)[stage] += ProcessorMs(); };
  return execution;
}

// What of a scan does not depend on the descriptor.
struct PreparedScan {
  RangeImage image;
  std::vector<PixelIndex> interest_points;
  std::vector<LabelledObject> objects;
};

struct Setting {
  int resolution = 0;
  double support = 0.0;  // m
};

class Grid {
 public:
  Grid(PipelineParams params, std::vector<ObjectModel> models, ObjectShapes shapes,
       std::vector<PreparedScan> scans, Times times)
      : params_(std::move(params)),
        models_(std::move(models)),
        shapes_(std::move(shapes)),
        scans_(std::move(scans)),
        times_(std::move(times)) {}

  // Writes a CSV row for each largest descriptor distance, which is a choice among the matches of
  // the largest of all.
  void Evaluate(const Setting& setting, std::vector<double> max_distances) const {
    PipelineParams params = WithSetting(setting);
    std::sort(max_distances.begin(), max_distances.end());
    params.matching.max_descriptor_distance = max_distances.back();
    const ModelDatabase database(models_, params, Execution{});
    Times times = times_;
    std::vector<FeatureSet> features;
    std::vector<ModelMatches> matches;
    double num_features = 0.0;
    for (const PreparedScan& scan : scans_) {
      const Execution execution = TimedExecution(&times);
      features.push_back(DescribeFeatures(scan.image, scan.interest_points, params, execution));
      matches.push_back(MatchByModel(features.back(), database, params, execution));
      num_features += static_cast<double>(features.back().features.size());
    }
    for (const double max_distance : max_distances) {
      Times all_times = times;
      const HitCount hits =
          CountFound(features, MatchesWithin(max_distance, matches, features, params), database,
                     params, &all_times);
      WriteRow(setting, max_distance, hits.total, num_features, all_times);
    }
  }

  static void WriteHeader() {
    std::cout << "descriptor,resolution,support,dimensions,d_max,scans,tp,fp,fn,features,"
                 "range_image,interest_points,descriptors,matching,hypotheses,scoring,pruning\n";
  }

 private:
  PipelineParams WithSetting(const Setting& setting) const {
    PipelineParams params = params_;
    params.range_patch.resolution = params.spherical_spin.resolution = setting.resolution;
    params.range_patch.support_size = params.spherical_spin.support_size = setting.support;
    // The share of the cells that the configuration wants.
    const double share = static_cast<double>(params_.matching.min_shared_cells) /
                         (params_.range_patch.resolution * params_.range_patch.resolution);
    params.matching.min_shared_cells =
        static_cast<int>(std::lround(share * setting.resolution * setting.resolution));
    params.Validate();
    return params;
  }

  // Matches tell their distances relative to the roughness of the scene's patch.
  static std::vector<ModelMatches> MatchesWithin(double max_distance,
                                                 std::vector<ModelMatches> of_scans,
                                                 const std::vector<FeatureSet>& features,
                                                 const PipelineParams& params) {
    const double min_roughness = params.matching.min_roughness;
    for (std::size_t i = 0; i < of_scans.size(); ++i) {
      const auto too_far = [&](const Correspondence& match) {
        const Feature& feature = features[i].features[match.scene_feature];
        const double scale =
            min_roughness > 0.0 ? std::max(Roughness(feature.descriptor), min_roughness) : 1.0;
        return match.distance * scale > max_distance;
      };
      for (std::vector<Correspondence>& matches : of_scans[i])
        matches.erase(std::remove_if(matches.begin(), matches.end(), too_far), matches.end());
    }
    return of_scans;
  }

  HitCount CountFound(const std::vector<FeatureSet>& features,
                      const std::vector<ModelMatches>& matches, const ModelDatabase& database,
                      const PipelineParams& params, Times* times) const {
    std::vector<CountedScan> counted;
    for (std::size_t i = 0; i < scans_.size(); ++i) {
      const RangeImage& image = scans_[i].image;
      counted.push_back({scans_[i].objects, {}});
      for (const Candidate& candidate :
           ProposeByTriples(image, features[i], matches[i], database, params, TimedExecution(times))
               .pruned) {
        Detection detection;
        detection.class_name = database.models()[candidate.model].name;
        detection.T_local_object = image.T_local_sensor() * candidate.T_sensor_object;
        detection.score = candidate.score;
        counted.back().detections.push_back(std::move(detection));
      }
    }
    return CountHits(counted, shapes_, HitParams{});
  }

  void WriteRow(const Setting& setting, double max_distance, const Totals& total,
                double num_features, const Times& times) const {
    const bool spin = params_.descriptor == DescriptorType::kSphericalSpin;
    const double num_scans = static_cast<double>(scans_.size());
    std::cout << (spin ? "spherical_spin" : "range_patch") << ',' << setting.resolution << ','
              << setting.support << ',' << (spin ? params_.spherical_spin.dimensions : 0) << ','
              << max_distance << ',' << scans_.size() << ',' << total.right << ','
              << total.false_alarms << ',' << total.missed << ',' << num_features / num_scans;
    for (const char* stage : {"range_image", "interest_points", "descriptors", "matching",
                              "hypotheses", "scoring", "pruning"})
      std::cout << ',' << times.at(stage) / num_scans;
    std::cout << std::endl;
  }

  PipelineParams params_;
  std::vector<ObjectModel> models_;
  ObjectShapes shapes_;
  std::vector<PreparedScan> scans_;
  Times times_;  // of what was prepared
};

// Scans that the labels do not name are left out.
std::vector<PreparedScan> PrepareScans(const Options& options, const PipelineParams& params,
                                       const LabelFile& labels, Times* times, std::string* error) {
  std::vector<PreparedScan> prepared;
  for (const std::string& path : options.scans) {
    const ScanSourceReport report = ReadScans(path, params.sweep, [&](const NamedScan& named) {
      const auto labelled =
          std::find_if(labels.scans.begin(), labels.scans.end(),
                       [&](const LabelledScan& scan) { return scan.scan == named.name; });
      if (labelled == labels.scans.end()) return;
      const Execution execution = TimedExecution(times);
      PreparedScan scan{ComputeRangeImage(named.scan, params, execution), {}, labelled->objects};
      const StageScope stage(execution, "interest_points");
      scan.interest_points = FindInterestPoints(scan.image, params.interest_points);
      prepared.push_back(std::move(scan));
    });
    for (const std::string& text : report.errors) *error += text + "\n";
  }
  if (prepared.empty()) *error += "no labelled scan\n";
  return prepared;
}

// The shapes that the recordings describe, of the models; complains of those that have none.
ObjectShapes ShapesOf(const std::vector<ObjectModel>& models, const std::string& recordings,
                      std::string* error) {
  ObjectShapes shapes;
  for (const ObjectModel& model : models) {
    const std::optional<Symmetry> symmetry = ReadSymmetry(recordings + "/" + model.name);
    if (!symmetry) *error += recordings + ": no recording of " + model.name + "\n";
    shapes[model.name] = {model.box_min, model.box_max, symmetry.value_or(Symmetry::kNone)};
  }
  return shapes;
}

int Run(const Options& options) {
  const ConfigurationResult read = ReadConfiguration(options.config);
  ModelFolder folder = LoadModelFolder(options.models);
  const LabelFile labels = ReadLabelFile(options.labels);
  std::string error = read.error + folder.error + labels.error;
  if (!error.empty()) {
    std::cerr << error << '\n';
    return 1;
  }
  PipelineParams params = read.configuration->pipeline;
  params.method = Method::kPaper;
  params.descriptor = options.descriptor == "spherical_spin" ? DescriptorType::kSphericalSpin
                                                             : DescriptorType::kRangePatch;
  params.spherical_spin.dimensions = options.dimensions;
  Times times;
  const ObjectShapes shapes = ShapesOf(folder.models, options.recordings, &error);
  std::vector<PreparedScan> scans = PrepareScans(options, params, labels, &times, &error);
  if (!error.empty()) {
    std::cerr << error;
    return 1;
  }
  const Grid grid(params, std::move(folder.models), shapes, std::move(scans), times);
  Grid::WriteHeader();
  for (const int resolution : options.resolutions)
    for (const double support : options.supports)
      grid.Evaluate({resolution, support}, options.max_distances);
  return 0;
}

}  // namespace
}  // namespace rimod

int main(int argc, char** argv) {
  CLI::App app(
      "Writes what the paper's method finds with descriptors of other sizes, false positives not "
      "rejected, as CSV on stdout; times are processor milliseconds a scan on one thread.");
  rimod::Options options;
  app.add_option("--models", options.models, "Folder with .rimod files")->required();
  app.add_option("--recordings", options.recordings, "Folder with their recordings")->required();
  app.add_option("--labels", options.labels, "What stands in the scans")->required();
  app.add_option("--config", options.config, "Configuration file, method paper")->required();
  app.add_option("--descriptor", options.descriptor, "range_patch or spherical_spin")
      ->check(CLI::IsMember({"range_patch", "spherical_spin"}))
      ->required();
  app.add_option("--resolution", options.resolutions, "Cells a side, one or more")
      ->check(CLI::Range(2, 16))
      ->required();
  app.add_option("--support", options.supports, "m, one or more")
      ->check(CLI::Range(0.02, 2.0))
      ->required();
  app.add_option("--d-max", options.max_distances, "Largest descriptor distances, one or more")
      ->check(CLI::Range(1e-4, 10.0))
      ->required();
  app.add_option("--dimensions", options.dimensions, "That spin images are compressed to; 0: not")
      ->check(CLI::Range(0, 255));
  app.add_option("--scans", options.scans, "Scan files or LCM logs")->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    return rimod::Run(options);
  } catch (const std::invalid_argument& error) {  // labels of a class without a model
    std::cerr << error.what() << '\n';
    return 1;
  }
}
