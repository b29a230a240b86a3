#include "viewer_tools/pictures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace rimod {
namespace {

constexpr double kResolution = 0.01;  // rad

// A wall of pixels at 3 m, 100 columns wide and 60 rows high, straight ahead; the sensor stands 1 m
// high.
RangeImage MakeWall() {
  PixelGrid grid;
  grid.width = 100;
  grid.height = 60;
  grid.resolution = kResolution;
  grid.left = 0.5;
  grid.top = 0.3;
  Eigen::Isometry3d T_local_sensor = Eigen::Isometry3d::Identity();
  T_local_sensor.translation().z() = 1.0;
  RangeImage image(grid, T_local_sensor);
  RoundedPixel pixel;
  pixel.range = static_cast<std::uint16_t>(std::lround(3.0 / PixelRounding::kRangeUnit));
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) image.SetMeasured(row, column, pixel);
  return image;
}

// A plate, 0.4 m wide and high, facing -x, its lower edge's middle at the origin.
ObjectModel MakePlate() {
  ObjectModel model;
  model.name = "plate";
  model.box_min = Eigen::Vector3d(-0.05, -0.2, 0.0);
  model.box_max = Eigen::Vector3d(0.05, 0.2, 0.4);
  model.point_spacing = 0.01;
  for (double y = -0.2; y <= 0.2; y += 0.01) {
    for (double z = 0.0; z <= 0.4; z += 0.01) {
      model.points.push_back(Eigen::Vector3d(0.0, y, z).cast<float>());
      model.normals.push_back(-Eigen::Vector3f::UnitX());
    }
  }
  return model;
}

Detection PlateAt(double x, double y, double z) {
  Detection detection;
  detection.class_name = "plate";
  detection.T_local_object.translation() = Eigen::Vector3d(x, y, z);
  detection.box_min = MakePlate().box_min;
  detection.box_max = MakePlate().box_max;
  detection.score = 0.5;
  return detection;
}

Colour At(const cv::Mat& canvas, const cv::Point2d& position) {
  return canvas.at<Colour>(cv::Point(static_cast<int>(position.x), static_cast<int>(position.y)));
}

double Distance(const Colour& a, const Colour& b) {
  return cv::norm(cv::Vec3d(a[0], a[1], a[2]) - cv::Vec3d(b[0], b[1], b[2]));
}

TEST(RangeImagePictureTest, MeasuredNoReturnAndNeverObservedLookDifferent) {
  PixelGrid grid;
  grid.width = 3;
  grid.height = 1;
  grid.resolution = kResolution;
  RangeImage image(grid, Eigen::Isometry3d::Identity());
  RoundedPixel pixel;
  pixel.range = 1600;
  image.SetMeasured(0, 0, pixel);
  image.SetNoReturn(0, 1);
  const cv::Mat canvas = DrawRangeImage(image, {}, "");
  const RangeImageLayout layout = LayOutRangeImage(image);
  const Colour measured = At(canvas, layout.ToCanvas({0.5, 0.5}));
  const Colour no_return = At(canvas, layout.ToCanvas({0.5, 1.5}));
  const cv::Point2d unseen_at = layout.ToCanvas({0.5, 2.5});
  EXPECT_EQ(no_return, NoReturnColour());
  EXPECT_EQ(At(canvas, unseen_at),
            NeverObservedColour(static_cast<int>(unseen_at.x), static_cast<int>(unseen_at.y)));
  EXPECT_GT(Distance(measured, no_return), 60.0);
}

TEST(RangeImagePictureTest, NearIsLighterThanFar) {
  RangeImage image = MakeWall();
  RoundedPixel near;
  near.range = 800;
  for (int row = 0; row < 60; ++row)
    for (int column = 8; column < 12; ++column) image.SetMeasured(row, column, near);
  const cv::Mat canvas = DrawRangeImage(image, {}, "");
  const RangeImageLayout layout = LayOutRangeImage(image);
  EXPECT_GT(cv::sum(At(canvas, layout.ToCanvas({30.5, 10.5})))[0],
            cv::sum(At(canvas, layout.ToCanvas({30.5, 50.5})))[0]);
}

