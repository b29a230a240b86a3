#include "rimod/image_change.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "tests/support/ray_caster.h"

namespace rimod {
namespace {

constexpr double kResolution = 0.02;

// Edges at whole multiples of the resolution.
PixelGrid Grid(int top, int left, int height, int width) {
  PixelGrid grid;
  grid.resolution = kResolution;
  grid.top = top * kResolution;
  grid.left = left * kResolution;
  grid.height = height;
  grid.width = width;
  return grid;
}

RangeImage Empty(const PixelGrid& grid) { return {grid, Eigen::Isometry3d::Identity()}; }

class RandomImages {
 public:
  explicit RandomImages(unsigned seed) : generator_(seed) {}

  int Int(int first, int last) {
    return std::uniform_int_distribution<int>(first, last)(generator_);
  }
  double Real(double first, double last) {
    return std::uniform_real_distribution<double>(first, last)(generator_);
  }

  void SetRandomPixel(int row, int column, RangeImage* image) {
    switch (Int(0, 3)) {
      case 0:
        return image->SetNoReturn(row, column);
      case 1:
        return;
      default:
        image->SetMeasured(
            row, column,
            {static_cast<std::uint16_t>(Int(1, 5000)), static_cast<std::int8_t>(Int(-128, 127)),
             static_cast<std::int8_t>(Int(-128, 127))});
    }
  }

  RangeImage Image(const PixelGrid& grid) {
    RangeImage image = Empty(grid);
    for (int row = 0; row < grid.height; ++row)
      for (int column = 0; column < grid.width; ++column) SetRandomPixel(row, column, &image);
    return image;
  }

