#pragma once

#include <array>
#include <cstddef>

namespace rimod {

// Where a tilting unit turns back or stops: it mostly does so at the same tilts again and again, so
// that a line which gets there is the sweep's last, before anything else tells it. An end counts as
// known when the last three sweeps of its direction ended there, to half a line.
class KnownEnds {
 public:
  // A new sweep begins.
  void Begin() { reached_ = false; }
  // A line of the sweep at hand: direction of its sweep (-1, +1; 0: not known yet), the tilt (rad)
  // at its first and last beam, its number in whatever count.
  void Follow(int direction, double tilt_begin, double tilt_end, std::size_t line);
  // A complete sweep ended at this tilt with this line.
  void Learn(int direction, double tilt_end, std::size_t line);

  // True when this line of the sweep at hand was the first to reach a known end.
  bool ReachedWith(std::size_t line) const { return reached_ && known_ && first_line_ == line; }

 private:
  struct End {
    bool seen = false;
    double tilt = 0.0;     // rad, where the last sweep ended
    int num_repeated = 0;  // sweeps in a row that ended where the one before did
  };
  End& EndOf(int direction) { return ends_[direction > 0 ? 1 : 0]; }

  std::array<End, 2> ends_;  // of sweeps upwards, downwards
  bool reached_ = false;     // the last sweep's end, by the sweep at hand
  bool known_ = false;       // that was a known end
  std::size_t first_line_ = 0;
};

}  // namespace rimod
