#pragma once

#include <optional>
#include <string>

namespace rimod {

// What was found in scans, summed up (rimod/hit_counting.h has the rules).
struct ScanCounts {
  int scans = 0;
  int right = 0;         // objects found
  int posed = 0;         // of these within 10 cm and 15 degrees
  int false_alarms = 0;  // detections where no object of their class is, and repeated ones
  int missed = 0;
  double ms = 0.0;  // processor time
  ScanCounts& operator+=(const ScanCounts& other);
  double Recall() const;     // 0 without objects
  double Precision() const;  // 1 without detections
};

// What the best parameters make as large as possible.
struct Objective {
  enum class Kind {
    kF,         // weighted harmonic mean of recall and precision
    kPosedF,    // the same, where a wrong pose counts as a false alarm and a miss
    kZeta,      // the paper's, section IV: right^2 / (missed^2 + false alarms)
    kRecallAt,  // recall, where the precision is at least min_precision
  };
  Kind kind = Kind::kF;
  double beta = 1.0;           // of F: recall weighs beta times as much as precision; > 0
  double min_precision = 0.0;  // of kRecallAt; 0 .. 1
  double max_ms = 0.0;         // processor time a scan in the mean, more is never best; 0 = any

  // Larger is better; equal counts give equal scores. 0 .. 1, but zeta from 0, below 0 where the
  // precision is too low, and below -1 where it takes too long. Finite.
  double Score(const ScanCounts& counts) const;
};

// "f1", "f0.5", "f2" (any number), "pose-f1", "zeta", "recall@0.95"; nothing for others.
std::optional<Objective> ObjectiveFrom(const std::string& name);

}  // namespace rimod
