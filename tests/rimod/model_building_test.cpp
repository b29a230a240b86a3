#include "rimod/model_building.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/executions.h"
#include "tests/support/matchers.h"
#include "tests/support/ray_caster.h"
#include "tests/support/surfel_models.h"

namespace rimod {
namespace {

const Eigen::Vector3d kSize(0.5, 0.4, 0.6);

PipelineParams Params() {
  PipelineParams params;
  params.range_image.resolution = 0.0069;
  params.model_surface.point_spacing = 0.015;
  params.model_surface.normal_radius = 0.04;
  params.model_views.azimuths = 6;
  params.model_views.elevations = 1;
  params.model_views.distance = 2.5;
  return params;
}

Recording RecordBox() {
  Recording recording;
  recording.class_name = "crate";
  recording.T_local_object = Placed(0.5, 0.2, 0.0, 0.4);
  recording.box_min = Eigen::Vector3d(-0.25, -0.2, 0.0);
  recording.box_max = Eigen::Vector3d(0.25, 0.2, 0.6);
  World world;
  world.planes = {{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()}};
  BoxShape box;
  box.T_local_box = recording.T_local_object * Eigen::Translation3d(0, 0, 0.3);
  box.half_size = 0.5 * kSize;
  world.boxes = {box};
  BeamPattern pattern;
  pattern.azimuth_min = -0.3;
  pattern.azimuth_max = 0.3;
  pattern.elevation_min = -0.7;
  pattern.elevation_max = 0.1;
  for (int i = 0; i < 6; ++i) {
    const double angle = 2.0 * M_PI * i / 6;
    const Eigen::Vector3d position(0.5 + 2 * std::cos(angle), 0.2 + 2 * std::sin(angle), 1.0);
    recording.scans.push_back(
        ScanWorld(world, LookAt(position, Eigen::Vector3d(0.5, 0.2, 0.0)), pattern));
  }
  return recording;
}

Mesh BoxMesh() {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back({((i & 1) - 0.5) * kSize.x(), (((i >> 1) & 1) - 0.5) * kSize.y(),
                             ((i >> 2) & 1) * kSize.z()});
  for (const Eigen::Vector4i& f :
       {Eigen::Vector4i(0, 1, 3, 2), Eigen::Vector4i(4, 5, 7, 6), Eigen::Vector4i(0, 1, 5, 4),
        Eigen::Vector4i(2, 3, 7, 6), Eigen::Vector4i(0, 2, 6, 4), Eigen::Vector4i(1, 3, 7, 5)}) {
    mesh.triangles.push_back({f[0], f[1], f[2]});
    mesh.triangles.push_back({f[0], f[2], f[3]});
  }
  return mesh;
}

void ExpectBoxModel(const ObjectModel& model) {
  EXPECT_NO_THROW(ValidateModel(model));
  EXPECT_EQ(model.name, "crate");
  EXPECT_TRUE(model.box_min.isApprox(Eigen::Vector3d(-0.25, -0.2, 0.0), 0.05));
  EXPECT_TRUE(model.box_max.isApprox(Eigen::Vector3d(0.25, 0.2, 0.6), 0.05));
  EXPECT_GT(model.points.size(), 1000u);
  ASSERT_EQ(model.views.size(), 6u);
  for (const ModelView& view : model.views) {
    EXPECT_FALSE(view.features.empty());
    EXPECT_EQ(static_cast<int>(view.validation_points.size()),
              Params().model_views.validation_points);
  }
}

TEST(BuildModelTest, FromARecording) {
  const ObjectModel model = BuildModel(RecordBox(), Params(), Execution{});
  ExpectBoxModel(model);
  EXPECT_NE(model.source.find('6'), std::string::npos);  // scans
}

TEST(BuildModelTest, FromPoints) {
  ExpectBoxModel(
      BuildModelFromPoints("crate", BoxModel("b", kSize, 0.01).points, Params(), Execution{}));
}

TEST(BuildModelTest, FromAMesh) {
  ExpectBoxModel(BuildModelFromMesh("crate", BoxMesh(), Params(), Execution{}));
}

TEST(BuildModelTest, ThreadsDoNotMatter) {
  const Recording recording = RecordBox();
  const ObjectModel alone = BuildModel(recording, Params(), Execution{});
  const ObjectModel other = BuildModel(recording, Params(), OnThreads(4));
  EXPECT_EQ(alone.points, other.points);
  EXPECT_EQ(alone.normals, other.normals);
  ASSERT_EQ(alone.views.size(), other.views.size());
  for (std::size_t v = 0; v < alone.views.size(); ++v) {
    EXPECT_EQ(alone.views[v].validation_points, other.views[v].validation_points);
    ASSERT_EQ(alone.views[v].features.size(), other.views[v].features.size());
    for (std::size_t f = 0; f < alone.views[v].features.size(); ++f)
      EXPECT_EQ(alone.views[v].features[f].descriptor, other.views[v].features[f].descriptor);
  }
}

TEST(BuildModelTest, TooFewPointsAreNoModel) {
  Recording empty;
  empty.class_name = "crate";
  EXPECT_TRUE(Complains([&] { BuildModel(empty, Params(), Execution{}); }, {"crate", "0"}));
  Recording elsewhere = RecordBox();
  elsewhere.T_local_object.translation().z() += 3.0;
  EXPECT_TRUE(Complains([&] { BuildModel(elsewhere, Params(), Execution{}); }, {"crate"}));
  for (const std::vector<Eigen::Vector3f>& points :
       {std::vector<Eigen::Vector3f>{},
        {Eigen::Vector3f(1, 2, 3)},
        std::vector<Eigen::Vector3f>(5000, Eigen::Vector3f(1, 2, 3)),
        std::vector<Eigen::Vector3f>(
            5000, Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()))})
    EXPECT_TRUE(Complains([&] { BuildModelFromPoints("crate", points, Params(), Execution{}); },
                          {"crate"}));
  EXPECT_TRUE(
      Complains([&] { BuildModelFromMesh("crate", Mesh{}, Params(), Execution{}); }, {"crate"}));
}

TEST(BuildModelTest, UnusableNamesAreRefused) {
  for (const char* name : {"", "../crate", "a b"})
    EXPECT_THROW(BuildModelFromMesh(name, BoxMesh(), Params(), Execution{}), std::invalid_argument);
}

}  // namespace
}  // namespace rimod
