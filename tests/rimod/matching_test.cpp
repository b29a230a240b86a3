#include "rimod/matching.h"

#include <gtest/gtest.h>

#include "tests/io/random_values.h"
#include "tests/support/executions.h"
#include "tests/support/matchers.h"

namespace rimod {
namespace {

MatchingParams Params(double max_distance, int max_matches, int max_checks) {
  MatchingParams params;
  params.max_descriptor_distance = max_distance;
  params.max_matches = max_matches;
  params.max_checks = max_checks;
  params.min_shared_cells = 0;
  params.min_roughness = 0.0;
  return params;
}

std::vector<Feature> RandomFeatures(int count, unsigned seed) {
  RandomValues random(seed);
  std::vector<Feature> features(count);
  for (Feature& feature : features)
    for (int i = 0; i < 6; ++i)
      feature.descriptor.push_back(static_cast<std::int16_t>(random.Int(-300, 300)));
  return features;
}

DescriptorIndex IndexOf(const std::vector<Feature>& features) {
  std::vector<const Descriptor*> descriptors;
  for (const Feature& feature : features) descriptors.push_back(&feature.descriptor);
  return DescriptorIndex(descriptors);
}

bool Equal(const std::vector<Correspondence>& a, const std::vector<Correspondence>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Correspondence& x, const Correspondence& y) {
                      return x.scene_feature == y.scene_feature &&
                             x.model_feature == y.model_feature && x.distance == y.distance;
                    });
}

TEST(MatchingTest, FindsAllPairsWithinTheMaximumDistance) {
  const std::vector<Feature> scene = RandomFeatures(80, 1), model = RandomFeatures(300, 2);
  const double max_distance = 0.02;
  const std::vector<Correspondence> found =
      MatchFeatures(scene, IndexOf(model), Params(max_distance, 300, 300), Execution{});
  std::size_t expected = 0;
  for (const Feature& s : scene)
    for (const Feature& m : model)
      expected += DescriptorDistance(s.descriptor, m.descriptor, 1) <= max_distance;
  EXPECT_EQ(found.size(), expected);
  ASSERT_GT(expected, 10u);
  for (const Correspondence& c : found) {
    EXPECT_NEAR(
        c.distance,
        DescriptorDistance(scene[c.scene_feature].descriptor, model[c.model_feature].descriptor, 1),
        1e-7);
  }
}

TEST(MatchingTest, KeepsTheNearestOfEachSceneFeatureInOrder) {
  const std::vector<Feature> scene = RandomFeatures(40, 3), model = RandomFeatures(100, 4);
  const std::vector<Correspondence> found =
      MatchFeatures(scene, IndexOf(model), Params(10.0, 3, 100), Execution{});
  ASSERT_EQ(found.size(), 120u);
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].scene_feature, static_cast<int>(i / 3));
    if (i % 3 == 0) continue;
    EXPECT_LE(found[i - 1].distance, found[i].distance);
  }
}

TEST(MatchingTest, ThreadsDoNotMatter) {
  const std::vector<Feature> scene = RandomFeatures(200, 5), model = RandomFeatures(500, 6);
  const DescriptorIndex index = IndexOf(model);
  const MatchingParams params = Params(0.03, 10, 60);
  const std::vector<Correspondence> alone = MatchFeatures(scene, index, params, Execution{});
  EXPECT_FALSE(alone.empty());
  EXPECT_TRUE(Equal(MatchFeatures(scene, index, params, OnThreads(4)), alone));
  EXPECT_TRUE(Equal(MatchFeatures(scene, index, params, Backwards()), alone));
}

TEST(MatchingTest, RoughPatchesComeBeforeFlatOnesWhenTold) {
  // Both are 1 mm from their model's; the first is flat, the second has 3 cm steps.
  std::vector<Feature> scene(2), model(2);
  scene[0].descriptor = {0, 0, 0, 0, 0, 0};
  model[0].descriptor = {10, -10, 10, -10, 10, -10};
  scene[1].descriptor = {300, -300, 300, -300, 300, -300};
  model[1].descriptor = {310, -310, 310, -310, 310, -310};
  MatchingParams params = Params(0.005, 1, 10);
  std::vector<Correspondence> found = MatchFeatures(scene, IndexOf(model), params, Execution{});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR(found[0].distance, found[1].distance, 1e-7);
  params.min_roughness = 0.01;
  found = MatchFeatures(scene, IndexOf(model), params, Execution{});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR(found[0].distance, 0.001 / 0.01, 1e-5);  // at least the roughness given
  EXPECT_NEAR(found[1].distance, 0.001 / 0.03, 1e-5);
}

TEST(MatchingTest, EmptyCellsDoNotCountWhenCellsMustBeShared) {
  std::vector<Feature> scene(1), model(1);
  scene[0].descriptor = {100, -100, kEmptyCell, 200};
  model[0].descriptor = {100, -100, 900, kEmptyCell};
  MatchingParams params = Params(0.001, 5, 10);
  EXPECT_TRUE(MatchFeatures(scene, IndexOf(model), params, Execution{}).empty());
  params.max_descriptor_distance = 1.0;
  params.min_shared_cells = 2;
  const std::vector<Correspondence> found =
      MatchFeatures(scene, IndexOf(model), params, Execution{});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].distance, 0.0, 1e-9);
  params.min_shared_cells = 3;
  EXPECT_TRUE(MatchFeatures(scene, IndexOf(model), params, Execution{}).empty());
}

TEST(MatchingTest, NothingMatchesNothing) {
  const std::vector<Feature> features = RandomFeatures(5, 7);
  const MatchingParams params = Params(1.0, 5, 5);
  EXPECT_TRUE(MatchFeatures({}, IndexOf(features), params, Execution{}).empty());
  EXPECT_TRUE(MatchFeatures(features, IndexOf({}), params, Execution{}).empty());
}

TEST(MatchingTest, RejectsParametersOutOfRange) {
  const DescriptorIndex index({});
  EXPECT_TRUE(Complains([&] { MatchFeatures({}, index, Params(0.0, 5, 5), Execution{}); },
                        {"max_descriptor_distance"}));
}

}  // namespace
}  // namespace rimod
