#pragma once

#include <cstdint>
#include <vector>

#include "rimod/sweep.h"
#include "scanner_proc/ray_caster.h"
#include "scanner_proc/scene.h"

namespace rimod::simulation {

constexpr int kNoObject = -1;

// What one beam did.
struct Beam {
  Ray ray;                          // its middle, with the error of its direction
  int object_hit = kNoObject;       // index of the object that its middle meets
  int object_measured = kNoObject;  // of the object whose range was read; none without a return
};

struct ScannedLine {
  LaserLine line;
  std::vector<Beam> beams;  // one a range
};

// A line scanner on a tilting unit, in a scene. Sweeps follow each other, down and up in turn, with
// rests of sensor.pause between them. Every line depends on the scene, its seed and the line's
// index only: lines may be scanned in any order.
//
// A beam is a bundle of rays. Surfaces in it nearer to each other than mixing_distance give one
// averaged reading (mixed pixels); of others the one that sends most light back wins. The light
// that comes back is reflectivity * cos(incidence), falling with the square of the range beyond
// kFullSignalRange. A signal s is lost with probability exp(-s / dark_signal).
class LaserScanner {
 public:
  static constexpr double kFullSignalRange = 10.0;  // m

  // The caster must outlive the scanner. start_utime is the time of line 0's first beam, us.
  LaserScanner(const Sensor& sensor, const Noise& noise, const RayCaster& caster,
               std::uint64_t seed, std::int64_t start_utime);

  // Of one sweep.
  int num_lines() const { return num_lines_; }
  // From the start of a sweep to the start of the next: its lines and those of the rest.
  int LinesPerSweep() const { return num_lines_ + num_pause_lines_; }

  // Start of a line, us. Lines are counted on through all sweeps.
  Time LineTime(std::int64_t line) const;
  // The laser's pose so many lines after the start.
  Eigen::Isometry3d PoseAt(double lines) const;
  // The pose at a line's start, as the tilting unit tells it.
  TimedPose TimedPoseOf(std::int64_t line) const;
  ScannedLine Scan(std::int64_t line) const;

 private:
  class Random;
  double TiltAt(double lines) const;
  float Measure(Beam* beam, Random* random) const;

  Sensor sensor_;
  Noise noise_;
  const RayCaster& caster_;
  std::uint64_t seed_;
  std::int64_t start_utime_;
  int num_lines_ = 0;
  int num_pause_lines_ = 0;
  std::vector<Eigen::Vector2d> bundle_;  // rays of a beam: offsets across it, rad
};

}  // namespace rimod::simulation
