#include "rimod/absolute_orientation.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/io/random_values.h"
#include "tests/support/matchers.h"

namespace rimod {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Points RandomPoints(RandomValues* random, int count, double reach = 1.0) {
  Points points;
  for (int i = 0; i < count; ++i) points.push_back(random->Vector(reach));
  return points;
}

Points Moved(const Eigen::Isometry3d& T, const Points& points) {
  Points moved;
  for (const Eigen::Vector3d& p : points) moved.push_back(T * p);
  return moved;
}

double SquaredError(const Eigen::Isometry3d& T, const Points& from, const Points& to) {
  double sum = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) sum += (T * from[i] - to[i]).squaredNorm();
  return sum;
}

void ExpectRotation(const Eigen::Isometry3d& T) {
  EXPECT_TRUE(T.matrix().allFinite());
  EXPECT_NEAR(T.linear().determinant(), 1.0, 1e-9);
  EXPECT_TRUE((T.linear() * T.linear().transpose()).isIdentity(1e-9));
}

TEST(AbsoluteOrientationTest, RecoversAnyRigidTransformation) {
  RandomValues random(1);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Isometry3d T = random.Pose();
    const Points from = RandomPoints(&random, random.Int(3, 20));
    const Eigen::Isometry3d found = AbsoluteOrientation(from, Moved(T, from));
    for (const Eigen::Vector3d& p : from) EXPECT_NEAR((found * p - T * p).norm(), 0.0, 1e-9);
    ExpectRotation(found);
  }
}

TEST(AbsoluteOrientationTest, RecoversHalfTurns) {
  RandomValues random(2);
  for (int i = 0; i < 50; ++i) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = Eigen::AngleAxisd(M_PI, random.Unit()).toRotationMatrix();
    const Points from = RandomPoints(&random, 4);
    EXPECT_TRUE(PosesNear(AbsoluteOrientation(from, Moved(T, from)), T, 1e-6, 1e-6));
  }
}

TEST(AbsoluteOrientationTest, NoSmallChangeImprovesOnItUnderNoise) {
  RandomValues random(3);
  for (int i = 0; i < 50; ++i) {
    const Points from = RandomPoints(&random, random.Int(3, 10));
    Points to = Moved(random.Pose(), from);
    for (Eigen::Vector3d& p : to) p += random.Vector(0.05);
    const Eigen::Isometry3d best = AbsoluteOrientation(from, to);
    const double error = SquaredError(best, from, to);
    for (int k = 0; k < 100; ++k) {
      Eigen::Isometry3d changed = best;
      changed.rotate(Eigen::AngleAxisd(random.Between(-0.02, 0.02), random.Unit()));
      changed.translation() += random.Vector(0.01);
      EXPECT_GE(SquaredError(changed, from, to), error - 1e-12);
    }
  }
}

TEST(AbsoluteOrientationTest, MirroredPointsStillGetARotation) {
  RandomValues random(4);
  const Points from = RandomPoints(&random, 10);
  Points to = from;
  for (Eigen::Vector3d& p : to) p.x() = -p.x();
  ExpectRotation(AbsoluteOrientation(from, to));
}

TEST(AbsoluteOrientationTest, DegeneratePointsGiveAnOptimalFinitePose) {
  RandomValues random(5);
  const Eigen::Isometry3d T = random.Pose();
  const Points one{{1, 2, 3}};
  const Points same(5, Eigen::Vector3d(1, 2, 3));
  Points line;
  for (int i = 0; i < 5; ++i)
    line.push_back(Eigen::Vector3d(1, 2, 3) + i * Eigen::Vector3d(1, 1, 0));
  for (const Points& from : {one, same, line}) {
    const Eigen::Isometry3d found = AbsoluteOrientation(from, Moved(T, from));
    ExpectRotation(found);
    EXPECT_NEAR(SquaredError(found, from, Moved(T, from)), 0.0, 1e-12);
  }
}

TEST(AbsoluteOrientationTest, RejectsListsThatDoNotPair) {
  EXPECT_THROW(AbsoluteOrientation({}, {}), std::invalid_argument);
  EXPECT_THROW(AbsoluteOrientation({{0, 0, 0}}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace rimod
