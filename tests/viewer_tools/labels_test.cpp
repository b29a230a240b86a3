#include "viewer_tools/labels.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <random>

#include "viewer_tools/palette.h"

namespace rimod {
namespace {

TEST(LabelPlacerTest, LabelsStayInsideAndNeverOverlap) {
  std::mt19937 generator(2);
  for (int round = 0; round < 50; ++round) {
    const cv::Rect area(10, 20, 600, 400);
    LabelPlacer placer(area);
    std::uniform_int_distribution<int> x(-100, 700);
    std::uniform_int_distribution<int> y(-100, 500);
    std::uniform_int_distribution<int> side(1, 200);
    std::vector<cv::Rect> targets;
    for (int i = 0; i < 25; ++i)
      targets.emplace_back(x(generator), y(generator), side(generator), side(generator));
    for (const cv::Rect& target : targets) placer.AddObstacle(target);
    std::vector<cv::Rect> places;
    for (const cv::Rect& target : targets) {
      const std::optional<cv::Rect> place = placer.Place(target, cv::Size(110, 24));
      if (!place) continue;
      EXPECT_EQ(*place & area, *place);
      for (const cv::Rect& other : places) EXPECT_EQ((other & *place).area(), 0);
      places.push_back(*place);
    }
    EXPECT_GE(places.size(), 20u);
  }
}

TEST(LabelPlacerTest, ALoneLabelTouchesItsTarget) {
  LabelPlacer placer(cv::Rect(0, 0, 500, 500));
  const cv::Rect target(200, 200, 50, 50);
  placer.AddObstacle(target);
  const std::optional<cv::Rect> place = placer.Place(target, cv::Size(80, 20));
  ASSERT_TRUE(place);
  EXPECT_EQ((*place & target).area(), 0);
  const cv::Rect grown(target.x - 5, target.y - 5, target.width + 10, target.height + 10);
  EXPECT_GT((*place & grown).area(), 0);
}

TEST(LabelPlacerTest, NoRoomIsToldInsteadOfCuttingTheLabel) {
  LabelPlacer placer(cv::Rect(0, 0, 50, 50));
  EXPECT_FALSE(placer.Place(cv::Rect(10, 10, 5, 5), cv::Size(60, 20)));
  EXPECT_TRUE(placer.Place(cv::Rect(10, 10, 5, 5), cv::Size(40, 20)));
}

TEST(LabelTest, TextStaysWithinItsSize) {
  for (const char* text : {"office_chair 0.87", "gjpqy", "_", "WWWW"}) {
    const cv::Size size = TextSize(text);
    cv::Mat canvas(size.height + 40, size.width + 40, CV_8UC3, cv::Scalar(0, 0, 0));
    DrawText(&canvas, text, {20, 20}, cv::Scalar(255, 255, 255));
    cv::Mat inside = canvas(cv::Rect(cv::Point(20, 20), size));
    EXPECT_GT(cv::norm(inside), 0.0) << text;
    inside.setTo(cv::Scalar(0, 0, 0));
    EXPECT_EQ(cv::norm(canvas), 0.0) << text;
  }
}

TEST(PaletteTest, ObjectColoursDifferFromEachOtherAndFromTheBackgrounds) {
  const auto distance = [](const Colour& a, const Colour& b) {
    return cv::norm(cv::Vec3d(a[0], a[1], a[2]) - cv::Vec3d(b[0], b[1], b[2]));
  };
  for (int i = 0; i < kNumObjectColours; ++i) {
    for (int j = 0; j < i; ++j) EXPECT_GT(distance(ObjectColour(i), ObjectColour(j)), 80.0);
    for (double share = 0.0; share <= 1.0; share += 0.05) {
      EXPECT_GT(distance(ObjectColour(i), RangeColour(share)), 80.0) << i << " " << share;
      EXPECT_GT(distance(ObjectColour(i), HeightColour(share)), 50.0) << i << " " << share;
    }
    EXPECT_GT(distance(ObjectColour(i), NoReturnColour()), 80.0);
  }
  EXPECT_GT(distance(NoReturnColour(), NeverObservedColour(0, 0)), 30.0);
  EXPECT_GT(distance(NoReturnColour(), RangeColour(1.0)), 30.0);
}

TEST(PaletteTest, AClassHasOneColourWhereverItStandsInTheList) {
  const std::vector<Colour> colours = ColoursByName({"fan", "chair", "fan"});
  EXPECT_EQ(colours[0], colours[2]);
  EXPECT_NE(colours[0], colours[1]);
  EXPECT_EQ(colours[0], ColoursByName({"chair", "fan"})[1]);
}

}  // namespace
}  // namespace rimod
