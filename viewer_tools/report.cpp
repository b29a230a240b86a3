#include "viewer_tools/report.h"

#include <spdlog/spdlog.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>

#include "io/files.h"
#include "io/label_file.h"
#include "io/model_file.h"
#include "io/thread_pool.h"
#include "io/version.h"
#include "rimod/detector.h"
#include "viewer_tools/case_folder.h"
#include "viewer_tools/detection_lines.h"
#include "viewer_tools/html.h"
#include "viewer_tools/png.h"
#include "viewer_tools/report_cases.h"
#include "viewer_tools/report_page.h"
#include "viewer_tools/report_sources.h"
#include "viewer_tools/scan_pictures.h"

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

  void TellIf(const std::string& error) {
    if (!error.empty()) Tell(error);
  }

  // False when there is no place to write to.
  bool MakeCaseFolder() {
    if (options_.cases.empty()) return true;
    const std::string error = case_folder_.emplace(options_.cases).Make();
    TellIf(error);
    return error.empty();
  }

  void ReadInputs() {
    if (!options_.labels.empty()) {
      LabelFile labels = ReadLabelFile(options_.labels);
      TellIf(labels.error);
      for (LabelledScan& scan : labels.scans) AddLabels(std::move(scan));
    }
    if (!options_.detections.empty()) {
      const DetectionLines lines = ReadDetectionLines(options_.detections);
      TellIf(lines.error);
      for (const DetectionLine& line : lines.lines)
        inputs_.detections[line.scan].push_back(line.detection);
    }
    if (options_.timing.empty()) return;
    TimingFile timing = ReadTimingFile(options_.timing);
    TellIf(timing.error);
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
    if (case_folder_) TellIf(case_folder_->WriteList());
    const std::string error = WriteFileAtomically(options_.output, MakeReportPage(report_));
    TellIf(error);
    if (error.empty()) std::printf("%s\n", options_.output.c_str());
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
      scan.pictures = DrawScan(source.name, source.image, counted, count, database_.models());
    if (count) counted_.push_back(std::move(counted));
    spdlog::info("{}: {} detections", source.name, scan.detections.size());
  }

  void AddCases(const SourceScan& source, const CountedScan& counted, const HitCount& count) {
    for (FoundCase& found : FindCases(source.name, source.image, counted, count, database_, shapes_,
                                      options_.params, execution_)) {
      const int number = static_cast<int>(report_.cases.size());
      std::string png;
      if (number < options_.max_cases) {
        png = EncodePng(DrawCase(source.image, found.poses, TitleOf(found.words)));
        found.words.picture = DataUri("image/png", png);
      }
      if (case_folder_) TellIf(case_folder_->Add(number, found, png));
      report_.cases.push_back(std::move(found.words));
    }
  }

  static std::string TitleOf(const ReportCase& words) {
    return words.class_name + " in scan " + words.scan + ", " + CaseKindText(words.kind) + ": " +
           words.cause + ". " + words.facts;
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
  std::optional<CaseFolder> case_folder_;
  bool all_well_ = true;
};

}  // namespace

int RunReport(const ReportOptions& options) {
  ModelFolder folder = LoadModelFolder(options.models);
  if (!folder.error.empty()) {
    spdlog::error("{}", folder.error);
    return 1;
  }
  Reporter reporter(options, std::move(folder.models));
  for (const std::string& error : folder.bad_files) reporter.Tell(error);
  if (!reporter.MakeCaseFolder()) return 1;
  reporter.ReadInputs();
  for (const std::string& path : options.sources) reporter.AddSource(path);
  return reporter.Finish() ? 0 : 1;
}

}  // namespace rimod