TEST(RangeImagePictureTest, AnObjectColoursItsPixelsAndNoOthers) {
  const RangeImage image = MakeWall();
  const std::vector<ObjectModel> models = {MakePlate()};
  const std::vector<Detection> detections = {PlateAt(2.5, 0.0, 0.8)};
  const std::vector<DrawnObject> objects = MakeDrawnObjects(detections, models);
  const cv::Mat with = DrawRangeImage(image, objects, "");
  const cv::Mat without = DrawRangeImage(image, {}, "");
  const RangeImageLayout layout = LayOutRangeImage(image);
  // The middle of the plate is straight ahead at the sensor's height, beside the box's edges.
  const cv::Point2d middle =
      layout.ToCanvas(Project(image.grid(), Eigen::Vector3d(2.5, 0.03, 0.03)));
  const Colour expected = Blend(At(without, middle), ObjectColour(0), 0.55);
  EXPECT_LT(Distance(At(with, middle), expected), 2.0);
  const cv::Point2d corner = layout.ToCanvas({58.5, 2.5});
  EXPECT_EQ(At(with, corner), At(without, corner));
}

TEST(RangeImagePictureTest, PinholeImagesShowObjectsWhereTheyAre) {
  PixelGrid grid = MakeWall().grid();
  grid.projection = Projection::kPinhole;
  RangeImage image(grid, Eigen::Isometry3d::Identity());
  for (int row = 0; row < image.height(); ++row)
    for (int column = 0; column < image.width(); ++column)
      image.SetMeasured(row, column, {4000, 0, 0});
  const std::vector<ObjectModel> models = {MakePlate()};
  const std::vector<Detection> detections = {PlateAt(2.5, 0.0, -0.2), PlateAt(-2.5, 0.0, -0.2)};
  PictureExtras extras;
  extras.points.emplace_back();
  extras.points.back().p_sensor = Eigen::Vector3d(-2.0, 0.1, 0.2);
  const cv::Mat with = DrawRangeImage(image, MakeDrawnObjects(detections, models), "", extras);
  const cv::Mat without = DrawRangeImage(image, {}, "");
  const RangeImageLayout layout = LayOutRangeImage(image);
  const cv::Point2d middle =
      layout.ToCanvas(Project(image.grid(), Eigen::Vector3d(2.5, 0.03, 0.03)));
  const Colour expected = Blend(At(without, middle), ObjectColour(0), 0.55);
  EXPECT_LT(Distance(At(with, middle), expected), 2.0);
  const cv::Point2d corner = layout.ToCanvas({58.5, 2.5});
  EXPECT_EQ(At(with, corner), At(without, corner));
  // The legend tells the projection.
  RangeImage spherical(MakeWall().grid(), Eigen::Isometry3d::Identity());
  for (int row = 0; row < image.height(); ++row)
    for (int column = 0; column < image.width(); ++column)
      spherical.SetMeasured(row, column, {4000, 0, 0});
  const cv::Mat other = DrawRangeImage(spherical, {}, "");
  const cv::Rect below(0, layout.area.br().y, other.cols, other.rows - layout.area.br().y);
  EXPECT_GT(cv::norm(without(below), other(below)), 100.0);
}

TEST(RangeImagePictureTest, WhatTheSceneHidesIsNotPainted) {
  const RangeImage image = MakeWall();  // at 3 m
  const std::vector<ObjectModel> models = {MakePlate()};
  const std::vector<Detection> behind = {PlateAt(4.0, 0.0, 0.8)};
  const cv::Mat with = DrawRangeImage(image, MakeDrawnObjects(behind, models), "");
  const cv::Mat without = DrawRangeImage(image, {}, "");
  const cv::Point2d middle =
      LayOutRangeImage(image).ToCanvas(Project(image.grid(), Eigen::Vector3d(4.0, 0.06, 0.06)));
  EXPECT_EQ(At(with, middle), At(without, middle));
}

TEST(RangeImagePictureTest, AnEmptyImageGivesAPictureThatSaysSo) {
  const std::vector<Detection> detections = {PlateAt(1.0, 0.0, 0.0)};
  const cv::Mat canvas = DrawRangeImage(RangeImage(), MakeDrawnObjects(detections, {}), "empty");
  EXPECT_GT(canvas.total(), 0u);
  EXPECT_EQ(DrawTopView(RangeImage(), {}, "empty").type(), CV_8UC3);
}

