#include "tuning/varied_parameters.h"

#include <gtest/gtest.h>

#include "io/config.h"

namespace rimod {
namespace {

Configuration Default() { return DefaultConfiguration(Method::kDefault); }

Configuration SpinImages() {
  Configuration configuration = DefaultConfiguration(Method::kPaper);
  configuration.pipeline.descriptor = DescriptorType::kSphericalSpin;
  return configuration;
}

std::string ErrorOf(const std::string& text) { return DimensionFrom(text, Default()).error; }

TEST(VariedParametersTest, TheShortListsAreRangesAroundTheDefaults) {
  for (const Configuration& configuration :
       {Default(), DefaultConfiguration(Method::kPaper), SpinImages()}) {
    for (const std::string& text : DefaultVaryTexts(configuration.pipeline)) {
      const DimensionResult made = DimensionFrom(text, configuration);
      ASSERT_TRUE(made.dimension) << made.error;
      const double value = std::stod(SettingOf({*made.dimension}, configuration)[0]);
      EXPECT_GT(value, made.dimension->low) << text;
      EXPECT_LT(value, made.dimension->high) << text;
    }
  }
}

TEST(VariedParametersTest, EveryParameterOfTheListMayBeVaried) {
  for (const TunableParameter& parameter : TunableParameters(Default())) {
    const std::string error = ErrorOf(parameter.name);
    EXPECT_TRUE(error.empty() || error.find("needs a range") != std::string::npos) << error;
  }
}

TEST(VariedParametersTest, OnlyTheDescriptorInUseMayBeVaried) {
  const Configuration patches = DefaultConfiguration(Method::kPaper);
  const std::string patch = "range_patch.support_size", spin = "spherical_spin.support_size";
  EXPECT_TRUE(DimensionFrom(patch, patches).dimension);
  EXPECT_TRUE(DimensionFrom(spin, SpinImages()).dimension);
  EXPECT_NE(DimensionFrom(spin, patches).error.find("with range_patch does not use it"),
            std::string::npos);
  EXPECT_NE(DimensionFrom(patch, SpinImages()).error.find("with spherical_spin does not use it"),
            std::string::npos);
  const std::vector<Dimension> dimensions = {*DimensionFrom(spin, SpinImages()).dimension};
  EXPECT_EQ(CostOfChange(dimensions, {"0.3"}, {"0.4"}), ParameterCost::kViews);
}

TEST(VariedParametersTest, ANameAloneTakesHalfToTwiceOrAllNames) {
  const DimensionResult number = DimensionFrom("matching.max_descriptor_distance", Default());
  ASSERT_TRUE(number.dimension) << number.error;
  EXPECT_DOUBLE_EQ(number.dimension->low, 0.035);
  EXPECT_DOUBLE_EQ(number.dimension->high, 0.14);
  const DimensionResult names = DimensionFrom("interest_points.measure", Default());
  ASSERT_TRUE(names.dimension) << names.error;
  EXPECT_EQ(names.dimension->values, (std::vector<std::string>{"harris", "surface_change"}));
}

TEST(VariedParametersTest, MistakesAreNamed) {
  EXPECT_NE(ErrorOf("matching.distance=1..2").find("'matching.distance' is no parameter"),
            std::string::npos);
  EXPECT_NE(ErrorOf("goodsac.max_trials=1..2").find("does not use it"), std::string::npos);
  EXPECT_NE(ErrorOf("bus.scan_ahead").find("does not use it"), std::string::npos);
  EXPECT_NE(ErrorOf("method=paper,default"), "");
  EXPECT_NE(ErrorOf("matching.max_matches=9..3").find("range is empty"), std::string::npos);
  EXPECT_NE(ErrorOf("matching.max_matches=3..3").find("range is empty"), std::string::npos);
  EXPECT_NE(ErrorOf("matching.max_matches=1.5..3").find("whole numbers"), std::string::npos);
  EXPECT_NE(ErrorOf("matching.max_matches=a..b").find("two numbers"), std::string::npos);
  EXPECT_NE(ErrorOf("matching.max_matches=nan..inf").find("two numbers"), std::string::npos);
  EXPECT_NE(ErrorOf("matching.max_matches=5,x").find("'x' is not a whole number"),
            std::string::npos);
  EXPECT_NE(ErrorOf("range_patch.resolution=100..200").find("resolution is"), std::string::npos);
  EXPECT_NE(ErrorOf("interest_points.measure=1..2").find("takes a list"), std::string::npos);
  EXPECT_NE(ErrorOf("interest_points.measure=harris").find("two values"), std::string::npos);
}

TEST(VariedParametersTest, SettingsAreAppliedAndCombinationsChecked) {
  const std::vector<Dimension> dimensions = {
      *DimensionFrom("ranking.refined_always=10..100", Default()).dimension,
      *DimensionFrom("ranking.refined_most=10..200", Default()).dimension};
  const AppliedSetting good = ApplySetting(dimensions, {"20", "30"}, Default());
  ASSERT_TRUE(good.configuration) << good.error;
  EXPECT_EQ(good.configuration->pipeline.ranking.refined.always, 20);
  EXPECT_EQ(good.configuration->pipeline.ranking.refined.most, 30);
  const AppliedSetting bad = ApplySetting(dimensions, {"50", "30"}, Default());
  EXPECT_FALSE(bad.configuration);
  EXPECT_NE(bad.error, "");
}

TEST(VariedParametersTest, TheCostIsThatOfTheChange) {
  const std::vector<Dimension> dimensions = {
      *DimensionFrom("matching.max_matches", Default()).dimension,
      *DimensionFrom("range_patch.support_size", Default()).dimension,
      *DimensionFrom("model_surface.point_spacing", Default()).dimension};
  EXPECT_EQ(CostOfChange(dimensions, {"1", "1", "1"}, {"2", "1", "1"}), ParameterCost::kSearch);
  EXPECT_EQ(CostOfChange(dimensions, {"1", "1", "1"}, {"2", "2", "1"}), ParameterCost::kViews);
  EXPECT_EQ(CostOfChange(dimensions, {"1", "1", "1"}, {"1", "2", "2"}), ParameterCost::kSurface);
}

TEST(VariedParametersTest, TheShortFileGivesTheConfigurationAgain) {
  for (const Method method : {Method::kDefault, Method::kPaper}) {
    Configuration configuration = DefaultConfiguration(method);
    configuration.pipeline.matching.max_descriptor_distance = 0.0815;
    configuration.pipeline.range_image.resolution *= 1.25;
    configuration.bus.max_waiting_scans = 7;
    const std::string text = ShortConfigurationText(configuration, {"a head", ""});
    const ConfigurationResult read = ParseConfiguration(text, "short");
    ASSERT_TRUE(read.configuration) << read.error << text;
    EXPECT_EQ(DumpConfiguration(*read.configuration), DumpConfiguration(configuration));
    EXPECT_LT(text.size(), 400u);
  }
}

}  // namespace
}  // namespace rimod
