#include "rimod/plane_normal.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <random>

namespace rimod {
namespace {

class PlaneNormalTest : public testing::Test {
 protected:
  double Real(double first, double last) {
    return std::uniform_real_distribution<double>(first, last)(generator_);
  }
  // Rotated; the eigenvalues are given.
  Eigen::Matrix3d Spread(double a, double b, double c) {
    const Eigen::Matrix3d R = Eigen::Quaterniond(Real(-1, 1), Real(-1, 1), Real(-1, 1), Real(-1, 1))
                                  .normalized()
                                  .toRotationMatrix();
    return R * Eigen::Vector3d(a, b, c).asDiagonal() * R.transpose();
  }
  std::mt19937 generator_{7};
};

TEST_F(PlaneNormalTest, IsThatOfAnEigenvalueSolver) {
  for (int i = 0; i < 5000; ++i) {
    const double largest = std::pow(10.0, Real(-6.0, 2.0));  // m^2
    const double second = largest * Real(0.02, 1.0);
    const double smallest = second * std::pow(10.0, Real(-7.0, -0.5));
    const Eigen::Matrix3f covariance = Spread(smallest, second, largest).cast<float>();
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance.cast<double>());
    const Eigen::Vector3d expected = solver.eigenvectors().col(0);
    const Eigen::Vector3d normal = PlaneNormal(covariance).cast<double>();
    EXPECT_NEAR(normal.norm(), 1.0, 1e-5);
    EXPECT_GT(std::abs(normal.dot(expected)), 1.0 - 1e-5)
        << smallest << ' ' << second << ' ' << largest;
  }
}

TEST_F(PlaneNormalTest, APlaneOfTheAxesGivesTheThird) {
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Matrix3f covariance = Eigen::Matrix3f::Identity();
    covariance(axis, axis) = 0.0f;
    EXPECT_NEAR(std::abs(PlaneNormal(covariance)[axis]), 1.0f, 1e-6f);
  }
}

TEST_F(PlaneNormalTest, WhereThereIsNoPlaneItIsZeroOrUnit) {
  EXPECT_EQ(PlaneNormal(Eigen::Matrix3f::Zero()), Eigen::Vector3f::Zero());
  EXPECT_EQ(PlaneNormal(Eigen::Matrix3f::Constant(NAN)), Eigen::Vector3f::Zero());
  Eigen::Matrix3f line = Eigen::Matrix3f::Zero();
  line(1, 1) = 2.0f;
  EXPECT_EQ(PlaneNormal(line), Eigen::Vector3f::Zero());
  for (int i = 0; i < 100; ++i) {
    const Eigen::Matrix3f ball = Eigen::Matrix3f::Identity() * static_cast<float>(Real(1e-6, 1.0));
    const float length = PlaneNormal(ball).norm();
    EXPECT_TRUE(length == 0.0f || std::abs(length - 1.0f) < 1e-5f) << length;
    const float of_line = PlaneNormal(Spread(0.0, 0.0, Real(0.1, 1.0)).cast<float>()).norm();
    EXPECT_TRUE(of_line == 0.0f || std::abs(of_line - 1.0f) < 1e-5f) << of_line;
  }
}

}  // namespace
}  // namespace rimod
