#pragma once

#include <memory>
#include <vector>

#include "io/thread_pool.h"
#include "rimod/default_method.h"
#include "rimod/detector.h"

namespace rimod {

// What each stage of the default method gets for the recorded office, and what it makes of it:
// computed once, outside of what is measured. Ends the program with a message where files are
// missing.
struct RecordedInput {
  explicit RecordedInput(const Execution& execution);

  PipelineParams params;
  Scan scan;
  ModelDatabase database;  // of all recordings in logs/
  RangeImage image;
  std::vector<PixelIndex> interest_points;
  FeatureSet features;
  Scene scene;
  ModelMatches matches;
  std::vector<Hypothesis> proposed, ranked;
  std::vector<JudgedCandidate> judged;
};

// The same for all benchmarks.
const RecordedInput& Input();

}  // namespace rimod
