#include "rimod/model_views.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <tuple>

#include "rimod/surface_rendering.h"
#include "tests/support/surfel_models.h"

namespace rimod {
namespace {

constexpr double kResolution = 0.0069;

ModelViewParams Params() {
  ModelViewParams params;
  params.azimuths = 6;
  params.elevations = 3;
  params.min_elevation = -0.1;
  params.max_elevation = 0.7;
  params.distance = 2.5;
  params.validation_points = 80;
  params.outside_points = 30;
  params.ground_margin = 0.0;
  params.outside_gap = 0.04;
  return params;
}

const ObjectModel& Crate() {
  static const ObjectModel crate = BoxModel("crate", {0.5, 0.4, 0.6}, 0.01);
  return crate;
}

Eigen::Vector3d CentreOf(const ObjectModel& model) { return 0.5 * (model.box_min + model.box_max); }

// Distance of a point from the surface of a box around the centre.
double DistanceToBox(const Eigen::Vector3d& p, const ObjectModel& model) {
  const Eigen::Vector3d half = 0.5 * (model.box_max - model.box_min);
  const Eigen::Vector3d q = (p - CentreOf(model)).cwiseAbs() - half;
  return q.maxCoeff() > 0.0 ? q.cwiseMax(0.0).norm() : -q.maxCoeff();
}

ModelView ViewFrom(const ObjectModel& model, const Eigen::Vector3d& viewpoint,
                   const ModelViewParams& params) {
  ModelView view;
  view.viewpoint = viewpoint;
  SampleViewPoints(model, kResolution, params, &view);
  return view;
}

TEST(ViewpointsTest, StandInRingsAroundTheMiddle) {
  const std::vector<Eigen::Vector3d> viewpoints = Viewpoints(Crate(), Params());
  ASSERT_EQ(viewpoints.size(), 18u);
  std::set<std::tuple<long, long, long>> different;
  for (std::size_t i = 0; i < viewpoints.size(); ++i) {
    const Eigen::Vector3d offset = viewpoints[i] - CentreOf(Crate());
    EXPECT_NEAR(offset.norm(), 2.5, 1e-9);
    const double elevation = std::asin(offset.z() / offset.norm());
    EXPECT_NEAR(elevation, -0.1 + 0.4 * static_cast<double>(i / 6), 1e-9);
    different.insert({std::lround(offset.x() * 1e4), std::lround(offset.y() * 1e4),
                      std::lround(offset.z() * 1e4)});
  }
  EXPECT_EQ(different.size(), 18u);
}

TEST(ViewpointsTest, OneRingStandsAtTheLowestElevation) {
  ModelViewParams params = Params();
  params.elevations = 1;
  for (const Eigen::Vector3d& viewpoint : Viewpoints(Crate(), params))
    EXPECT_NEAR((viewpoint - CentreOf(Crate())).z(), 2.5 * std::sin(-0.1), 1e-9);
}

TEST(ViewpointsTest, LargeModelsAreSeenFromFartherAway) {
  const ObjectModel large = BoxModel("large", {3, 3, 3}, 0.1);
  for (const Eigen::Vector3d& viewpoint : Viewpoints(large, Params()))
    EXPECT_GE((viewpoint - CentreOf(large)).norm(), 1.5 * large.Diameter() - 1e-9);
}

TEST(RenderViewTest, ShowsTheModelAndNothingElse) {
  for (const Eigen::Vector3d& viewpoint : Viewpoints(Crate(), Params())) {
    const RangeImage image = RenderView(Crate(), viewpoint, kResolution, 0.0);
    EXPECT_NEAR((image.T_local_sensor().translation() - viewpoint).norm(), 0.0, 1e-12);
    EXPECT_GT(image.CountMeasured(), 500);
    for (int row = 0; row < image.height(); ++row) {
      for (int column = 0; column < image.width(); ++column) {
        EXPECT_NE(image.pixel(row, column), Pixel::kNeverObserved);
        if (!image.measured(row, column)) continue;
        const Eigen::Vector3d p_object =
            image.T_local_sensor() * image.point(row, column).cast<double>();
        EXPECT_LT(DistanceToBox(p_object, Crate()), 0.03);
      }
    }
    // All of it is inside: the rim is empty.
    for (int row = 0; row < image.height(); ++row) {
      EXPECT_FALSE(image.measured(row, 0));
      EXPECT_FALSE(image.measured(row, image.width() - 1));
    }
    for (int column = 0; column < image.width(); ++column) {
      EXPECT_FALSE(image.measured(0, column));
      EXPECT_FALSE(image.measured(image.height() - 1, column));
    }
  }
}

TEST(SampleViewPointsTest, ValidationPointsAreVisibleSurface) {
  for (const Eigen::Vector3d& viewpoint : Viewpoints(Crate(), Params())) {
    const ModelView view = ViewFrom(Crate(), viewpoint, Params());
    ASSERT_EQ(view.validation_points.size(), 80u);
    ASSERT_EQ(view.validation_normals.size(), 80u);
    for (std::size_t i = 0; i < 80; ++i) {
      const Eigen::Vector3d p = view.validation_points[i].cast<double>();
      const Eigen::Vector3d normal = view.validation_normals[i].cast<double>();
      EXPECT_LT(DistanceToBox(p, Crate()), 1e-5);
      EXPECT_GT(normal.dot(viewpoint - p), 0.0);
      EXPECT_NEAR(normal.norm(), 1.0, 1e-5);
    }
  }
}

TEST(SampleViewPointsTest, ValidationPointsAreSpreadOverWhatIsSeen) {
  // Seen square on, the plate's four quarters get equal shares.
  const ObjectModel plate = PlateModel("plate", 0.6, 0.01);
  const ModelView view = ViewFrom(plate, {2.5, 0.0, 0.3}, Params());
  int quarters[4] = {0, 0, 0, 0};
  for (const Eigen::Vector3f& p : view.validation_points)
    ++quarters[(p.y() > 0.0f ? 1 : 0) + (p.z() > 0.3f ? 2 : 0)];
  for (const int count : quarters) EXPECT_NEAR(count, 20, 6);
}

TEST(SampleViewPointsTest, OutsidePointsLieBesideTheSilhouette) {
  const Eigen::Vector3d viewpoint(2.5, 0.0, 0.3);
  const ObjectModel plate = PlateModel("plate", 0.6, 0.01);
  const ModelView view = ViewFrom(plate, viewpoint, Params());
  EXPECT_GT(view.outside_points.size(), 20u);
  EXPECT_LE(view.outside_points.size(), 30u);
  for (const Eigen::Vector3f& p : view.outside_points) {
    // Where its beam meets the plate's plane, some centimetres past its rim.
    const Eigen::Vector3d beam = p.cast<double>() - viewpoint;
    const Eigen::Vector3d on_plane = viewpoint - beam * viewpoint.x() / beam.x();
    const double past_rim =
        std::max(std::abs(on_plane.y()) - 0.3, std::abs(on_plane.z() - 0.3) - 0.3);
    EXPECT_GT(past_rim, 0.005);
    EXPECT_LT(past_rim, 0.12);
    EXPECT_NEAR(p.x(), 0.0, 0.05);  // at the depth of the edge
  }
  ModelViewParams none = Params();
  none.outside_points = 0;
  EXPECT_TRUE(ViewFrom(plate, viewpoint, none).outside_points.empty());
}

TEST(SampleViewPointsTest, ThereAreNoMorePointsThanAreSeen) {
  const ObjectModel speck = BoxModel("speck", {0.02, 0.02, 0.02}, 0.01);
  ModelViewParams params = Params();
  params.validation_points = 10000;
  const ModelView view = ViewFrom(speck, {2.5, 0.1, 0.3}, params);
  EXPECT_LT(view.validation_points.size(), 100u);
  EXPECT_GT(view.validation_points.size(), 0u);
  const ModelView nothing = ViewFrom(PlateModel("plate", 0.6, 0.01), {-2.5, 0, 0.3}, params);
  EXPECT_TRUE(nothing.validation_points.empty());  // from behind
  EXPECT_TRUE(nothing.outside_points.empty());
}

TEST(ModelViewParamsTest, KindTellsDifferentViewsApart) {
  const std::string kind = Params().Kind();
  EXPECT_EQ(Params().Kind(), kind);
  ModelViewParams params = Params();
  params.azimuths = 7;
  EXPECT_NE(params.Kind(), kind);
  params = Params();
  params.elevations = 2;
  EXPECT_NE(params.Kind(), kind);
  params = Params();
  params.min_elevation = 0.0;
  EXPECT_NE(params.Kind(), kind);
  params = Params();
  params.max_elevation = 0.8;
  EXPECT_NE(params.Kind(), kind);
  params = Params();
  params.distance = 3.0;
  EXPECT_NE(params.Kind(), kind);
  params = Params();
  params.validation_points = 81;
  EXPECT_NE(params.Kind(), kind);
  params = Params();
  params.outside_points = 31;
  EXPECT_NE(params.Kind(), kind);
  params = Params();
  params.outside_gap = 0.05;
  EXPECT_NE(params.Kind(), kind);
}

}  // namespace
}  // namespace rimod
