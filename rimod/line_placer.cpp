#include "rimod/line_placer.h"

#include <cmath>

namespace rimod {
namespace {

constexpr std::size_t kMaxBeams = 16384;  // far beyond any scanner: keeps buffers bounded
constexpr std::size_t kMaxTables = 4;     // interlaced scanners need two
constexpr double kTurn = 2.0 * M_PI;

}  // namespace

double TiltOf(const Eigen::Isometry3d& T_local_laser) {
  return std::atan2(-T_local_laser(2, 0), T_local_laser(2, 2));
}

bool IsUsableLine(const LaserLine& line) {
  if (line.ranges.empty() || line.ranges.size() > kMaxBeams) return false;
  if (!std::isfinite(line.first_angle) || !std::isfinite(line.angle_step)) return false;
  constexpr double kTolerance = 1e-3;  // angles arrive as floats
  const double span = std::abs(line.angle_step) * static_cast<double>(line.ranges.size() - 1);
  const bool beams_apart = line.angle_step != 0.0 || line.ranges.size() == 1;
  return beams_apart && std::abs(line.first_angle) <= 2.0 * kTurn && span <= kTurn + kTolerance;
}

LinePlacer::LinePlacer(const SweepParams& params)
    : beam_period_(params.line_duration * 1e6 / params.beams_per_line),
      min_range_(static_cast<float>(params.min_range)),
      max_range_(static_cast<float>(params.max_range)) {}

double LinePlacer::Duration(const LaserLine& line) const {
  return static_cast<double>(line.ranges.size() - 1) * beam_period_;
}

const PlacedLine& LinePlacer::Place(const LaserLine& line, const PoseTrack& poses,
                                    SweepCounters* counters) {
  const double duration = Duration(line);
  const Eigen::Isometry3d T_local_first = poses.At(line.time, 0.0);
  placed_.begin = line.time;
  placed_.end = line.time + Time(std::llround(duration));
  placed_.tilt_begin = TiltOf(T_local_first);
  placed_.tilt_end = TiltOf(poses.At(line.time, duration));
  placed_.position = T_local_first.translation();
  placed_.forward = T_local_first.linear().col(0);
  placed_.points.clear();
  placed_.no_return_directions.clear();

  const AngleTable& table = TableOf(line);
  std::size_t begin = 0;
  for (std::size_t i = poses.IndexBefore(line.time); begin < line.ranges.size(); ++i) {
    const PoseMotion motion = poses.MotionAfter(i, line.time);
    std::size_t end = begin;
    while (end < line.ranges.size() && static_cast<double>(end) * beam_period_ <= motion.end) ++end;
    PlaceBeams(line, table, motion, begin, end, counters);
    begin = end;
  }
  return placed_;
}

const LinePlacer::AngleTable& LinePlacer::TableOf(const LaserLine& line) {
  const std::size_t num_beams = line.ranges.size();
  for (const AngleTable& table : tables_) {
    if (table.first_angle == line.first_angle && table.angle_step == line.angle_step &&
        table.cosines.size() >= num_beams) {
      return table;
    }
  }
  if (tables_.size() < kMaxTables) tables_.emplace_back();
  AngleTable& table = tables_[next_table_];
  next_table_ = (next_table_ + 1) % kMaxTables;
  table.first_angle = line.first_angle;
  table.angle_step = line.angle_step;
  table.cosines.resize(num_beams);
  table.sines.resize(num_beams);
  for (std::size_t i = 0; i < num_beams; ++i) {
    const double angle = line.first_angle + static_cast<double>(i) * line.angle_step;
    table.cosines[i] = std::cos(angle);
    table.sines[i] = std::sin(angle);
  }
  return table;
}

void LinePlacer::PlaceBeams(const LaserLine& line, const AngleTable& table,
                            const PoseMotion& motion, std::size_t begin, std::size_t end,
                            SweepCounters* counters) {
  // Beams are equally spaced in time, so the turn made so far grows by the same angle from beam to
  // beam: its cosine and sine follow from the last one's.
  const double share_step = beam_period_ / (motion.end - motion.begin);
  const double first_share = motion.Share(static_cast<double>(begin) * beam_period_);
  const double cos_step = std::cos(motion.angle * share_step);
  const double sin_step = std::sin(motion.angle * share_step);
  double cos_turn = std::cos(motion.angle * first_share);
  double sin_turn = std::sin(motion.angle * first_share);
  std::size_t num_points = placed_.points.size();
  placed_.points.resize(num_points + end - begin);
  for (std::size_t i = begin; i < end; ++i) {
    const float range = line.ranges[i];
    if (range >= min_range_) {
      const Eigen::Vector3d beam =
          (motion.fixed.col(0) + cos_turn * motion.cosine.col(0) + sin_turn * motion.sine.col(0)) *
              table.cosines[i] +
          (motion.fixed.col(1) + cos_turn * motion.cosine.col(1) + sin_turn * motion.sine.col(1)) *
              table.sines[i];
      if (range < max_range_) {
        const double share = first_share + static_cast<double>(i - begin) * share_step;
        const Eigen::Vector3d p_local =
            motion.position + share * motion.translation + static_cast<double>(range) * beam;
        placed_.points[num_points++] = p_local.cast<float>();
      } else {
        placed_.no_return_directions.emplace_back(beam.cast<float>());
      }
    } else if (range >= 0.0f) {
      ++counters->near_ranges;
    } else {  // negative or NaN
      ++counters->bad_ranges;
    }
    const double cos_next = cos_turn * cos_step - sin_turn * sin_step;
    sin_turn = sin_turn * cos_step + cos_turn * sin_step;
    cos_turn = cos_next;
  }
  placed_.points.resize(num_points);
}

}  // namespace rimod
