#pragma once

#include <opencv2/core/types.hpp>
#include <string>
#include <vector>

namespace rimod {

// Colours of the pictures, 8 bits a channel, in OpenCV's order blue, green, red.
using Colour = cv::Vec3b;

constexpr int kNumObjectColours = 8;

// A strong colour for the index-th class; classes kNumObjectColours apart share one. Each differs
// from the others and from every range and height colour.
Colour ObjectColour(int index);

// One colour a name: the index of the name among the sorted different names.
std::vector<Colour> ColoursByName(const std::vector<std::string>& names);

// From a light cream when near (share 0) over grey-blue to dark blue when far (share 1); shares
// outside are clamped.
Colour RangeColour(double share);

// Grey, from dark on the floor (share 0) to light at the top (share 1); clamped.
Colour HeightColour(double share);

// A pixel where the beam came back without a range.
Colour NoReturnColour();
// A pixel that was never observed: a hatch of two dark colours, by canvas position.
Colour NeverObservedColour(int x, int y);

cv::Scalar ToScalar(const Colour& colour);
// Mixes with share 0 .. 1 of top.
Colour Blend(const Colour& bottom, const Colour& top, double share);

}  // namespace rimod
