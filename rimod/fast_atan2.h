#pragma once

#include <cmath>

namespace rimod {

// atan(t) for 0 <= t <= 1, error below 2e-6 rad (polynomial in t^2, minimax).
inline float AtanUnit(float t) {
  const float t2 = t * t;
  float sum = -0.0117212f;
  sum = sum * t2 + 0.05265332f;
  sum = sum * t2 - 0.11643287f;
  sum = sum * t2 + 0.19354346f;
  sum = sum * t2 - 0.33262347f;
  sum = sum * t2 + 0.99997726f;
  return t * sum;
}

// std::atan2 to 2e-6 rad, finite for all finite input. Without branches, so that loops over it are
// vectorised.
inline float FastAtan2(float y, float x) {
  constexpr float kPi = 3.14159265f, kTiny = 1e-30f;
  const float ax = std::abs(x), ay = std::abs(y);
  const float larger = ax > ay ? ax : ay, smaller = ax > ay ? ay : ax;
  const float first = AtanUnit(smaller / (larger > kTiny ? larger : kTiny));
  const float steep = ay > ax ? 0.5f * kPi - first : first;
  const float angle = x < 0.0f ? kPi - steep : steep;
  return y < 0.0f ? -angle : angle;
}

}  // namespace rimod
