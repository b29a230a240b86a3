#pragma once

#include <cstdint>
#include <optional>

#include "rimod/scan.h"
#include "rimod/sweep.h"

namespace rimod {

// Puts the growths of sweeps together: what a sweep that still goes on has seen so far.
class GrowingScan {
 public:
  // True when the scan has grown. A first step begins anew, whatever was there. A step that is not
  // the next one of its sweep gives up what was there: until the next first step nothing grows.
  // So does a scan that would have more than 20 million points and beams.
  bool Add(const SweepGrowth& growth);

  // True when all growths of the sweep are there and nothing else is: with the end's sensor pose
  // the scan is that of the sweep.
  bool IsWhole(const SweepEnd& end) const;

  // Nothing before the first step and after giving up. Its sensor pose is the newest growth's or an
  // earlier one that is about the same, so that what was seen stays where it was.
  const std::optional<Scan>& scan() const { return scan_; }
  // Of the sweep and what is known of it; valid where there is a scan.
  Time sweep_begin() const { return sweep_begin_; }
  Time end() const { return end_; }

 private:
  std::optional<Scan> scan_;
  Time sweep_begin_{0};
  Time end_{0};
  int next_step_ = 0;
  std::int64_t num_lines_ = 0;
};

}  // namespace rimod
