#include "viewer_tools/report.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <system_error>

#include "io/files.h"
#include "io/model_file.h"
#include "io/thread_pool.h"
#include "io/version.h"
#include "rimod/detector.h"
#include "viewer_tools/detection_lines.h"
#include "viewer_tools/html.h"
#include "viewer_tools/label_file.h"
#include "viewer_tools/pictures.h"
#include "viewer_tools/png.h"
#include "viewer_tools/report_cases.h"
#include "viewer_tools/report_page.h"
#include "viewer_tools/report_sources.h"

namespace rimod {
namespace {

// What stands in the files that belong to the scans, by scan.
struct Inputs {
  std::map<std::string, std::vector<LabelledObject>> labels;
  std::map<std::string, std::vector<Detection>> detections;
  std::map<std::string, StageTimes> times;
};

// Goes through the scans and keeps what the page needs of each.
class Reporter {
 public:
  Reporter(const ReportOptions& options, std::vector<ObjectModel> models)
      : options_(options),
        pool_(options.num_threads),
        execution_(pool_.MakeExecution()),
        database_(std::move(models), options.params, execution_) {
    for (const ObjectModel& model : database_.models())
      shapes_[model.name] = {model.box_min, model.box_max, SymmetryOf(model.name)};
  }

  void Tell(const std::string& error) {
    spdlog::error("{}", error);
    report_.warnings.push_back(error);
    all_well_ = false;
  }

  void ReadInputs() {
    if (!options_.labels.empty()) {
      LabelFile labels = ReadLabelFile(options_.labels);
      if (!labels.error.empty()) Tell(labels.error);
      for (LabelledScan& scan : labels.scans) AddLabels(std::move(scan));
    }
    if (!options_.detections.empty()) {
      const DetectionLines lines = ReadDetectionLines(options_.detections);
      if (!lines.error.empty()) Tell(lines.error);
      for (const DetectionLine& line : lines.lines)
        inputs_.detections[line.scan].push_back(line.detection);
    }
    if (options_.timing.empty()) return;
    TimingFile timing = ReadTimingFile(options_.timing);
    if (!timing.error.empty()) Tell(timing.error);
    inputs_.times = std::move(timing.times);
  }

  void AddSource(const std::string& path) {
    const auto on_scan = [&](SourceScan scan) {
      try {
        AddScan(std::move(scan));
      } catch (const std::exception& exception) {
        Tell(path + ": " + exception.what());
      }
    };
    try {
      const SourceReport read = ReadSource(path, options_.channels, options_.params,
                                           options_.detections.empty(), on_scan);
      for (const std::string& warning : read.warnings) spdlog::warn("{}", warning);
      for (const std::string& error : read.errors) Tell(error);
    } catch (const std::exception& exception) {  // out of memory
      Tell(path + ": " + exception.what());
    }
  }

  // Writes the page and the cases; false when anything went wrong up to here.
  bool Finish() {
    TellLeftOver();
    report_.title = "rimod report: " + (options_.sources.size() == 1
                                            ? FileStem(options_.sources.front())
                                            : std::to_string(report_.scans.size()) + " scans");
    report_.facts = {{"models", options_.models + ": " + ModelNames()},
                     {"method", options_.params.method == Method::kPaper ? "paper" : "default"},
                     {"detections", detections_origin_},
                     {"labels", options_.labels.empty() ? "none" : options_.labels},
                     {"rimod", Version()}};
    if (!options_.labels.empty()) report_.count = CountHits(counted_, shapes_, options_.hits);
    if (!options_.cases.empty())
      Save((std::filesystem::path(options_.cases) / "cases.jsonl").string(), case_lines_);
    if (Save(options_.output, MakeReportPage(report_)))
      std::printf("%s\n", options_.output.c_str());
    if (report_.count) PrintTotals(*report_.count);
    return all_well_;
  }

 private:
  Symmetry SymmetryOf(const std::string& class_name) {
    if (options_.recordings.empty()) return Symmetry::kNone;
    const auto folder = std::filesystem::path(options_.recordings) / class_name;
    const std::optional<Symmetry> symmetry = ReadSymmetry(folder.string());
    if (!symmetry) Tell(folder.string() + ": no model.json that tells the symmetry");
    return symmetry.value_or(Symmetry::kNone);
  }

  std::string ModelNames() const {
    std::string names;
    for (const ObjectModel& model : database_.models())
      names += (names.empty() ? "" : ", ") + model.name;
    return names;
  }

