#include "rimod/growing_scan.h"

#include <cstddef>

namespace rimod {
namespace {

// 240 MB of points, the most that a sweep may have (SweepCollector).
constexpr std::size_t kMaxPoints = 20000000;

// Poses from which a scan looks the same.
bool IsAbout(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  constexpr double kApart = 0.03;   // m, less than a scan's sensor itself moves about its pose
  constexpr double kTurned = 0.02;  // rad
  return (a.translation() - b.translation()).norm() < kApart &&
         Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle() < kTurned;
}

}  // namespace

bool GrowingScan::Add(const SweepGrowth& growth) {
  if (growth.step == 0) {
    scan_ = growth.scan;
    num_lines_ = 0;
  } else {
    if (!scan_) return false;
    const bool is_next = growth.sweep_begin == sweep_begin_ && growth.step == next_step_;
    const std::size_t size = scan_->points.size() + scan_->no_return_directions.size() +
                             growth.scan.points.size() + growth.scan.no_return_directions.size();
    if (!is_next || size > kMaxPoints) {
      scan_.reset();
      return false;
    }
    if (!IsAbout(scan_->T_local_sensor, growth.scan.T_local_sensor))
      scan_->T_local_sensor = growth.scan.T_local_sensor;
    scan_->points.insert(scan_->points.end(), growth.scan.points.begin(), growth.scan.points.end());
    scan_->no_return_directions.insert(scan_->no_return_directions.end(),
                                       growth.scan.no_return_directions.begin(),
                                       growth.scan.no_return_directions.end());
  }
  sweep_begin_ = growth.sweep_begin;
  end_ = growth.end;
  next_step_ = growth.step + 1;
  num_lines_ += growth.num_lines;
  return true;
}

bool GrowingScan::IsWhole(const SweepEnd& end) const {
  return scan_ && sweep_begin_ == end.begin && end_ == end.end && next_step_ == end.num_steps &&
         num_lines_ == end.num_lines && scan_->points.size() == end.num_points &&
         scan_->no_return_directions.size() == end.num_no_returns;
}

}  // namespace rimod
