#pragma once

#include <optional>

#include "rimod/pixel_grid.h"
#include "rimod/scan.h"

namespace rimod {

// The optical axis for a pinhole image of a scan (level sensor frame): the middle of the field of
// view, in whole degrees, so that it stays the same from scan to scan; what looks straight up or
// down but for 2.5 degrees counts as vertical, with azimuth 0. Points nearer than min_range (m) do
// not count. The points' order does not matter. Nothing where a beam is more than 60 degrees away
// from it, and of an empty scan.
std::optional<Direction> PinholeAxis(const Scan& scan, double min_range);

}  // namespace rimod