  void AddLabels(LabelledScan scan) {
    std::vector<LabelledObject>& objects = inputs_.labels[scan.scan];
    for (LabelledObject& object : scan.objects) {
      if (shapes_.count(object.class_name) == 0) {
        Tell(options_.labels + ": scan " + scan.scan + ": no model of class " + object.class_name +
             ", the object is left out");
        continue;
      }
      objects.push_back(std::move(object));
    }
  }

  // The detections of a scan: from the file, from the log, or found now.
  std::vector<Detection> DetectionsOf(SourceScan* scan) {
    std::vector<Detection> detections;
    if (!options_.detections.empty()) {
      detections_origin_ = options_.detections;
      const auto found = inputs_.detections.find(scan->name);
      if (found != inputs_.detections.end()) detections = found->second;
    } else if (scan->detections) {
      detections_origin_ = "as recorded in the log";
      detections = std::move(*scan->detections);
    } else {
      detections_origin_ = "found while making this report";
      Execution execution = execution_;
      StageTimer timer;
      timer.Watch(&execution);
      const FeatureSet features = ExtractFeatures(scan->image, options_.params, execution);
      detections =
          DetectObjects(scan->image, features, database_, options_.params, execution).detections;
      scan->stage_times.insert(scan->stage_times.end(), timer.times().begin(), timer.times().end());
    }
    return WithBoxes(scan->name, std::move(detections));
  }

  // Detections from JSON lines know no box; those of classes without a model are left out.
  std::vector<Detection> WithBoxes(const std::string& scan, std::vector<Detection> detections) {
    std::vector<Detection> known;
    for (Detection& detection : detections) {
      const auto shape = shapes_.find(detection.class_name);
      if (shape == shapes_.end()) {
        Tell(scan + ": no model of the detected class " + detection.class_name +
             ", the detection is left out");
        continue;
      }
      detection.box_min = shape->second.box_min;
      detection.box_max = shape->second.box_max;
      known.push_back(std::move(detection));
    }
    return known;
  }

  void AddScan(SourceScan source) {
    CountedScan counted;
    counted.detections = DetectionsOf(&source);
    ReportScan& scan = report_.scans.emplace_back();
    scan.name = source.name;
    scan.num_measured = source.image.CountMeasured();
    scan.detections = counted.detections;
    const auto times = inputs_.times.find(source.name);
    scan.stage_times = times != inputs_.times.end() ? times->second : source.stage_times;
    std::optional<HitCount> count;
    const auto labels = inputs_.labels.find(source.name);
    if (labels != inputs_.labels.end()) {
      counted.objects = std::move(labels->second);
      inputs_.labels.erase(labels);
      count = CountHits({counted}, shapes_, options_.hits);
      scan.verdicts = count->detections[0];
      AddCases(source, counted, *count);
    } else if (!options_.labels.empty()) {
      Tell(options_.labels + ": has no scan " + source.name);
    }
    if (static_cast<int>(report_.scans.size()) <= options_.max_pictures)
      AddPictures(source.image, counted, count, &scan);
    if (count) counted_.push_back(std::move(counted));
    spdlog::info("{}: {} detections", source.name, scan.detections.size());
  }

  void AddPictures(const RangeImage& image, const CountedScan& counted,
                   const std::optional<HitCount>& count, ReportScan* scan) {
    std::vector<DrawnObject> objects = MakeDrawnObjects(counted.detections, database_.models());
    if (count) {
      for (std::size_t i = 0; i < objects.size(); ++i) {
        const Verdict verdict = count->detections[0][i].verdict;
        if (verdict != Verdict::kRight)
          objects[i].label += std::string(", ") + VerdictText(verdict);
      }
      AddMissed(counted, *count, &objects);
    }
    scan->pictures.emplace_back(
        "range image", DataUri("image/png", EncodePng(DrawRangeImage(
                                                image, objects, scan->name + ": range image"))));
    scan->pictures.emplace_back(
        "seen from above",
        DataUri("image/png", EncodePng(DrawTopView(image, objects, scan->name + ": from above"))));
  }

