#include "web_viewer/scan_detector.h"

#include <chrono>
#include <utility>

#include "rimod/detector.h"

namespace rimod {

ScanDetector::ScanDetector(std::vector<ObjectModel> models, const PipelineParams& params,
                           int num_threads)
    : pool_(num_threads),
      params_(params),
      database_(std::move(models), params, pool_.MakeExecution()) {}

void ScanDetector::Detect(std::int64_t utime, const Scan& scan, ScanHistory* history) {
  const auto begin = std::chrono::steady_clock::now();
  const Execution execution = pool_.MakeExecution();
  const RangeImage image = ComputeRangeImage(scan, params_, execution);
  const FeatureSet features = ExtractFeatures(image, params_, execution);
  DetectionResult result = DetectObjects(image, features, database_, params_, execution);
  const std::chrono::duration<double, std::milli> elapsed =
      std::chrono::steady_clock::now() - begin;
  StampedDetections detections;
  detections.utime = utime;
  detections.T_local_sensor = scan.T_local_sensor;
  detections.num_models = static_cast<int>(database_.models().size());
  detections.detections = std::move(result.detections);
  detections.stage_times = {{"total", elapsed.count()}};
  history->SetHypotheses(utime, std::move(result.hypotheses), result.num_hypotheses_found);
  history->SetDetections(detections);
}

}  // namespace rimod
