#include "viewer_tools/palette.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace rimod {
namespace {

Colour Between(const Colour& a, const Colour& b, double share) {
  return Blend(a, b, std::clamp(share, 0.0, 1.0));
}

}  // namespace

Colour ObjectColour(int index) {
  // Saturated hues that also differ in lightness, for readers who see fewer colours.
  static constexpr std::array<std::array<unsigned char, 3>, kNumObjectColours> kColours = {{
      {0, 140, 255},    // orange
      {60, 220, 60},    // green
      {220, 60, 255},   // magenta
      {0, 235, 255},    // yellow
      {255, 200, 0},    // sky blue
      {70, 70, 255},    // red
      {255, 110, 110},  // periwinkle
      {100, 150, 0},    // teal
  }};
  const std::array<unsigned char, 3>& colour =
      kColours[static_cast<std::size_t>(index) % kNumObjectColours];
  return Colour(colour[0], colour[1], colour[2]);
}

std::vector<Colour> ColoursByName(const std::vector<std::string>& names) {
  std::map<std::string, int> indices;
  for (const std::string& name : names) indices.emplace(name, 0);
  int index = 0;
  for (auto& [name, value] : indices) value = index++;
  std::vector<Colour> colours;
  colours.reserve(names.size());
  for (const std::string& name : names) colours.push_back(ObjectColour(indices[name]));
  return colours;
}

Colour RangeColour(double share) {
  const Colour near(214, 232, 240);
  const Colour middle(160, 140, 100);
  const Colour far(64, 36, 22);
  return share < 0.5 ? Between(near, middle, 2.0 * share) : Between(middle, far, 2.0 * share - 1.0);
}

Colour HeightColour(double share) {
  return Between(Colour(82, 74, 68), Colour(215, 210, 205), share);
}

Colour NoReturnColour() { return Colour(84, 24, 64); }

Colour NeverObservedColour(int x, int y) {
  constexpr int kPeriod = 8;  // canvas pixels
  return (x + y) % kPeriod < 2 ? Colour(60, 60, 60) : Colour(22, 22, 22);
}

cv::Scalar ToScalar(const Colour& colour) { return cv::Scalar(colour[0], colour[1], colour[2]); }

Colour Blend(const Colour& bottom, const Colour& top, double share) {
  Colour mixed;
  for (int channel = 0; channel < 3; ++channel) {
    const double value = bottom[channel] * (1.0 - share) + top[channel] * share;
    mixed[channel] = static_cast<unsigned char>(std::lround(value));
  }
  return mixed;
}

}  // namespace rimod
