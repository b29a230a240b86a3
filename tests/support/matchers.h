#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <functional>
#include <stdexcept>
#include <string>

namespace rimod {

// That two poses differ by at most so many metres and radians.
inline testing::AssertionResult PosesNear(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b,
                                          double metres, double radians) {
  const double apart = (a.translation() - b.translation()).norm();
  const double turned =
      Eigen::Quaterniond(a.linear()).angularDistance(Eigen::Quaterniond(b.linear()));
  if (apart <= metres && turned <= radians) return testing::AssertionSuccess();
  return testing::AssertionFailure()
         << "poses are " << apart << " m and " << turned << " rad apart, translations "
         << a.translation().transpose() << " and " << b.translation().transpose();
}

// That the call throws std::invalid_argument with a text that holds all of these words.
inline testing::AssertionResult Complains(const std::function<void()>& call,
                                          const std::initializer_list<std::string>& words) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    const std::string text = error.what();
    for (const std::string& word : words) {
      if (text.find(word) == std::string::npos)
        return testing::AssertionFailure() << "'" << text << "' does not name " << word;
    }
    return testing::AssertionSuccess();
  }
  return testing::AssertionFailure() << "no complaint";
}

}  // namespace rimod
