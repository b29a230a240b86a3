#include "rimod/feature_extraction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/io/random_values.h"
#include "tests/support/executions.h"
#include "tests/support/ray_caster.h"
#include "tests/support/surfel_models.h"

namespace rimod {
namespace {

PipelineParams Params() {
  PipelineParams params;
  params.range_image.resolution = 0.0069;
  params.interest_points.measure = InterestMeasure::kHarris;
  params.interest_points.max_points = 300;
  params.interest_points.min_strength = 1e-6;
  params.interest_points.suppression_radius = 0.05;
  params.range_patch.resolution = 6;
  params.range_patch.support_size = 0.3;
  params.range_patch.min_points = 8;
  params.model_views.azimuths = 4;
  params.model_views.elevations = 2;
  params.model_views.distance = 2.5;
  params.model_views.ground_margin = 0.0;
  params.model_views.validation_points = 50;
  return params;
}

RangeImage Scene() {
  World world;
  world.planes = {{Eigen::Vector3d(4, 0, 0), -Eigen::Vector3d::UnitX()}};
  BoxShape box;
  box.T_local_box = Placed(2.2, -0.3, -0.1, 0.6);
  box.half_size = Eigen::Vector3d(0.25, 0.2, 0.3);
  world.boxes = {box};
  return MakeRangeImage(ScanWorld(world, Eigen::Isometry3d::Identity(), BeamPattern{}),
                        Params().range_image);
}

bool Equal(const std::vector<Feature>& a, const std::vector<Feature>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Feature& x, const Feature& y) {
    return x.position == y.position && x.normal == y.normal && x.descriptor == y.descriptor;
  });
}

TEST(ExtractFeaturesTest, DescribesPointsOfTheImage) {
  const RangeImage image = Scene();
  const FeatureSet set = ExtractFeatures(image, Params(), Execution{});
  EXPECT_EQ(set.descriptor_kind, Params().range_patch.Kind());
  EXPECT_EQ(set.descriptor_size, 36);
  EXPECT_GT(set.features.size(), 20u);
  EXPECT_LE(set.features.size(), 300u);
  for (const Feature& feature : set.features) {
    EXPECT_EQ(feature.descriptor.size(), 36u);
    EXPECT_NEAR(feature.normal.norm(), 1.0f, 1e-4f);
    EXPECT_LE(feature.normal.dot(feature.position), 1e-4f);  // towards the sensor
    const PixelPosition position = Project(image.grid(), feature.position.cast<double>());
    EXPECT_NEAR(image.range(static_cast<int>(position.row), static_cast<int>(position.column)),
                feature.position.norm(), 1e-3f);
  }
}

TEST(ExtractFeaturesTest, ThreadsDoNotMatter) {
  const RangeImage image = Scene();
  const FeatureSet alone = ExtractFeatures(image, Params(), Execution{});
  EXPECT_TRUE(Equal(ExtractFeatures(image, Params(), OnThreads(4)).features, alone.features));
  EXPECT_TRUE(Equal(ExtractFeatures(image, Params(), Backwards()).features, alone.features));
}

TEST(ExtractFeaturesTest, TellsItsStages) {
  std::vector<std::string> stages;
  Execution execution;
  execution.on_stage_begin = [&](const std::string& stage) { stages.push_back(stage); };
  execution.on_stage_end = [&](const std::string& stage) { stages.push_back("/" + stage); };
  ExtractFeatures(Scene(), Params(), execution);
  EXPECT_EQ(stages, (std::vector<std::string>{"interest_points", "/interest_points", "descriptors",
                                              "/descriptors"}));
}

TEST(ExtractFeaturesTest, AnEmptyImageHasNone) {
  const FeatureSet set = ExtractFeatures(RangeImage(), Params(), Execution{});
  EXPECT_TRUE(set.features.empty());
  EXPECT_EQ(set.descriptor_kind, Params().range_patch.Kind());
}

