#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "rimod/execution.h"
#include "rimod/object_model.h"
#include "rimod/params.h"
#include "rimod/recording.h"

namespace rimod {

// Joins the scans, cuts the object out of its surroundings, cleans and evens its surface and
// computes its views (paper, sections III-A, III-C, V). Throws std::invalid_argument when hardly
// any point is inside the box.
ObjectModel BuildModel(const Recording& recording, const PipelineParams& params,
                       const Execution& execution);

// From points of the object alone, in the object frame, seen from all around or from some sides
// only.
ObjectModel BuildModelFromPoints(const std::string& class_name,
                                 const std::vector<Eigen::Vector3f>& points,
                                 const PipelineParams& params, const Execution& execution);

// From a mesh in the object frame: its surface is sampled evenly.
ObjectModel BuildModelFromMesh(const std::string& class_name, const Mesh& mesh,
                               const PipelineParams& params, const Execution& execution);

}  // namespace rimod