TEST(RangeImagePictureTest, ObjectsBehindOrAroundTheSensorAreNoTrouble) {
  const RangeImage image = MakeWall();
  const std::vector<ObjectModel> models = {MakePlate()};
  const std::vector<Detection> detections = {PlateAt(-2.0, 0.0, 0.8), PlateAt(0.0, 0.0, 0.9),
                                             PlateAt(1e6, -1e6, 1e6)};
  const std::vector<DrawnObject> objects = MakeDrawnObjects(detections, models);
  EXPECT_GT(DrawRangeImage(image, objects, "").total(), 0u);
  EXPECT_GT(DrawTopView(image, objects, "").total(), 0u);
}

TEST(TopViewPictureTest, XIsUpAndYIsLeft) {
  const TopViewLayout layout = LayOutTopView(MakeWall(), {});
  const cv::Point2d origin = layout.ToCanvas(Eigen::Vector3d::Zero());
  const cv::Point2d ahead = layout.ToCanvas(Eigen::Vector3d::UnitX());
  const cv::Point2d left = layout.ToCanvas(Eigen::Vector3d::UnitY());
  EXPECT_NEAR(origin.y - ahead.y, layout.pixels_per_metre, 1e-6);
  EXPECT_NEAR(ahead.x, origin.x, 1e-6);
  EXPECT_NEAR(origin.x - left.x, layout.pixels_per_metre, 1e-6);
}

TEST(TopViewPictureTest, ShowsTheSensorAndEveryObject) {
  const RangeImage image = MakeWall();
  const std::vector<Detection> detections = {PlateAt(2.5, 0.5, 0.0), PlateAt(-6.0, 7.0, 0.0)};
  const std::vector<DrawnObject> objects = MakeDrawnObjects(detections, {});
  const TopViewLayout layout = LayOutTopView(image, objects);
  const cv::Mat canvas = DrawTopView(image, objects, "");
  EXPECT_EQ(canvas.size(), layout.canvas);
  EXPECT_EQ(At(canvas, layout.ToCanvas(image.T_local_sensor().translation())),
            Colour(255, 255, 255));
  for (const DrawnObject& object : objects) {
    for (const Eigen::Vector3d& corner : BoxCorners(object.detection))
      EXPECT_TRUE(layout.area.contains(cv::Point(layout.ToCanvas(corner))));
    // A footprint's edge runs through the middle of two of its corners.
    const Eigen::Vector3d on_edge =
        object.detection.T_local_object * Eigen::Vector3d(-0.05, 0.1, 0.0);
    EXPECT_LT(Distance(At(canvas, layout.ToCanvas(on_edge)), object.colour), 60.0);
  }
}

TEST(TopViewPictureTest, CeilingsAreLeftOut) {
  RangeImage image = MakeWall();
  const cv::Mat before = DrawTopView(image, {}, "");
  // One reading 2.9 m up, right of everything else drawn there.
  const Eigen::Vector3d p_sensor(2.0, 0.0, 1.9);
  PixelGrid grid = image.grid();
  grid.top = 0.9;
  grid.height = 120;
  RangeImage taller(grid, image.T_local_sensor());
  for (int row = 0; row < image.height(); ++row)
    for (int column = 0; column < image.width(); ++column)
      taller.SetMeasured(row + 60, column, image.rounded(row, column));
  const PixelPosition at = Project(grid, p_sensor);
  RoundedPixel pixel;
  pixel.range =
      static_cast<std::uint16_t>(std::lround(p_sensor.norm() / PixelRounding::kRangeUnit));
  taller.SetMeasured(static_cast<int>(at.row), static_cast<int>(at.column), pixel);
  ASSERT_TRUE(taller.measured(static_cast<int>(at.row), static_cast<int>(at.column)));
  const cv::Mat after = DrawTopView(taller, {}, "");
  ASSERT_EQ(before.size(), after.size());
  EXPECT_EQ(cv::norm(before, after), 0.0);
}

TEST(TopViewTest, ObjectsAtTheEndOfTheWorldAreLeftOut) {
  const std::vector<ObjectModel> models = {MakePlate()};
  const std::vector<DrawnObject> near = MakeDrawnObjects({PlateAt(2.0, 0.0, 0.0)}, models);
  const std::vector<DrawnObject> both =
      MakeDrawnObjects({PlateAt(2.0, 0.0, 0.0), PlateAt(1e300, -1e300, 0.0)}, models);
  const cv::Mat without = DrawTopView(MakeWall(), near, "title");
  const cv::Mat with = DrawTopView(MakeWall(), both, "title");
  ASSERT_EQ(without.size(), with.size());
  EXPECT_EQ(cv::norm(without, with), 0.0);
}

}  // namespace
}  // namespace rimod
