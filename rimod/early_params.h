#pragma once

namespace rimod {

// Detections while a sweep still goes on (not in the paper, whose robot stands still for one).
struct EarlyParams {
  double period = 1.0;            // s of a sweep after which it is looked at anew; 0.05 .. 3600
  double max_unseen_share = 0.2;  // of an object's near side that was not swept yet; 0 .. 1
  double min_score = 0.9;         // of a detection to be told early; 0 .. 1
  int min_sightings = 1;          // .. in so many looks in a row; 1 .. 100
  int max_misses = 1;  // looks in a row that may miss an object before it is withdrawn; 0 .. 100
  double same_object_distance =
      0.4;                // of the diameter: nearer detections of a class are one object; 0 .. 10
  void Validate() const;  // throws std::invalid_argument naming field and value
};

}  // namespace rimod
