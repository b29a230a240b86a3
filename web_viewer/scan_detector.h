#pragma once

#include <cstdint>
#include <vector>

#include "io/thread_pool.h"
#include "rimod/model_database.h"
#include "rimod/object_model.h"
#include "rimod/params.h"
#include "rimod/scan.h"
#include "web_viewer/scan_history.h"

namespace rimod {

// Finds objects in scans that nobody has looked for objects in yet, as rimod-detect does.
class ScanDetector {
 public:
  // num_threads: 0 for as many as the machine has. Throws std::invalid_argument for models that
  // cannot be used together.
  ScanDetector(std::vector<ObjectModel> models, const PipelineParams& params, int num_threads);

  // Puts hypotheses and detections of a scan into the history.
  void Detect(std::int64_t utime, const Scan& scan, ScanHistory* history);

 private:
  ThreadPool pool_;
  PipelineParams params_;
  ModelDatabase database_;
};

}  // namespace rimod