TEST(ExtractFeaturesTest, NeverGivesWhatIsNoNumber) {
  RandomValues random(1);
  for (int i = 0; i < 5; ++i) {
    const RangeImage image = random.AnImage(80, 60);  // every pixel at another range
    for (const Feature& feature : ExtractFeatures(image, Params(), Execution{}).features)
      EXPECT_TRUE(feature.position.allFinite() && feature.normal.allFinite());
  }
}

TEST(ComputeModelViewsTest, FeaturesLieOnTheModelInItsFrame) {
  ObjectModel model = BoxModel("crate", {0.5, 0.4, 0.6}, 0.01);
  ComputeModelViews(Params(), Execution{}, &model);
  EXPECT_NO_THROW(ValidateModel(model));
  EXPECT_EQ(model.descriptor_size, 36);
  ASSERT_EQ(model.views.size(), 8u);
  const Eigen::Vector3d centre(0, 0, 0.3), half(0.25, 0.2, 0.3);
  for (const ModelView& view : model.views) {
    EXPECT_EQ(view.validation_points.size(), 50u);
    EXPECT_FALSE(view.features.empty());
    for (const Feature& feature : view.features) {
      const Eigen::Vector3d p = feature.position.cast<double>();
      EXPECT_NEAR(((p - centre).cwiseAbs() - half).maxCoeff(), 0.0, 0.03);
      EXPECT_GE(feature.normal.cast<double>().dot(view.viewpoint - p), -1e-4);
    }
  }
}

TEST(ComputeModelViewsTest, ThreadsDoNotMatter) {
  ObjectModel alone = BoxModel("crate", {0.5, 0.4, 0.6}, 0.01), other = alone;
  ComputeModelViews(Params(), Execution{}, &alone);
  ComputeModelViews(Params(), OnThreads(4), &other);
  ASSERT_EQ(alone.views.size(), other.views.size());
  for (std::size_t v = 0; v < alone.views.size(); ++v) {
    EXPECT_EQ(alone.views[v].viewpoint, other.views[v].viewpoint);
    EXPECT_EQ(alone.views[v].validation_points, other.views[v].validation_points);
    EXPECT_TRUE(Equal(alone.views[v].features, other.views[v].features));
  }
}

TEST(ModelMatchesParamsTest, OnlyForTheParametersItWasMadeWith) {
  ObjectModel model = BoxModel("crate", {0.5, 0.4, 0.6}, 0.02);
  EXPECT_FALSE(ModelMatchesParams(model, Params()));
  ComputeModelViews(Params(), Execution{}, &model);
  EXPECT_TRUE(ModelMatchesParams(model, Params()));
  PipelineParams params = Params();
  params.range_image.resolution = 0.01;
  EXPECT_FALSE(ModelMatchesParams(model, params));
  params = Params();
  params.range_patch.support_size = 0.31;
  EXPECT_FALSE(ModelMatchesParams(model, params));
  params = Params();
  params.interest_points.max_points = 299;
  EXPECT_FALSE(ModelMatchesParams(model, params));
  params = Params();
  params.model_views.azimuths = 5;
  EXPECT_FALSE(ModelMatchesParams(model, params));
  params = Params();
  params.descriptor = DescriptorType::kSphericalSpin;
  EXPECT_FALSE(ModelMatchesParams(model, params));
  params = Params();  // matters for searching only
  params.matching.max_matches = 7;
  params.scoring.gamma = 0.5;
  EXPECT_TRUE(ModelMatchesParams(model, params));
}

// A model from a foreign file may claim anything.
TEST(ModelMatchesParamsTest, NotForDescriptorsOfAnotherSize) {
  ObjectModel model = BoxModel("crate", {0.5, 0.4, 0.6}, 0.02);
  ComputeModelViews(Params(), Execution{}, &model);
  model.descriptor_size = 3;
  for (ModelView& view : model.views)
    for (Feature& feature : view.features) feature.descriptor.resize(3);
  EXPECT_NO_THROW(ValidateModel(model));
  EXPECT_FALSE(ModelMatchesParams(model, Params()));
}

}  // namespace
}  // namespace rimod
