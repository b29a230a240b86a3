#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace rimod {

// A scored pose of one of the database's models.
struct Candidate {
  int model = 0;  // in the database
  Eigen::Isometry3d T_sensor_object = Eigen::Isometry3d::Identity();
  double score = 0.0;
};

using CandidateList = std::vector<Candidate>;

// The candidates that passed each stage of a method, best first.
struct StagedCandidates {
  int num_found = 0;  // poses that were worth a score
  CandidateList scored;
  CandidateList pruned;
  CandidateList collision_free;
  CandidateList validated;
};

}  // namespace rimod
