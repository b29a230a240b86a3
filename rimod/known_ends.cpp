#include "rimod/known_ends.h"

#include <cmath>

namespace rimod {
namespace {

constexpr int kRepeatedToKnow = 2;
constexpr double kShareOfLine = 0.5;

}  // namespace

void KnownEnds::Follow(int direction, double tilt_begin, double tilt_end, std::size_t line) {
  if (direction == 0 || reached_) return;
  const End& end = EndOf(direction);
  if (!end.seen) return;
  const double missing = direction * std::remainder(end.tilt - tilt_end, 2.0 * M_PI);
  reached_ = missing <= kShareOfLine * std::abs(tilt_end - tilt_begin);
  known_ = end.num_repeated >= kRepeatedToKnow;
  first_line_ = line;
}

void KnownEnds::Learn(int direction, double tilt_end, std::size_t line) {
  if (direction == 0) return;
  End& end = EndOf(direction);
  end.num_repeated = reached_ && first_line_ == line ? end.num_repeated + 1 : 0;
  end.tilt = tilt_end;
  end.seen = true;
}

}  // namespace rimod
