#include "rimod/feature_support.h"

#include <gtest/gtest.h>

#include "tests/support/surfel_models.h"

namespace rimod {
namespace {

const Eigen::Isometry3d kPose = [] {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(2.0, 0.5, -0.7);
  pose.rotate(Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitZ()));
  return pose;
}();

class FeatureSupportTest : public testing::Test {
 protected:
  FeatureSupportTest()
      : params_(DefaultParams(Method::kDefault)),
        database_({BoxModel("crate", {0.5, 0.4, 0.6}, 0.03)}, params_, Execution{}) {}

  // The model's feature as the scene shows it at kPose, moved by offset (m, object frame).
  Feature SceneFeature(int model_feature, const Eigen::Vector3d& offset) const {
    const ModelDatabase::PlacedFeature& model = database_.feature(model_feature);
    Feature feature;
    feature.position = (kPose * (model.position.cast<double>() + offset)).cast<float>();
    feature.normal = (kPose.linear() * model.normal.cast<double>()).cast<float>();
    return feature;
  }

  FeatureSupport Count(const FeatureSet& features,
                       const std::vector<Correspondence>& matches) const {
    return FeatureSupportCounter(features, {matches}, database_).Count({0, kPose, 0.0});
  }

  PipelineParams params_;
  ModelDatabase database_;
};

TEST_F(FeatureSupportTest, CountsFeaturesInsideAndThoseThatMatchThere) {
  ASSERT_GE(database_.first_feature(1), 4);
  FeatureSet features;
  features.features = {SceneFeature(0, {0, 0, 0}), SceneFeature(1, {0.01, 0.01, 0.01}),
                       SceneFeature(2, {0, 0, 0}), SceneFeature(3, {1.0, 0, 0})};
  // The third's match is of another place; the fourth lies outside, though its match fits itself.
  int far = 0;
  while ((database_.feature(far).position - database_.feature(2).position).norm() < 0.2f) ++far;
  const FeatureSupport support =
      Count(features, {{0, 2, 0.0}, {0, 0, 0.0}, {1, 1, 0.0}, {2, far, 0.0}, {3, 3, 0.0}});
  EXPECT_EQ(support.inside, 3);
  EXPECT_EQ(support.matching, 2);
}

TEST_F(FeatureSupportTest, FeaturesWithoutMatchesAreInsideOnly) {
  FeatureSet features;
  features.features = {SceneFeature(0, {0, 0, 0}), SceneFeature(1, {0, 0, 0})};
  const FeatureSupport support = Count(features, {{1, 1, 0.0}});
  EXPECT_EQ(support.inside, 2);
  EXPECT_EQ(support.matching, 1);
  EXPECT_EQ(Count(features, {}).matching, 0);
  EXPECT_EQ(Count(FeatureSet{}, {}).inside, 0);
}

TEST_F(FeatureSupportTest, ATurnedNormalDoesNotMatch) {
  FeatureSet features;
  features.features = {SceneFeature(0, {0, 0, 0})};
  features.features[0].normal = -features.features[0].normal;
  const FeatureSupport support = Count(features, {{0, 0, 0.0}});
  EXPECT_EQ(support.inside, 1);
  EXPECT_EQ(support.matching, 0);
}

}  // namespace
}  // namespace rimod
