#include "viewer_tools/case_picture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/ray_caster.h"
#include "tests/support/surfel_models.h"
#include "viewer_tools/model_sheet.h"
#include "viewer_tools/png.h"

namespace rimod {
namespace {

RangeImage Wall(double range) {
  PixelGrid grid;
  grid.width = 100;
  grid.height = 60;
  grid.resolution = 0.01;
  grid.left = 0.5;
  grid.top = 0.3;
  RangeImage image(grid, Eigen::Isometry3d::Identity());
  RoundedPixel pixel;
  pixel.range = static_cast<std::uint16_t>(std::lround(range / PixelRounding::kRangeUnit));
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) image.SetMeasured(row, column, pixel);
  return image;
}

int CountColour(const cv::Mat& picture, const Colour& colour) {
  int count = 0;
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) count += picture.at<Colour>(y, x) == colour;
  return count;
}

TEST(CasePictureTest, DifferencesGoFromBlueOverWhiteToRed) {
  const Colour nearer = DepthDifferenceColour(-1.0);
  const Colour equal = DepthDifferenceColour(0.0);
  const Colour farther = DepthDifferenceColour(1.0);
  EXPECT_GT(nearer[0], nearer[2] + 100);
  EXPECT_GT(farther[2], farther[0] + 100);
  for (int channel = 0; channel < 3; ++channel) EXPECT_GT(equal[channel], 230);
  EXPECT_EQ(DepthDifferenceColour(-0.2), nearer);  // where the colours end
}

TEST(CasePictureTest, SceneBeforeBehindAndAtTheModelDiffer) {
  const ObjectModel ball = SphereModel("ball", 0.3, 0.01);
  const CasePose pose{"label", &ball, Placed(3.0, 0.0, -0.3, 0.0), ObjectColour(1)};
  const Colour hidden = DepthDifferenceColour(-1.0);
  const Colour through = DepthDifferenceColour(1.0);
  // The legend has some of both.
  const cv::Mat before = DrawCase(Wall(2.0), {pose}, "before");
  const cv::Mat behind = DrawCase(Wall(4.0), {pose}, "behind");
  constexpr int kLegend = 200;  // pixels
  constexpr int kArea = 10000;
  EXPECT_GT(CountColour(before, hidden), kArea);
  EXPECT_LT(CountColour(before, through), kLegend);
  EXPECT_GT(CountColour(behind, through), kArea);
  EXPECT_LT(CountColour(behind, hidden), kLegend);
}

TEST(CasePictureTest, PosesOutsideTheImageOrNoneAtAllAreDrawnAllTheSame) {
  const ObjectModel ball = SphereModel("ball", 0.3, 0.02);
  const CasePose behind{"label", &ball, Placed(-3.0, 0.0, 0.0, 0.0), ObjectColour(1)};
  const CasePose around{"label", &ball, Placed(0.0, 0.0, -0.3, 0.0), ObjectColour(1)};
  for (const std::vector<CasePose>& poses :
       {std::vector<CasePose>{}, {behind}, {around}, {behind, around, behind}}) {
    EXPECT_FALSE(DrawCase(Wall(2.0), poses, "title").empty());
    EXPECT_FALSE(DrawCase(RangeImage(), poses, "title").empty());
  }
}

TEST(ModelSheetTest, HasARowOfSidesAndARowForFiveViews) {
  ObjectModel model = BoxModel("crate", {0.4, 0.6, 0.5}, 0.02);
  const cv::Mat sides = DrawModelSheet(model, 0.007);
  for (int i = 0; i < 6; ++i) {
    ModelView view;
    view.viewpoint = Eigen::Vector3d(2.0, 0.3 * i, 0.5);
    view.validation_points = {{0.2f, 0.0f, 0.25f}};
    model.views.push_back(view);
  }
  const cv::Mat sheet = DrawModelSheet(model, 0.007);
  EXPECT_EQ(sheet.cols, sides.cols);
  const int row = (sheet.rows - sides.rows) / 2;
  EXPECT_GT(row, 200);
  EXPECT_EQ(sheet.rows, sides.rows + 2 * row);
  EXPECT_GT(CountColour(sheet, ObjectColour(1)), CountColour(sides, ObjectColour(1)));
}

TEST(ModelSheetTest, ModelWithoutPointsGivesASheet) {
  EXPECT_FALSE(DrawModelSheet(ObjectModel(), 0.007).empty());
}

TEST(PngTest, EncodesPicturesOnly) {
  EXPECT_EQ(EncodePng(cv::Mat()), "");
  EXPECT_EQ(EncodePng(cv::Mat(2, 2, CV_8UC3, cv::Scalar(1, 2, 3))).substr(1, 3), "PNG");
}

}  // namespace
}  // namespace rimod
