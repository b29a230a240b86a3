#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rimod/hit_counting.h"
#include "viewer_tools/detector_trace.h"

namespace rimod {

// Short automatic causes of misses and false alarms.

// Everything that is known of the scan in which a case lies. Refers to what it is made from.
struct CaseContext {
  const RangeImage& image;
  const CountedScan& scan;
  const DetectorTrace& trace;
  const ModelDatabase& database;  // with all classes of the labels
  const ObjectShapes& shapes;     // ditto
  const PipelineParams& params;
};

struct Explanation {
  std::string cause;   // a few words; the same for all cases of one kind
  std::string detail;  // the figures of this one
  // Of a miss: the right or nearest candidate of its class from the last stage that had one.
  std::optional<Candidate> best;
};

// Number of a model in the database, -1 when it is not there.
int ModelNumber(const ModelDatabase& database, const std::string& class_name);

// Why the scan's object was not found: the first stage of the trace without a right candidate, or a
// detection of its class that lies beside it.
Explanation ExplainMiss(const CaseContext& context, int object);

// Why the scan's detection is false: found twice, another class, pose too far off, a part of
// another labelled object, something smaller (two sides of the model are seen through), clutter
// that is flat or not.
Explanation ExplainFalseAlarm(const CaseContext& context, int detection,
                              const CountedDetection& counted);

}  // namespace rimod