  // Missed objects are drawn at their labels, in a colour of their own.
  void AddMissed(const CountedScan& counted, const HitCount& count,
                 std::vector<DrawnObject>* objects) const {
    for (std::size_t i = 0; i < counted.objects.size(); ++i) {
      if (!count.objects[0][i].counts || count.objects[0][i].found()) continue;
      const LabelledObject& object = counted.objects[i];
      const ObjectShape& shape = shapes_.at(object.class_name);
      Detection detection{object.class_name, object.T_local_object, shape.box_min, shape.box_max,
                          0.0};
      DrawnObject missed = MakeDrawnObjects({detection}, database_.models()).front();
      missed.colour = Colour(245, 245, 245);
      missed.label = object.class_name + ", missed";
      objects->push_back(missed);
    }
  }

  void AddCases(const SourceScan& source, const CountedScan& counted, const HitCount& count) {
    for (FoundCase& found : FindCases(source.name, source.image, counted, count, database_, shapes_,
                                      options_.params, execution_)) {
      const std::string title = found.words.class_name + " in scan " + found.words.scan + ", " +
                                CaseKindText(found.words.kind) + ": " + found.words.cause + ". " +
                                found.words.facts;
      const std::string png = EncodePng(DrawCase(source.image, found.poses, title));
      found.words.picture = DataUri("image/png", png);
      if (!options_.cases.empty()) SaveCase(found, png);
      report_.cases.push_back(std::move(found.words));
    }
  }

  void SaveCase(const FoundCase& found, const std::string& png) {
    std::string name =
        fmt::format("{:03}-{}-{}-{}", report_.cases.size(), CaseKindText(found.words.kind),
                    found.words.class_name, found.words.scan);
    for (char& c : name)
      if (c == ' ' || c == '/' || c == '#') c = '_';
    Save((std::filesystem::path(options_.cases) / (name + ".png")).string(), png);
    nlohmann::ordered_json line = {{"picture", name + ".png"},
                                   {"kind", CaseKindText(found.words.kind)},
                                   {"scan", found.words.scan},
                                   {"class", found.words.class_name},
                                   {"cause", found.words.cause}};
    if (found.object) {
      line["visible"] = found.object->visible;
      line["points"] = found.object->num_points;
      line["distance"] = found.object->distance;
    }
    if (found.score) line["score"] = *found.score;
    if (found.score_at_label) line["score_at_label"] = *found.score_at_label;
    line["detail"] = found.words.detail;
    case_lines_ += line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  }

  // Labels and detections of scans that no source has.
  void TellLeftOver() {
    if (!inputs_.labels.empty())
      spdlog::warn("{}: {} scan(s) in it are not among the sources, as {}", options_.labels,
                   inputs_.labels.size(), inputs_.labels.begin()->first);
    for (const ReportScan& scan : report_.scans) inputs_.detections.erase(scan.name);
    if (!inputs_.detections.empty())
      Tell(options_.detections + ": has detections in scans that are not among the sources, as " +
           inputs_.detections.begin()->first);
  }

  bool Save(const std::string& path, const std::string& bytes) {
    const std::string error = WriteFileAtomically(path, bytes);
    if (!error.empty()) Tell(error);
    return error.empty();
  }

  static void PrintTotals(const HitCount& count) {
    std::printf(
        "%d objects: %d right (%d in pose), %d missed, %d false alarms; recall %.3f, precision "
        "%.3f\n",
        count.num_counted_objects, count.total.right, count.num_posed, count.total.missed,
        count.total.false_alarms, count.total.Recall(), count.total.Precision());
  }

  const ReportOptions& options_;
  ThreadPool pool_;
  Execution execution_;
  ModelDatabase database_;
  ObjectShapes shapes_;
  Inputs inputs_;
  Report report_;
  std::vector<CountedScan> counted_;
  std::string detections_origin_ = "none";
  std::string case_lines_;
  bool all_well_ = true;
};

}  // namespace

int RunReport(const ReportOptions& options) {
  ModelFolder folder = LoadModelFolder(options.models);
  if (!folder.error.empty()) {
    spdlog::error("{}", folder.error);
    return 1;
  }
  if (!options.cases.empty()) {
    std::error_code cause;
    std::filesystem::create_directories(options.cases, cause);
    if (cause) {
      spdlog::error("{}: the folder cannot be made: {}", options.cases, cause.message());
      return 1;
    }
  }
  Reporter reporter(options, std::move(folder.models));
  for (const std::string& error : folder.bad_files) reporter.Tell(error);
  reporter.ReadInputs();
  for (const std::string& path : options.sources) reporter.AddSource(path);
  return reporter.Finish() ? 0 : 1;
}

}  // namespace rimod
