#include "rimod/feature_origin.h"

#include <gtest/gtest.h>

#include <cmath>

#include "rimod/detector.h"
#include "rimod/feature_extraction.h"
#include "tests/io/random_values.h"
#include "tests/support/pile.h"

namespace rimod {
namespace {

TEST(FeatureOriginTest, PointsOfAnyImageAreItsOwn) {
  RandomValues random(1);
  for (int i = 0; i < 50; ++i) {
    const RangeImage image = random.AnImage(random.Int(5, 900), random.Int(5, 200));
    EXPECT_TRUE(AreFeaturesOf(image, random.FeaturesOf(image, 200, 0)));
  }
}

// Where the azimuth jumps from -180 to 180 degrees.
TEST(FeatureOriginTest, AGridThatGoesOnBehindTheSensorKnowsItsPoints) {
  for (const double left : {M_PI + 0.03, -M_PI + 0.03, 2.0 * M_PI}) {
    PixelGrid grid;
    grid.width = 20;
    grid.height = 1;
    grid.resolution = 0.007;
    grid.left = left;
    RangeImage image(grid, Eigen::Isometry3d::Identity());
    FeatureSet features;
    for (int column = 0; column < grid.width; ++column) {
      image.SetMeasured(0, column, {4000, -128, 127});
      features.features.emplace_back().position = image.point(0, column);
    }
    EXPECT_TRUE(AreFeaturesOf(image, features));
  }
}

TEST(FeatureOriginTest, APointThatIsElsewhereByAStepGivesItAway) {
  RandomValues random(2);
  const RangeImage image = random.AnImage(300, 100);
  const FeatureSet features = random.FeaturesOf(image, 50, 0);
  for (int axis = 0; axis < 3; ++axis) {
    FeatureSet moved = features;
    moved.features[17].position[axis] += static_cast<float>(PixelRounding::kRangeUnit);
    EXPECT_FALSE(AreFeaturesOf(image, moved));
  }
  FeatureSet nowhere = features;
  nowhere.features[3].position.setZero();
  EXPECT_FALSE(AreFeaturesOf(image, nowhere));
  EXPECT_FALSE(AreFeaturesOf(RangeImage(), features));
  EXPECT_TRUE(AreFeaturesOf(RangeImage(), FeatureSet()));
}

// The same place seen from the same position, with the noise of another sweep.
TEST(FeatureOriginTest, ExtractedFeaturesAreOfTheirOwnSweepAlone) {
  const PipelineParams params = DefaultParams(Method::kDefault);
  RandomValues random(3);
  std::vector<RangeImage> images;
  std::vector<FeatureSet> features;
  const Scan still = PileScan(Placed(2.2, 0.2, 0.0, 2.8));
  for (int sweep = 0; sweep < 3; ++sweep) {
    Scan scan = still;
    const Eigen::Vector3f origin = still.T_local_sensor.translation().cast<float>();
    for (Eigen::Vector3f& point : scan.points)
      point =
          origin + (point - origin) * (1.0f + static_cast<float>(random.Between(-0.004, 0.004)) /
                                                  (point - origin).norm());
    images.push_back(ComputeRangeImage(scan, params, Execution()));
    features.push_back(ExtractFeatures(images.back(), params, Execution()));
    ASSERT_GT(features.back().features.size(), 20u);
  }
  for (std::size_t i = 0; i < images.size(); ++i)
    for (std::size_t k = 0; k < features.size(); ++k)
      EXPECT_EQ(AreFeaturesOf(images[i], features[k]), i == k);
}

}  // namespace
}  // namespace rimod
