// A depth camera that looks down finds things in pinhole images.
#include <gtest/gtest.h>

#include <cmath>

#include "rimod/detector.h"
#include "rimod/early_detection.h"
#include "rimod/feature_extraction.h"
#include "rimod/model_building.h"
#include "rimod/model_database.h"
#include "tests/support/furniture.h"
#include "tests/support/matchers.h"
#include "tests/support/ray_caster.h"

namespace rimod {
namespace {

constexpr double kDegree = M_PI / 180.0;

PipelineParams Params() {
  PipelineParams params = DefaultParams(Method::kDefault);
  params.range_image.resolution = 0.01;
  params.range_image.projection = Projection::kPinhole;
  params.matching.max_matches = 12;
  params.ranking.refined = {10, 200, 0.001};
  params.ranking.judged = {10, 60, 0.001};
  params.model_views.azimuths = 8;
  params.model_views.elevations = 2;
  params.model_views.min_elevation = 0.3;
  params.model_views.max_elevation = 1.2;
  return params;
}

const ModelDatabase& Database() {
  static const ModelDatabase database({BuildModel(Record(Armchair()), Params(), Execution{})},
                                      Params(), Execution{});
  return database;
}

// 2.2 m from the sensor, 2.2 m above the floor or less, in the direction that the camera looks.
struct Setting {
  explicit Setting(double pitch) {
    constexpr double kDistance = 2.2;  // m
    const double height = std::max(kDistance * std::sin(pitch), 0.8) + 0.4;
    T_local_sensor = Placed(0.4, -0.2, height, 0.6);
    const Eigen::Vector3d aside(kDistance * std::cos(pitch), 0.1, 0.0);
    const Eigen::Vector3d below = T_local_sensor * aside;
    T_local_object = Placed(below.x(), below.y(), 0.0, 2.3);
    World world;
    world.planes = {{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()}};
    Place(Armchair(), T_local_object, &world);
    CameraPattern camera;
    camera.pitch = pitch;
    camera.noise = 0.003;
    scan = ScanWorld(world, T_local_sensor, camera);
  }

  Eigen::Isometry3d T_local_sensor, T_local_object;
  Scan scan;
};

class PinholeDetectionTest : public testing::TestWithParam<double> {};

TEST_P(PinholeDetectionTest, FindsTheSceneFromAnyPitch) {
  const Setting setting(GetParam() * kDegree);
  const PipelineParams params = Params();
  const RangeImage image = ComputeRangeImage(setting.scan, params, Execution{});
  ASSERT_EQ(image.grid().projection, Projection::kPinhole);
  const FeatureSet features = ExtractFeatures(image, params, Execution{});
  const DetectionResult result = DetectObjects(image, features, Database(), params, Execution{});
  ASSERT_EQ(result.detections.size(), 1u);
  EXPECT_TRUE(PosesNear(result.detections[0].T_local_object, setting.T_local_object, 0.03, 0.05));
  EXPECT_LT(UnseenShare(image, Database().models()[0],
                        setting.T_local_sensor.inverse() * setting.T_local_object),
            0.3);
}

INSTANTIATE_TEST_SUITE_P(Pitches, PinholeDetectionTest, testing::Values(15.0, 45.0, 75.0));

}  // namespace
}  // namespace rimod
