#include "rimod/model_database.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "rimod/feature_extraction.h"
#include "tests/support/executions.h"
#include "tests/support/matchers.h"
#include "tests/support/surfel_models.h"

namespace rimod {
namespace {

PipelineParams Params() {
  PipelineParams params;
  params.method = Method::kPaper;
  params.range_image.resolution = 0.01;
  params.model_views.azimuths = 4;
  params.model_views.elevations = 1;
  params.model_views.distance = 2.5;
  params.range_patch.resolution = 5;
  return params;
}

std::vector<ObjectModel> ThreeModels() {
  std::vector<ObjectModel> models = {BoxModel("crate", {0.5, 0.4, 0.6}, 0.02),
                                     SphereModel("ball", 0.3, 0.02),
                                     BoxModel("post", {0.15, 0.15, 1.0}, 0.02)};
  for (ObjectModel& model : models) ComputeModelViews(Params(), Execution{}, &model);
  return models;
}

void ExpectSame(const ModelDatabase& a, const ModelDatabase& b) {
  ASSERT_EQ(a.models().size(), b.models().size());
  ASSERT_EQ(a.descriptors().size(), b.descriptors().size());
  EXPECT_EQ(a.descriptor_kind(), b.descriptor_kind());
  for (std::size_t m = 0; m < a.models().size(); ++m) {
    const int model = static_cast<int>(m);
    EXPECT_EQ(a.models()[m].name, b.models()[m].name);
    ASSERT_EQ(a.features(model).size(), b.features(model).size());
    EXPECT_EQ(a.first_feature(model), b.first_feature(model));
    for (std::size_t f = 0; f < a.features(model).size(); ++f)
      EXPECT_EQ(a.features(model)[f]->descriptor, b.features(model)[f]->descriptor);
  }
}

TEST(ModelDatabaseTest, IsSortedByNameWhateverTheOrder) {
  std::vector<ObjectModel> models = ThreeModels();
  const ModelDatabase database(models, Params(), Execution{});
  ASSERT_EQ(database.models().size(), 3u);
  EXPECT_EQ(database.models()[0].name, "ball");
  EXPECT_EQ(database.models()[1].name, "crate");
  EXPECT_EQ(database.models()[2].name, "post");
  std::mt19937 generator(1);
  for (int i = 0; i < 3; ++i) {
    std::shuffle(models.begin(), models.end(), generator);
    ExpectSame(ModelDatabase(models, Params(), OnThreads(3)), database);
  }
}

TEST(ModelDatabaseTest, EveryDescriptorLeadsBackToItsFeature) {
  const ModelDatabase database(ThreeModels(), Params(), Execution{});
  int total = 0;
  for (int m = 0; m < 3; ++m) total += static_cast<int>(database.features(m).size());
  ASSERT_EQ(database.descriptors().size(), total);
  ASSERT_GT(total, 30);
  for (int i = 0; i < total; ++i) {
    const ModelDatabase::PlacedFeature& placed = database.feature(i);
    const Feature& feature =
        *database.features(placed.model)[i - database.first_feature(placed.model)];
    EXPECT_EQ(placed.position, feature.position);
    EXPECT_EQ(placed.normal, feature.normal);
    // The index holds this descriptor under this number.
    const std::vector<DescriptorMatch> same =
        database.descriptors().FindNear(feature.descriptor, total, 1e-6, total);
    EXPECT_TRUE(std::any_of(same.begin(), same.end(),
                            [i](const DescriptorMatch& match) { return match.index == i; }));
  }
}

TEST(ModelDatabaseTest, FeaturesAreThoseOfTheViewsInOrder) {
  const ModelDatabase database(ThreeModels(), Params(), Execution{});
  for (int m = 0; m < 3; ++m) {
    std::size_t i = 0;
    for (const ModelView& view : database.models()[m].views) {
      for (const Feature& feature : view.features) {
        ASSERT_LT(i, database.features(m).size());
        EXPECT_EQ(database.features(m)[i++], &feature);
        const int view_number = static_cast<int>(&view - database.models()[m].views.data());
        EXPECT_EQ(database.feature(database.first_feature(m) + static_cast<int>(i) - 1).view,
                  view_number);
      }
    }
    EXPECT_EQ(i, database.features(m).size());
  }
}

TEST(ModelDatabaseTest, ViewsOfOtherParametersAreComputedAnew) {
  PipelineParams params = Params();
  params.range_patch.resolution = 7;
  const ModelDatabase given(ThreeModels(), params, Execution{});
  std::vector<ObjectModel> bare = ThreeModels();
  for (ObjectModel& model : bare) {
    model.views.clear();
    model.descriptor_kind.clear();
  }
  const ModelDatabase expected(bare, params, OnThreads(2));
  ExpectSame(given, expected);
  for (const ObjectModel& model : given.models()) EXPECT_EQ(model.descriptor_size, 49);
}

TEST(ModelDatabaseTest, HasAShapeForEachModelsCollisions) {
  const ModelDatabase database(ThreeModels(), Params(), Execution{});
  ASSERT_EQ(database.collision_shapes().size(), 3u);
  EXPECT_TRUE(database.collision_shapes()[0].centre().isApprox(Eigen::Vector3d(0, 0, 0.3)));
  EXPECT_TRUE(database.collision_shapes()[2].centre().isApprox(Eigen::Vector3d(0, 0, 0.5)));
}

TEST(ModelDatabaseTest, MayBeEmpty) {
  const ModelDatabase database({}, Params(), Execution{});
  EXPECT_TRUE(database.models().empty());
  EXPECT_EQ(database.descriptors().size(), 0);
  PipelineParams params = Params();
  params.method = Method::kDefault;
  EXPECT_EQ(ModelDatabase({}, params, Execution{}).first_feature(0), 0);
}

TEST(ModelDatabaseTest, HasWhatTheDefaultMethodWants) {
  PipelineParams params = Params();
  params.method = Method::kDefault;
  params.matching.projected_dimensions = 7;
  std::vector<ObjectModel> models = ThreeModels();
  const ModelDatabase one(models, params, Execution{});
  std::reverse(models.begin(), models.end());
  const ModelDatabase two(models, params, OnThreads(2));
  EXPECT_EQ(one.method(), Method::kDefault);
  std::sort(models.begin(), models.end(),
            [](const ObjectModel& a, const ObjectModel& b) { return a.name < b.name; });
  const int total = one.first_feature(3);
  for (int m = 0; m < 3; ++m) {
    ASSERT_EQ(one.ranking_models()[m].views.size(), models[m].views.size());
    EXPECT_EQ(&one.judged_models()[m].model(), &one.models()[m]);
    for (std::size_t v = 0; v < models[m].views.size(); ++v) {
      EXPECT_EQ(one.ranking_models()[m].views[v].surface.points,
                models[m].views[v].validation_points);
      EXPECT_EQ(one.models()[m].views[v].viewpoint, models[m].views[v].viewpoint);
    }
  }
  for (int m = 0; m < 3; ++m) {
    const int count = one.first_feature(m + 1) - one.first_feature(m);
    ASSERT_EQ(one.projected_descriptors(m).size(), count);
    ASSERT_EQ(two.projected_descriptors(m).size(), count);
  }
  std::vector<const Feature*> features;
  for (const ObjectModel& model : models)
    for (const ModelView& view : model.views)
      for (const Feature& feature : view.features) features.push_back(&feature);
  ASSERT_EQ(static_cast<int>(features.size()), total);
  for (int i = 0; i < total; ++i) {
    const Feature& feature = *features[i];
    EXPECT_EQ(one.feature(i).position, feature.position);
    EXPECT_EQ(one.feature(i).normal, feature.normal);
    const Descriptor projected = one.projection().Project(feature.descriptor);
    EXPECT_EQ(projected.size(), 7u);
    EXPECT_EQ(projected, two.projection().Project(feature.descriptor));
    const int model = one.feature(i).model, first = one.first_feature(model);
    const std::vector<DescriptorMatch> same =
        one.projected_descriptors(model).FindNear(projected, total, 1e-6, total);
    EXPECT_TRUE(std::any_of(same.begin(), same.end(), [&](const DescriptorMatch& match) {
      return first + match.index == i;
    }));
  }
}

TEST(ModelDatabaseTest, TheDefaultMethodKeepsNoLongDescriptors) {
  PipelineParams params = Params();
  params.method = Method::kDefault;
  const ModelDatabase database(ThreeModels(), params, Execution{});
  for (const ObjectModel& model : database.models())
    for (const ModelView& view : model.views)
      EXPECT_TRUE(view.features.empty() && view.validation_points.empty() &&
                  view.outside_points.empty());
}

TEST(ModelDatabaseTest, RefusesTwoModelsOfOneName) {
  std::vector<ObjectModel> models = ThreeModels();
  models[2].name = "ball";
  EXPECT_TRUE(Complains([&] { ModelDatabase(models, Params(), Execution{}); }, {"ball"}));
}

TEST(ModelDatabaseTest, RefusesInvalidModels) {
  std::vector<ObjectModel> models = ThreeModels();
  models[1].points[0].x() = std::nanf("");
  EXPECT_THROW(ModelDatabase(models, Params(), Execution{}), std::invalid_argument);
}

TEST(ModelDatabaseTest, ForeignDescriptorSizesAreNotTrusted) {
  std::vector<ObjectModel> models = ThreeModels();
  models[0].descriptor_size = 1;  // claims the right kind
  for (ModelView& view : models[0].views)
    for (Feature& feature : view.features) feature.descriptor.resize(1);
  ExpectSame(ModelDatabase(models, Params(), Execution{}),
             ModelDatabase(ThreeModels(), Params(), Execution{}));
}

TEST(ModelDatabaseTest, AModelWithoutFeaturesIsHarmless) {
  std::vector<ObjectModel> models = ThreeModels();
  PipelineParams params = Params();
  params.interest_points.min_strength = 1e8;
  const ModelDatabase database(models, params, Execution{});
  EXPECT_EQ(database.models().size(), 3u);
  EXPECT_EQ(database.descriptors().size(), 0);
}

}  // namespace
}  // namespace rimod
