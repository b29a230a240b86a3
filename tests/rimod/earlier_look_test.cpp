#include "rimod/earlier_look.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/ray_caster.h"
#include "tests/support/surfel_models.h"

namespace rimod {
namespace {

PipelineParams Params() {
  PipelineParams params = DefaultParams(Method::kDefault);
  params.model_views.azimuths = 4;
  params.model_views.elevations = 1;
  return params;
}

// Two models, 0.4 m across and high.
const ModelDatabase& Database() {
  static const ModelDatabase database(
      {BoxModel("a", {0.4, 0.4, 0.4}, 0.05), BoxModel("b", {0.4, 0.4, 0.4}, 0.05)}, Params(),
      Execution{});
  return database;
}

// All around, 0.02 rad a pixel; nothing but a pixel is seen, straight ahead.
class EarlierLookTest : public testing::Test {
 protected:
  EarlierLookTest()
      : before_(Image(false)),
        now_(Image(true)),
        change_(before_, now_),
        look_{Scene(before_, 0.1, Execution{}), {}, {}} {}

  static RangeImage Image(bool seen) {
    PixelGrid grid;
    grid.resolution = 0.02;
    grid.left = 157 * grid.resolution;
    grid.top = 50 * grid.resolution;
    grid.width = 314;
    grid.height = 100;
    RangeImage image(grid, Eigen::Isometry3d::Identity());
    if (seen) image.SetNoReturn(50, 157);
    return image;
  }

  // A hypothesis without news stands to the left, one with news ahead.
  static Hypothesis At(double heading, double score, int model = 0) {
    Hypothesis hypothesis;
    hypothesis.model = model;
    hypothesis.score = score;
    hypothesis.T_sensor_object =
        Placed(3.0 * std::cos(heading), 3.0 * std::sin(heading), -0.2, 0.0).cast<float>();
    return hypothesis;
  }
  void Add(const Hypothesis& proposed, const Hypothesis& ranked, const Hypothesis& judged) {
    ExplainingCandidate candidate;
    candidate.candidate = {judged.model, judged.T_sensor_object.cast<double>(), judged.score};
    candidate.explained = {{7, 3}};
    look_.histories.push_back({proposed, ranked, candidate});
  }

  static std::vector<double> Scores(const std::vector<Hypothesis>& hypotheses) {
    std::vector<double> scores;
    for (const Hypothesis& hypothesis : hypotheses) scores.push_back(hypothesis.score);
    return scores;
  }

