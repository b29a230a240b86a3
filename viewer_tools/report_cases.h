#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rimod/hit_counting.h"
#include "rimod/model_database.h"
#include "rimod/params.h"
#include "viewer_tools/case_picture.h"
#include "viewer_tools/report_page.h"

namespace rimod {

// A case with what to draw of it.
struct FoundCase {
  ReportCase words;  // without its picture
  // Of the object or the detection; nothing where it does not apply.
  std::optional<LabelledObject> object;
  std::optional<double> score;
  std::optional<double> score_at_label;  // that a hypothesis started at the label would get
  std::vector<CasePose> poses;           // models are the database's
};

// The misses, false alarms and poses that are off in one scan, with their causes: the detector's
// stages are run anew, with the given parameters. counted must be CountHits() of this scan alone.
std::vector<FoundCase> FindCases(const std::string& scan_name, const RangeImage& image,
                                 const CountedScan& scan, const HitCount& counted,
                                 const ModelDatabase& database, const ObjectShapes& shapes,
                                 const PipelineParams& params, const Execution& execution);

}  // namespace rimod