 private:
  std::mt19937 generator_;
};

// The earlier image's pixels in a larger image.
RangeImage Grown(const RangeImage& image, int above, int below, int left, int right) {
  PixelGrid grid = image.grid();
  grid.top += above * grid.resolution;
  grid.left += left * grid.resolution;
  grid.height += above + below;
  grid.width += left + right;
  RangeImage grown = Empty(grid);
  for (int row = 0; row < image.height(); ++row) {
    for (int column = 0; column < image.width(); ++column) {
      if (image.measured(row, column))
        grown.SetMeasured(row + above, column + left, image.rounded(row, column));
      if (image.pixel(row, column) == Pixel::kNoReturn)
        grown.SetNoReturn(row + above, column + left);
    }
  }
  return grown;
}

TEST(ImageChangeTest, WithoutAnEarlierImageEverythingIsNew) {
  const ImageChange change;
  EXPECT_TRUE(change.everything());
  EXPECT_TRUE(change.Touches({1.0f, 0.0f, 0.0f}, 0.01f));
  EXPECT_TRUE(change.TouchesPixels(0, 0, 0));
  EXPECT_TRUE(change.TouchesBox(Eigen::Isometry3f::Identity(), {1, 0, 0}, {2, 1, 1}));
  EXPECT_TRUE(change.MovedRuns({{0, 3}}).empty());
}

TEST(ImageChangeTest, NothingIsNewInTheSameImageHoweverFarItsGridReaches) {
  RandomImages random(1);
  for (int i = 0; i < 20; ++i) {
    const RangeImage image = random.Image(Grid(random.Int(-5, 20), random.Int(-20, 40), 12, 17));
    const ImageChange change(image, Grown(image, random.Int(0, 4), random.Int(0, 4),
                                          random.Int(0, 4), random.Int(0, 4)));
    EXPECT_FALSE(change.everything());
    EXPECT_FALSE(change.TouchesPixels(8, 8, 100));
    EXPECT_FALSE(change.Touches({1.0f, 0.2f, 0.0f}, 0.9f));
  }
}

TEST(ImageChangeTest, ImagesOfAnotherPlaceOrGridAreNotCompared) {
  RandomImages random(2);
  const RangeImage image = random.Image(Grid(5, 5, 10, 10));
  Eigen::Isometry3d elsewhere = Eigen::Isometry3d::Identity();
  elsewhere.translation().x() = 1e-9;
  PixelGrid finer = image.grid(), beside = image.grid();
  finer.resolution *= 0.5;
  beside.top += 0.3 * kResolution;
  EXPECT_TRUE(ImageChange(image, RangeImage(image.grid(), elsewhere)).everything());
  EXPECT_TRUE(ImageChange(image, Empty(finer)).everything());
  EXPECT_TRUE(ImageChange(image, Empty(beside)).everything());
  EXPECT_TRUE(ImageChange(RangeImage(), image).everything());
  EXPECT_TRUE(ImageChange(image, RangeImage()).everything());
  PixelGrid pinhole = image.grid();
  pinhole.projection = Projection::kPinhole;
  EXPECT_TRUE(ImageChange(image, Empty(pinhole)).everything());
  PixelGrid other_axis = pinhole;
  other_axis.axis.elevation = -0.1;
  EXPECT_FALSE(ImageChange(Empty(pinhole), Empty(pinhole)).everything());
  EXPECT_TRUE(ImageChange(Empty(pinhole), Empty(other_axis)).everything());
  PixelGrid far_off = image.grid();
  far_off.left = 1e300;
  EXPECT_TRUE(ImageChange(image, Empty(far_off)).everything());
}

// What is left out of the new image, or comes from outside of the earlier one, is new as well.
TEST(ImageChangeTest, FindsEachChangedPixel) {
  RandomImages random(3);
  for (int i = 0; i < 50; ++i) {
    const RangeImage before = random.Image(Grid(10, 10, 9, 11));
    const int above = random.Int(0, 3), left = random.Int(0, 3);
    RangeImage now = Grown(before, above, 2, left, 2);
    const int row = random.Int(0, now.height() - 1), column = random.Int(0, now.width() - 1);
    const RangeImage same = now;
    random.SetRandomPixel(row, column, &now);
    const bool changed = now.pixel(row, column) != same.pixel(row, column) ||
                         now.point(row, column) != same.point(row, column);
    const ImageChange change(before, now);
    EXPECT_EQ(change.TouchesPixels(row, column, 0), changed);
    EXPECT_EQ(change.TouchesPixels(row + 2, column - 2, 2), changed);
    EXPECT_FALSE(change.TouchesPixels(row + 2, column, 1));
    EXPECT_FALSE(change.TouchesPixels(row, column - 2, 1));
  }
}

// A single changed pixel and many spheres: it must be seen where the pixel is within a sphere's
// cone, and must not be far outside of it.
TEST(ImageChangeTest, SpheresSeeWhatTheyMayCover) {
  RandomImages random(4);
  int num_touched = 0, num_apart = 0;
  for (int i = 0; i < 800; ++i) {
    const RangeImage before = Empty(Grid(70, 157, 140, 314));  // all around, up to 80 degrees
    RangeImage now = before;
    const int row = random.Int(0, 139), column = random.Int(0, 313);
    now.SetNoReturn(row, column);
    const ImageChange change(before, now);
    const Eigen::Vector3d beam =
        UnitVector(PixelDirection(now.grid(), row + random.Real(0, 1), column + random.Real(0, 1)));
    const Direction middle{random.Real(-3.14, 3.14), random.Real(-1.4, 1.4)};
    const double distance = random.Real(0.5, 10.0), radius = random.Real(0.01, 0.9) * distance;
    const Eigen::Vector3d centre = distance * UnitVector(middle);
    const double apart = std::acos(std::clamp(beam.dot(centre) / distance, -1.0, 1.0));
    const double angle = std::asin(radius / distance);
    const bool touched = change.Touches(centre.cast<float>(), static_cast<float>(radius));
    if (apart <= angle) {
      EXPECT_TRUE(touched) << "elevation " << middle.elevation << " azimuth " << middle.azimuth;
      ++num_touched;
    }
    const Direction of_beam = DirectionOf(beam);
    if (std::abs(of_beam.elevation - middle.elevation) > angle + 1.5 * kResolution) {
      EXPECT_FALSE(touched);
      ++num_apart;
    }
  }
  EXPECT_GT(num_touched, 50);
  EXPECT_GT(num_apart, 50);
  const RangeImage before = Empty(Grid(5, 5, 10, 10));
  RangeImage now = before;
  now.SetNoReturn(0, 0);
  const ImageChange change(before, now);
  EXPECT_TRUE(change.Touches({0.1f, 0.0f, 0.0f}, 0.2f)) << "around the sensor";
  EXPECT_TRUE(change.Touches({NAN, 0.0f, 0.0f}, 0.2f));
}

// The same in a pinhole image that looks down; what it cannot hold may be anywhere.
TEST(ImageChangeTest, SpheresInPinholeImagesSeeWhatTheyMayCover) {
  RandomImages random(7);
  int num_touched = 0, num_apart = 0;
  for (int i = 0; i < 2000; ++i) {
    PixelGrid grid = Grid(50, 50, 100, 100);
    grid.projection = Projection::kPinhole;
    grid.axis = {random.Real(-3.0, 3.0), random.Real(-1.57, 0.5)};
    const RangeImage before = Empty(grid);
    RangeImage now = before;
    const int row = random.Int(0, 99), column = random.Int(0, 99);
    now.SetNoReturn(row, column);
    const ImageChange change(before, now);
    const Eigen::Vector3d beam =
        PixelBeam(grid, row + random.Real(0, 1), column + random.Real(0, 1));
    const double distance = random.Real(0.5, 10.0), radius = random.Real(0.01, 0.5) * distance;
    const Eigen::Vector3d centre =
        distance * PixelBeam(grid, random.Real(0, 100), random.Real(0, 100));
    const double apart = std::acos(std::clamp(beam.dot(centre) / distance, -1.0, 1.0));
    const double angle = std::asin(radius / distance);
    const bool touched = change.Touches(centre.cast<float>(), static_cast<float>(radius));
    if (apart <= angle) {
      EXPECT_TRUE(touched);
      ++num_touched;
    } else if (!touched) {
      ++num_apart;
    }
  }
  EXPECT_GT(num_touched, 100);
  EXPECT_GT(num_apart, 200);
  PixelGrid grid = Grid(50, 50, 100, 100);
  grid.projection = Projection::kPinhole;
  RangeImage now = Empty(grid);
  now.SetNoReturn(0, 0);
  const ImageChange change(Empty(grid), now);
  EXPECT_TRUE(change.Touches({-2.0f, 0.0f, 0.0f}, 0.1f)) << "behind";
  EXPECT_TRUE(change.TouchesBox(Eigen::Isometry3f::Identity(), {-0.5, -1, -1}, {2, 1, 1}));
  EXPECT_FALSE(change.TouchesBox(Eigen::Isometry3f::Identity(), {2, -1, -1}, {3, 0, 0}));
  EXPECT_TRUE(change.TouchesBox(Eigen::Isometry3f::Identity(), {2, 1, 1}, {3, 3, 3}));
}

// Also where a side is nearer than the corners, and so steeper.
TEST(ImageChangeTest, BoxesSeeThePixelsOfTheirPoints) {
  RandomImages random(5);
  int num_apart = 0;
  for (int i = 0; i < 800; ++i) {
    PixelGrid grid = Grid(60, 150, 150, 300);
    if (i % 3 == 0) {
      grid.projection = Projection::kPinhole;
      grid.axis.elevation = -0.6;
    }
    const RangeImage before = Empty(grid);
    const Eigen::Isometry3d pose = Placed(random.Real(1.0, 5.0), random.Real(-2.0, 2.0),
                                          random.Real(-1.5, 1.0), random.Real(-3.0, 3.0));
    const Eigen::Vector3d low(-0.3, -0.8, 0.0), high(0.3, 0.8, random.Real(0.1, 1.0));
    Eigen::Vector3d p_object(random.Real(-0.3, 0.3), random.Real(-0.8, 0.8),
                             random.Real(0.0, high.z()));
    if (i % 2 == 0) p_object.z() = random.Int(0, 1) * high.z();  // on top or below
    if (i % 4 < 2) p_object.x() = random.Int(0, 1) == 0 ? low.x() : high.x();
    const PixelPosition at = Project(grid, pose * p_object);
    const int row = static_cast<int>(std::floor(at.row));
    const int column = static_cast<int>(std::floor(at.column));
    if (!grid.Contains(row, column)) continue;
    RangeImage now = before;
    now.SetNoReturn(row, column);
    const auto touches = [&](const RangeImage& image) {
      return ImageChange(before, image)
          .TouchesBox(pose.cast<float>(), low.cast<float>(), high.cast<float>());
    };
    EXPECT_TRUE(touches(now)) << "row " << at.row << " column " << at.column;
    RangeImage elsewhere = before;
    elsewhere.SetNoReturn(random.Int(0, 149), random.Int(0, 299));
    num_apart += !touches(elsewhere);
  }
  EXPECT_GT(num_apart, 300);
}

// The middle of a near side's lower edge is seen steeper than its ends.
TEST(ImageChangeTest, BoxesSeeThePixelsBelowTheirCorners) {
  const RangeImage before = Empty(Grid(60, 150, 150, 300));
  for (const double z : {-1.1, 0.4}) {  // m, of the bottom: below the sensor, and the top above it
    const Eigen::Isometry3d pose = Placed(1.45, 0.0, z, 0.0);
    const Eigen::Vector3d edge(-0.3, 0.0, z < 0.0 ? 0.0 : 0.7);
    const PixelPosition at = Project(before.grid(), pose * edge);
    RangeImage now = before;
    now.SetNoReturn(static_cast<int>(at.row), static_cast<int>(at.column));
    EXPECT_TRUE(ImageChange(before, now)
                    .TouchesBox(pose.cast<float>(), {-0.3f, -0.8f, 0.0f}, {0.3f, 0.8f, 0.7f}));
  }
}

TEST(ImageChangeTest, BoxesAboutOrBehindTheSensorSeeEverything) {
  const RangeImage before = Empty(Grid(5, 5, 10, 10));
  RangeImage now = before;
  now.SetNoReturn(0, 0);
  const ImageChange change(before, now);
  const auto touches = [&](const Eigen::Vector3f& low, const Eigen::Vector3f& high) {
    return change.TouchesBox(Eigen::Isometry3f::Identity(), low, high);
  };
  EXPECT_TRUE(touches({-1, -1, -1}, {1, 1, 1}));
  EXPECT_TRUE(touches({-2, -1, -1}, {-1, 1, 1}));
  EXPECT_FALSE(touches({2, -1.5, -1}, {3, -1, -0.5}));
  Eigen::Isometry3f nowhere = Eigen::Isometry3f::Identity();
  nowhere.translation().x() = NAN;
  EXPECT_TRUE(change.TouchesBox(nowhere, {1, -1, -1}, {2, 1, 1}));
}

TEST(ImageChangeTest, RunsMoveWithTheirPixels) {
  RandomImages random(6);
  for (int i = 0; i < 100; ++i) {
    const RangeImage before = Empty(Grid(10, 10, 6, 8));
    const int above = random.Int(-2, 3), left = random.Int(-2, 3);
    const PixelGrid grid = Grid(10 + above, 10 + left, 8, 9);
    const ImageChange change(before, Empty(grid));
    ASSERT_FALSE(change.everything());
    EXPECT_EQ(change.row_shift(), above);
    EXPECT_EQ(change.column_shift(), left);
    const PixelRun run{random.Int(0, 20), random.Int(1, 25)};
    std::set<int> expected;
    for (int pixel = run.first; pixel < run.first + run.count; ++pixel) {
      const int row = pixel / 8 + above, column = pixel % 8 + left;
      if (grid.Contains(row, column)) expected.insert(row * grid.width + column);
    }
    std::set<int> moved;
    int last = -2;
    for (const PixelRun& r : change.MovedRuns({run})) {
      EXPECT_GT(r.first, last + 1) << "runs are apart";
      EXPECT_GT(r.count, 0);
      last = r.first + r.count - 1;
      for (int k = 0; k < r.count; ++k) moved.insert(r.first + k);
    }
    EXPECT_EQ(moved, expected);
  }
}

}  // namespace
}  // namespace rimod
