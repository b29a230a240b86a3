#include "viewer_tools/snapshot.h"

#include <spdlog/spdlog.h>

#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <system_error>

#include "io/files.h"
#include "io/model_file.h"
#include "io/scan_source.h"
#include "rimod/detector.h"
#include "viewer_tools/detection_lines.h"
#include "viewer_tools/pictures.h"
#include "viewer_tools/png.h"
#include "viewer_tools/recorded_scans.h"

namespace rimod {
namespace {

// A scan's name, range image and detections, ready to be drawn.
struct DrawableScan {
  std::string name;
  RangeImage image;
  std::vector<Detection> detections;
};

class Painter {
 public:
  Painter(const SnapshotOptions& options, std::vector<ObjectModel> models)
      : options_(options), models_(std::move(models)) {}

  void Draw(DrawableScan scan) {
    FillBoxes(&scan.detections);
    const std::vector<DrawnObject> objects = MakeDrawnObjects(scan.detections, models_);
    const std::string count = std::to_string(objects.size());
    const std::string found = count + (objects.size() == 1 ? " object" : " objects") + " found";
    const std::string size =
        std::to_string(scan.image.width()) + " x " + std::to_string(scan.image.height());
    Write(scan.name + "_range_image",
          DrawRangeImage(scan.image, objects,
                         scan.name + ": range image, " + size + " pixels, " + found));
    Write(scan.name + "_from_above",
          DrawTopView(scan.image, objects, scan.name + ": seen from above, " + found));
  }

  bool failed() const { return failed_; }

 private:
  // Detections from JSON lines know no box: the model does.
  void FillBoxes(std::vector<Detection>* detections) const {
    for (Detection& detection : *detections) {
      if (detection.box_min != detection.box_max) continue;
      for (const ObjectModel& model : models_) {
        if (model.name != detection.class_name) continue;
        detection.box_min = model.box_min;
        detection.box_max = model.box_max;
      }
    }
  }

  void Write(const std::string& name, const cv::Mat& picture) {
    const std::string path = (std::filesystem::path(options_.output) / (name + ".png")).string();
    const std::string bytes = EncodePng(picture);
    const std::string error =
        bytes.empty() ? path + ": the picture cannot be encoded" : WriteFileAtomically(path, bytes);
    if (!error.empty()) {
      spdlog::error("{}", error);
      failed_ = true;
      return;
    }
    std::printf("%s\n", path.c_str());
  }

  const SnapshotOptions& options_;
  std::vector<ObjectModel> models_;
  bool failed_ = false;
};

// Draws scans that arrive one after the other; the first waits until it is known whether it is the
// only one.
class ScanSequence {
 public:
  ScanSequence(Painter* painter, std::string name, int max_scans)
      : painter_(painter), name_(std::move(name)), max_scans_(max_scans) {}

  void Add(RangeImage image, std::vector<Detection> detections) {
    const int number = num_scans_++;
    if (number >= max_scans_) return;
    DrawableScan scan{name_ + "-" + std::to_string(number), std::move(image),
                      std::move(detections)};
    if (number == 0) {
      first_ = std::move(scan);
      return;
    }
    DrawFirst();
    painter_->Draw(std::move(scan));
  }

  void Finish() {
    if (num_scans_ == 1) first_->name = name_;
    DrawFirst();
    if (num_scans_ > max_scans_)
      spdlog::warn("{}: pictures of the first {} of {} scans", name_, max_scans_, num_scans_);
  }

 private:
  void DrawFirst() {
    if (first_) painter_->Draw(std::move(*first_));
    first_.reset();
  }

  Painter* painter_;
  std::string name_;
  int max_scans_;
  int num_scans_ = 0;
  std::optional<DrawableScan> first_;
};

bool DrawLog(const SnapshotOptions& options, Painter* painter) {
  ScanSequence sequence(painter, FileStem(options.log), options.max_scans);
  int num_without_image = 0;
  int num_drawn = 0;
  const RecordedScansReport report =
      ReadRecordedScans(options.log, options.channels, WantedImages::kAll, [&](RecordedScan scan) {
        if (!scan.image) {
          ++num_without_image;
          return;
        }
        ++num_drawn;
        sequence.Add(std::move(*scan.image), std::move(scan.detections.detections));
      });
  sequence.Finish();
  for (const std::string& error : report.errors) spdlog::error("{}", error);
  if (num_without_image > 0)
    spdlog::error("{}: {} scan(s) have detections on {} but no whole range image on {}",
                  options.log, num_without_image, options.channels.detections,
                  options.channels.range_image);
  if (num_drawn == 0 && report.errors.empty() && num_without_image == 0)
    spdlog::error("{}: nothing on {}; it can be replayed through rimod-extractor and rimod-matcher",
                  options.log, options.channels.detections);
  return report.errors.empty() && num_without_image == 0 && num_drawn > 0;
}

bool DrawScanFile(const SnapshotOptions& options, Painter* painter) {
  const DetectionLines detections = ReadDetectionLines(options.detections);
  if (!detections.error.empty()) spdlog::error("{}", detections.error);
  ScanSequence sequence(painter, FileStem(options.scan), options.max_scans);
  const ScanSourceReport report =
      ReadScans(options.scan, options.params.sweep, [&](NamedScan scan) {
        std::vector<Detection> found;
        for (const DetectionLine& line : detections.lines)
          if (line.scan == scan.name) found.push_back(line.detection);
        sequence.Add(ComputeRangeImage(scan.scan, options.params, Execution()), std::move(found));
      });
  sequence.Finish();
  for (const std::string& warning : report.warnings) spdlog::warn("{}", warning);
  for (const std::string& error : report.errors) spdlog::error("{}", error);
  return detections.error.empty() && report.errors.empty();
}

}  // namespace

int RunSnapshot(const SnapshotOptions& options) {
  ModelFolder folder = LoadModelFolder(options.models);
  if (!folder.error.empty()) spdlog::error("{}", folder.error);
  for (const std::string& error : folder.bad_files) spdlog::error("{}", error);
  bool all_well = folder.error.empty() && folder.bad_files.empty();

  std::error_code cause;
  std::filesystem::create_directories(options.output, cause);
  if (cause) {
    spdlog::error("{}: the folder cannot be made: {}", options.output, cause.message());
    return 1;
  }
  Painter painter(options, std::move(folder.models));
  all_well &= options.log.empty() ? DrawScanFile(options, &painter) : DrawLog(options, &painter);
  return all_well && !painter.failed() ? 0 : 1;
}

}  // namespace rimod
