#pragma once

#include <Eigen/Core>
#include <vector>

#include "rimod/pose_track.h"
#include "rimod/sweep.h"

namespace rimod {

// A laser line in the local frame.
struct PlacedLine {
  Time begin{0};            // first beam
  Time end{0};              // last beam
  double tilt_begin = 0.0;  // rad, of the laser at the first beam, see TiltOf
  double tilt_end = 0.0;    // rad, at the last beam
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // m, of the laser at the first beam
  Eigen::Vector3d forward = Eigen::Vector3d::Zero();   // unit, laser's x-axis at the first beam
  std::vector<Eigen::Vector3f> points;                 // m, local frame
  std::vector<Eigen::Vector3f> no_return_directions;   // unit, local frame
};

// Tilt of a laser, rad, -pi .. pi: its pitch, 0 when level, positive when it looks down. Neither
// heading nor roll of the carrier (below 90 degrees) changes it.
double TiltOf(const Eigen::Isometry3d& T_local_laser);

// True when the line can be placed at all: 1 .. 16384 beams, angles finite, a turn at most.
bool IsUsableLine(const LaserLine& line);

// Puts lines into the local frame, each beam by the pose at its own time.
class LinePlacer {
 public:
  explicit LinePlacer(const SweepParams& params);

  // us from the first to the last beam.
  double Duration(const LaserLine& line) const;

  // line must be usable and covered by poses. Counts bad and near ranges. The result is valid until
  // the next call.
  const PlacedLine& Place(const LaserLine& line, const PoseTrack& poses, SweepCounters* counters);

 private:
  // Cosine and sine of every beam's angle; lines come with few different angles.
  struct AngleTable {
    double first_angle = 0.0;
    double angle_step = 0.0;
    std::vector<double> cosines, sines;
  };
  const AngleTable& TableOf(const LaserLine& line);
  void PlaceBeams(const LaserLine& line, const AngleTable& table, const PoseMotion& motion,
                  std::size_t begin, std::size_t end, SweepCounters* counters);

  double beam_period_;  // us
  float min_range_, max_range_;
  std::vector<AngleTable> tables_;
  std::size_t next_table_ = 0;
  PlacedLine placed_;
};

}  // namespace rimod