  const RangeImage before_, now_;
  const ImageChange change_;
  EarlierLook look_;
};

constexpr double kAhead = 0.0, kLeft = 1.0, kRight = -1.0;  // headings, rad
using Doubles = std::vector<double>;

TEST_F(EarlierLookTest, NewsAreWhatTheModelMayCover) {
  const ObjectModel& model = Database().models()[0];
  EXPECT_TRUE(HasNews(change_, model, At(kAhead, 1.0).T_sensor_object));
  EXPECT_TRUE(HasNews(change_, model, At(0.1, 1.0).T_sensor_object));
  EXPECT_FALSE(HasNews(change_, model, At(kLeft, 1.0).T_sensor_object));
  EXPECT_FALSE(HasNews(change_, model, At(M_PI, 1.0).T_sensor_object) &&
               HasNews(change_, model, At(2.0, 1.0).T_sensor_object));
  EXPECT_TRUE(HasNews(ImageChange(), model, At(kLeft, 1.0).T_sensor_object));
}

TEST_F(EarlierLookTest, SettledHypothesesTakeTheirPartOfTheQuotas) {
  Add(At(kLeft, 0.8), At(kLeft, 0.7), At(kLeft, 0.6));
  Add(At(kRight, 0.3), At(kRight, 0.2), At(kRight, 0.1));
  SettledHypotheses settled(&look_, change_, Database());
  const ModelQuota quota{1, 3, 0.25};
  std::vector<Hypothesis> proposed = settled.Propose(
      {At(kAhead, 0.9), At(kAhead, 0.5), At(kAhead, 0.4), At(kAhead, 0.9, 1)}, quota);
  EXPECT_EQ(Scores(proposed), (Doubles{0.9, 0.5, 0.9})) << "0.8 is settled, 0.4 one too many";
  for (Hypothesis& hypothesis : proposed) hypothesis.score *= 0.5;
  const std::vector<Hypothesis> ranked = settled.Rank(proposed, {1, 2, 0.0});
  EXPECT_EQ(Scores(ranked), (Doubles{0.45, 0.45})) << "0.7 is settled, 0.25 one too many";

  JudgedScan found;
  std::vector<int> origins;
  for (const Hypothesis& hypothesis : ranked) {
    found.candidates.push_back({{hypothesis.model, Eigen::Isometry3d::Identity(), 0.55}, 0.45, {}});
    origins.push_back(hypothesis.origin);
  }
  settled.Judge(origins, &found);
  ASSERT_EQ(found.candidates.size(), 3u);
  EXPECT_EQ(found.candidates[0].candidate.score, 0.6) << "settled, and the best";
  EXPECT_EQ(found.candidates[0].explained[0].first, 7);
  const std::vector<HypothesisHistory> histories = settled.TakeHistories();
  ASSERT_EQ(histories.size(), 4u);
  for (const HypothesisHistory& history : histories)
    EXPECT_EQ(history.ranked.has_value(), history.judged.has_value());
}

// Wherever on its way a hypothesis met what is new, all that came of it is given up.
TEST_F(EarlierLookTest, NewsAtAnyPoseOfItsWayUnsettleAHypothesis) {
  Add(At(kAhead, 0.8), At(kLeft, 0.7), At(kLeft, 0.6));
  Add(At(kLeft, 0.8), At(kAhead, 0.7), At(kLeft, 0.6));
  Add(At(kLeft, 0.8), At(kLeft, 0.7), At(kAhead, 0.6));
  Add(At(NAN, 0.8), At(kLeft, 0.7), At(kLeft, 0.6));
  SettledHypotheses settled(&look_, change_, Database());
  EXPECT_TRUE(settled.Propose({}, {9, 9, 0.0}).empty());
  EXPECT_TRUE(settled.Rank({}, {9, 9, 0.0}).empty());
  JudgedScan found;
  settled.Judge({}, &found);
  EXPECT_TRUE(found.candidates.empty());
  EXPECT_TRUE(settled.TakeHistories().empty());
}

TEST_F(EarlierLookTest, WhatTheQuotaNoLongerLetsThroughIsGivenUp) {
  Add(At(kLeft, 0.3), At(kLeft, 0.7), At(kLeft, 0.6));
  SettledHypotheses settled(&look_, change_, Database());
  const std::vector<Hypothesis> proposed = settled.Propose({At(kAhead, 0.9)}, {1, 1, 0.0});
  EXPECT_EQ(proposed.size(), 1u);
  EXPECT_EQ(settled.Rank(proposed, {9, 9, 0.0}).size(), 1u);
  JudgedScan found;
  found.candidates.resize(1);
  settled.Judge({proposed[0].origin}, &found);
  EXPECT_EQ(found.candidates.size(), 1u);
}

TEST_F(EarlierLookTest, WithoutAnEarlierLookAllIsFresh) {
  Add(At(kLeft, 0.8), At(kLeft, 0.7), At(kLeft, 0.6));
  const ImageChange everything;
  for (const EarlierLook* const before :
       {static_cast<const EarlierLook*>(nullptr), static_cast<const EarlierLook*>(&look_)}) {
    SettledHypotheses settled(before, everything, Database());
    EXPECT_EQ(settled.Propose({At(kAhead, 0.9), At(kLeft, 0.5)}, {9, 9, 0.0}).size(), 2u);
  }
}

TEST(FindKnownTest, FeaturesAreKnownWhenAllOfThemIsTheSame) {
  FeatureSet known;
  for (int i = 0; i < 3; ++i) {
    Feature feature;
    feature.position = {static_cast<float>(i), 0.0f, 0.0f};
    feature.normal = {0.0f, 0.0f, 1.0f};
    feature.descriptor = {1, 2, 3};
    known.features.push_back(feature);
  }
  FeatureSet features;
  features.features = {known.features[2], known.features[1], known.features[0], known.features[0]};
  features.features[1].descriptor[2] = 4;
  features.features[2].normal.x() = 0.5f;
  EXPECT_EQ(FindKnown(features, known), (std::vector<int>{2, -1, -1, 0}));
  EXPECT_EQ(FindKnown(FeatureSet{}, known), std::vector<int>());
  EXPECT_EQ(FindKnown(features, FeatureSet{}), std::vector<int>(4, -1));
}

}  // namespace
}  // namespace rimod
