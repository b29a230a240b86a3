#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <random>
#include <vector>

#include "rimod/features.h"
#include "rimod/range_image.h"
#include "rimod/scan.h"

namespace rimod {

// Seeded random values for tests of conversions.
class RandomValues {
 public:
  explicit RandomValues(unsigned seed) : generator_(seed) {}

  double Between(double min, double max) {
    return std::uniform_real_distribution<double>(min, max)(generator_);
  }
  int Int(int min, int max) { return std::uniform_int_distribution<int>(min, max)(generator_); }

  Eigen::Vector3d Vector(double reach) {
    return {Between(-reach, reach), Between(-reach, reach), Between(-reach, reach)};
  }
  Eigen::Vector3d Unit() {
    Eigen::Vector3d v;
    do v = Vector(1.0);
    while (v.norm() < 0.1 || v.norm() > 1.0);
    return v.normalized();
  }
  Eigen::Isometry3d Pose() {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = Eigen::AngleAxisd(Between(-M_PI, M_PI), Unit()).toRotationMatrix();
    T.translation() = Vector(20.0);
    return T;
  }
  Eigen::Isometry3d Level() { return LevelPose(Pose()); }

  Scan AScan(int num_points, int num_no_returns) {
    Scan scan;
    scan.T_local_sensor = Level();
    for (int i = 0; i < num_points; ++i) scan.points.push_back(Vector(30.0).cast<float>());
    for (int i = 0; i < num_no_returns; ++i) {
      scan.no_return_directions.push_back(Unit().cast<float>());
    }
    return scan;
  }

  RangeImage AnImage(int width, int height, Projection projection = Projection::kSpherical) {
    PixelGrid grid;
    grid.width = width;
    grid.height = height;
    grid.resolution = 0.007;
    grid.left = Between(0.5, 1.5);
    grid.top = Between(0.1, 1.0);
    grid.projection = projection;
    if (projection == Projection::kPinhole) grid.axis = {Between(-3.0, 3.0), Between(-1.5, 1.5)};
    RangeImage image(grid, Level());
    for (int row = 0; row < height; ++row) {
      for (int column = 0; column < width; ++column) {
        const int kind = Int(0, 3);
        if (kind == 0) continue;
        if (kind == 1) {
          image.SetNoReturn(row, column);
        } else {
          image.SetMeasured(
              row, column,
              {static_cast<std::uint16_t>(Int(1, PixelRounding::kMaxRangeSteps)),
               static_cast<std::int8_t>(Int(-128, 127)), static_cast<std::int8_t>(Int(-128, 127))});
        }
      }
    }
    return image;
  }

  // At measured points of the image, of which there must be one.
  FeatureSet FeaturesOf(const RangeImage& image, int number, int descriptor_size) {
    FeatureSet set = Features(number, descriptor_size);
    for (Feature& feature : set.features) {
      int row = 0, column = 0;
      do {
        row = Int(0, image.height() - 1);
        column = Int(0, image.width() - 1);
      } while (!image.measured(row, column));
      feature.position = image.point(row, column);
    }
    return set;
  }

  FeatureSet Features(int number, int descriptor_size) {
    FeatureSet set;
    set.descriptor_kind = "test kind 1.5";
    set.descriptor_size = descriptor_size;
    for (int i = 0; i < number; ++i) {
      Feature feature;
      feature.position = Vector(10.0).cast<float>();
      feature.normal = Unit().cast<float>();
      for (int k = 0; k < descriptor_size; ++k) {
        feature.descriptor.push_back(static_cast<std::int16_t>(Int(INT16_MIN, INT16_MAX)));
      }
      set.features.push_back(std::move(feature));
    }
    return set;
  }

 private:
  std::mt19937 generator_;
};

}  // namespace rimod
