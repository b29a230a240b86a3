// GOODSAC against RANSAC (the paper's section III-B and its reference [9]): how many hypotheses are
// tried until the first correct one; experiments/studies/goodsac.py draws it.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

#include "io/config.h"
#include "io/label_file.h"
#include "io/model_file.h"
#include "io/scan_source.h"
#include "rimod/detector.h"
#include "rimod/goodsac.h"
#include "rimod/hit_counting.h"
#include "rimod/paper_method.h"

namespace rimod {
namespace {

struct Options {
  std::string models, recordings, labels, config;
  std::vector<std::string> scans;
  int seeds = 3;
};

using Poses = std::vector<Eigen::Isometry3d>;

// Looks for labelled objects in both orders; a CSV row an object and order.
class OrderComparison {
 public:
  OrderComparison(const ModelDatabase& database, const PipelineParams& params, ObjectShapes shapes,
                  int seeds)
      : database_(database), params_(params), shapes_(std::move(shapes)), seeds_(seeds) {}

  static void WriteHeader() {
    std::cout << "scan,class,points,visible,distance,correspondences,order,seed,tried,first\n";
  }

  void Compare(const NamedScan& named, const std::vector<LabelledObject>& objects) const {
    const RangeImage image = ComputeRangeImage(named.scan, params_, Execution{});
    const FeatureSet features = ExtractFeatures(image, params_, Execution{});
    const ModelMatches matches = MatchByModel(features, database_, params_, Execution{});
    for (std::size_t m = 0; m < matches.size(); ++m) {
      const std::string& name = database_.models()[m].name;
      std::vector<const LabelledObject*> of_class;
      for (const LabelledObject& object : objects)
        if (object.class_name == name && Counts(object)) of_class.push_back(&object);
      if (of_class.empty()) continue;
      const auto write = [&](const std::string& order, int seed, const Poses& poses) {
        for (const LabelledObject* object : of_class) {
          std::cout << named.name << ',' << name << ',' << object->num_points << ','
                    << object->visible << ',' << object->distance << ',' << matches[m].size() << ','
                    << order << ',' << seed << ',' << poses.size() << ','
                    << FirstCorrect(poses, image.T_local_sensor(), *object) << std::endl;
        }
      };
      GoodsacParams goodsac = params_.goodsac;
      const std::vector<const Feature*>& model = database_.features(static_cast<int>(m));
      write("goodsac_limited", 0, CandidatePoses(matches[m], features.features, model, goodsac));
      goodsac.max_poses_a_correspondence = 0;
      write("goodsac", 0, CandidatePoses(matches[m], features.features, model, goodsac));
      for (int seed = 1; seed <= seeds_; ++seed) {
        write("ransac", seed,
              RandomCandidatePoses(matches[m], features.features, model, goodsac,
                                   static_cast<std::uint32_t>(seed)));
      }
    }
  }

 private:
  static bool Counts(const LabelledObject& object) {
    const HitParams rules;
    return object.visible >= rules.min_visible && object.num_points >= rules.min_points;
  }

  // Counted from 1; 0: none.
  std::size_t FirstCorrect(const Poses& poses, const Eigen::Isometry3d& T_local_sensor,
                           const LabelledObject& object) const {
    const ObjectShape& shape = shapes_.at(object.class_name);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const PoseError error =
          PoseErrorBetween(T_local_sensor * poses[i], object.T_local_object, shape);
      constexpr double kNear = 0.10, kNearDeg = 15.0;  // m, degrees; as poses are scored
      if (error.distance <= kNear && error.angle_deg <= kNearDeg) return i + 1;
    }
    return 0;
  }

  const ModelDatabase& database_;
  const PipelineParams& params_;
  ObjectShapes shapes_;
  int seeds_;
};

int Run(const Options& options) {
  const ConfigurationResult read = ReadConfiguration(options.config);
  ModelFolder folder = LoadModelFolder(options.models);
  const LabelFile labels = ReadLabelFile(options.labels);
  std::string error = read.error + folder.error + labels.error;
  ObjectShapes shapes;
  for (const ObjectModel& model : folder.models) {
    const std::optional<Symmetry> symmetry = ReadSymmetry(options.recordings + "/" + model.name);
    if (!symmetry) error += options.recordings + ": no recording of " + model.name;
    shapes[model.name] = {model.box_min, model.box_max, symmetry.value_or(Symmetry::kNone)};
  }
  if (error.empty() && read.configuration->pipeline.method != Method::kPaper)
    error = options.config + ": method is not paper";
  if (!error.empty()) {
    std::cerr << error << '\n';
    return 1;
  }
  const PipelineParams& params = read.configuration->pipeline;
  const ModelDatabase database(std::move(folder.models), params, Execution{});
  const OrderComparison comparison(database, params, std::move(shapes), options.seeds);
  OrderComparison::WriteHeader();
  bool good = true;
  for (const std::string& path : options.scans) {
    const ScanSourceReport report = ReadScans(path, params.sweep, [&](const NamedScan& named) {
      for (const LabelledScan& scan : labels.scans)
        if (scan.scan == named.name) comparison.Compare(named, scan.objects);
    });
    for (const std::string& text : report.errors) std::cerr << text << '\n';
    good = good && report.errors.empty();
  }
  return good ? 0 : 1;
}

}  // namespace
}  // namespace rimod

int main(int argc, char** argv) {
  CLI::App app(
      "Writes after how many hypotheses the first correct one (10 cm, 15 degrees) comes in "
      "GOODSAC's order and in random ones, as CSV on stdout.");
  rimod::Options options;
  app.add_option("--models", options.models, "Folder with .rimod files")->required();
  app.add_option("--recordings", options.recordings, "Folder with their recordings")->required();
  app.add_option("--labels", options.labels, "What stands in the scans")->required();
  app.add_option("--config", options.config, "Configuration file, method paper")->required();
  app.add_option("--seeds", options.seeds, "Random orders of each scan and object")
      ->check(CLI::Range(1, 1000));
  app.add_option("--scans", options.scans, "Scan files or LCM logs")->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return rimod::Run(options);
}
