#include "scanner_proc/scene_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "tests/support/temporary_folder.h"

namespace rimod::simulation {
namespace {

constexpr double kDegree = M_PI / 180.0;

SceneResult ReadText(const std::string& yaml) {
  const TemporaryFolder folder;
  return ReadScene(folder.Write("scene.yaml", yaml));
}

// The error of a scene text without the folder in front of the file's name.
std::string ErrorOf(const std::string& yaml) {
  const SceneResult result = ReadText(yaml);
  EXPECT_FALSE(result.scene) << yaml;
  const std::size_t name = result.error.find("scene.yaml");
  return name == std::string::npos ? result.error : result.error.substr(name);
}

TEST(SceneFileTest, EveryKeyIsRead) {
  const SceneResult result = ReadText(R"(
name: hall
seed: 42
start_utime: 1234567
sensor:
  position: [1, 2, 0.9]
  yaw_deg: 90
  tilt_start_deg: 45
  tilt_end_deg: -45
  tilt_step_deg: 0.5
  line_period: 0.02
  first_angle_deg: -60
  angle_step_deg: 1
  num_beams: 121
  interlaced: false
  max_range: 30
  no_return: 31
  pause: 0.7
  speed: 0.4
  turn_rate_deg: -10
noise:
  range_sigma: 0.01
  range_step: 0.02
  angle_sigma_deg: 0.1
  beam_divergence_deg: 0.3
  rays_per_beam: 9
  mixing_distance: 0.25
  drop_out: 0.01
  dark_signal: 0.03
recording: {views: 4, distance: 2.5, heights: [1, 0.5]}
room: {min: [-1, -2, 0], max: [3, 4, 2.5], reflectivity: 0.8, ceiling: false}
objects:
  - name: thing
    class: thing
    symmetry: yaw2
    position: [1, 2, 3]
    yaw_deg: 90
    parts:
      - {box: {size: [1, 2, 3]}, position: [0, 0, 1], pitch_deg: 90, reflectivity: 0.2}
      - {cylinder: {radius: 0.1, height: 0.5}}
      - {cone: {bottom_radius: 0.2, top_radius: 0, height: 0.5}}
      - {sphere: {radius: 0.3}}
      - {rectangle: {size: [0.5, 0.6]}, roll_deg: 10}
)");
  ASSERT_TRUE(result.scene) << result.error;
  const Scene& scene = *result.scene;
  EXPECT_EQ(scene.name, "hall");
  EXPECT_EQ(scene.seed, 42u);
  EXPECT_EQ(scene.start_utime, 1234567);
  EXPECT_EQ(scene.sensor.position, Eigen::Vector3d(1, 2, 0.9));
  EXPECT_DOUBLE_EQ(scene.sensor.yaw, 90 * kDegree);
  EXPECT_DOUBLE_EQ(scene.sensor.tilt_start, 45 * kDegree);
  EXPECT_DOUBLE_EQ(scene.sensor.tilt_end, -45 * kDegree);
  EXPECT_DOUBLE_EQ(scene.sensor.tilt_step, 0.5 * kDegree);
  EXPECT_EQ(scene.sensor.line_period, 0.02);
  EXPECT_DOUBLE_EQ(scene.sensor.first_angle, -60 * kDegree);
  EXPECT_DOUBLE_EQ(scene.sensor.angle_step, 1 * kDegree);
  EXPECT_EQ(scene.sensor.num_beams, 121);
  EXPECT_FALSE(scene.sensor.interlaced);
  EXPECT_EQ(scene.sensor.max_range, 30);
  EXPECT_EQ(scene.sensor.no_return, 31);
  EXPECT_EQ(scene.sensor.pause, 0.7);
  EXPECT_EQ(scene.sensor.speed, 0.4);
  EXPECT_DOUBLE_EQ(scene.sensor.turn_rate, -10 * kDegree);
  EXPECT_EQ(scene.noise.range_sigma, 0.01);
  EXPECT_EQ(scene.noise.range_step, 0.02);
  EXPECT_DOUBLE_EQ(scene.noise.angle_sigma, 0.1 * kDegree);
  EXPECT_DOUBLE_EQ(scene.noise.beam_divergence, 0.3 * kDegree);
  EXPECT_EQ(scene.noise.rays_per_beam, 9);
  EXPECT_EQ(scene.noise.mixing_distance, 0.25);
  EXPECT_EQ(scene.noise.drop_out, 0.01);
  EXPECT_EQ(scene.noise.dark_signal, 0.03);
  EXPECT_EQ(scene.recording.num_views, 4);
  EXPECT_EQ(scene.recording.distance, 2.5);
  EXPECT_EQ(scene.recording.heights, (std::vector<double>{1, 0.5}));
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.objects[0].parts.size(), 5u);  // floor and four walls
  EXPECT_EQ(scene.objects[0].parts[0].reflectivity, 0.8);
  const Eigen::AlignedBox3d room = BoundingBox(scene.objects[0]);
  EXPECT_LT((room.min() - Eigen::Vector3d(-1, -2, 0)).norm(), 1e-12);
  EXPECT_LT((room.max() - Eigen::Vector3d(3, 4, 2.5)).norm(), 1e-12);
  const SceneObject& thing = scene.objects[1];
  EXPECT_EQ(thing.class_name, "thing");
  EXPECT_EQ(thing.symmetry, "yaw2");
  ASSERT_EQ(thing.parts.size(), 5u);
  EXPECT_EQ(thing.parts[0].reflectivity, 0.2);
  EXPECT_TRUE(std::holds_alternative<BoxShape>(thing.parts[0].shape));
  EXPECT_EQ(std::get<FrustumShape>(thing.parts[1].shape).top_radius, 0.1);
  EXPECT_EQ(std::get<FrustumShape>(thing.parts[2].shape).top_radius, 0.0);
  EXPECT_EQ(std::get<SphereShape>(thing.parts[3].shape).radius, 0.3);
  EXPECT_EQ(std::get<RectangleShape>(thing.parts[4].shape).size, Eigen::Vector2d(0.5, 0.6));
  // Pitch 90 degrees turns the part's z to the object's x.
  const Eigen::Vector3d up = thing.parts[0].T_object_part.linear().col(2);
  EXPECT_LT((up - Eigen::Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_LT((thing.T_scene_object * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(1, 3, 3)).norm(),
            1e-12);
}

TEST(SceneFileTest, ShapesAreSharedAndIncluded) {
  const TemporaryFolder folder;
  folder.Write("shapes.yaml", R"(
noise: {range_sigma: 0.5}
sensor: {num_beams: 50, pause: 2}
shapes:
  crate: {class: crate, symmetry: yaw4, box: {size: [1, 1, 1]}}
)");
  const SceneResult result = ReadScene(folder.Write("scene.yaml", R"(
include: [shapes.yaml]
sensor: {pause: 3}
shapes:
  ball: {sphere: {radius: 1}}
objects:
  - {shape: crate, position: [1, 0, 0]}
  - {shape: crate, class: "", reflectivity: 0.1}
  - {shape: ball}
)"));
  ASSERT_TRUE(result.scene) << result.error;
  ASSERT_EQ(result.scene->objects.size(), 3u);
  EXPECT_EQ(result.scene->objects[0].class_name, "crate");
  EXPECT_EQ(result.scene->objects[0].symmetry, "yaw4");
  EXPECT_EQ(result.scene->objects[1].class_name, "");
  EXPECT_EQ(result.scene->objects[1].parts[0].reflectivity, 0.1);
  EXPECT_EQ(result.scene->noise.range_sigma, 0.5);
  EXPECT_EQ(result.scene->sensor.num_beams, 50);
  EXPECT_EQ(result.scene->sensor.pause, 3);  // the scene's own word counts
}

TEST(SceneFileTest, MeshesStandOnTheirOriginWithZUp) {
  const TemporaryFolder folder;
  folder.Write("wedge.obj", R"(
v 10 5 10
v 12 5 10
v 10 8 10
v 10 5 14
f 1 2 3
f 1 2 4
)");
  const SceneResult result = ReadScene(folder.Write("scene.yaml", R"(
objects:
  - {mesh: {file: wedge.obj, up: y, scale: [0.1, 0.1, 0.1]}}
  - {mesh: {file: wedge.obj, keep_origin: true}}
)"));
  ASSERT_TRUE(result.scene) << result.error;
  const Eigen::AlignedBox3d turned = BoundingBox(result.scene->objects[0]);
  EXPECT_LT((turned.min() - Eigen::Vector3d(-0.1, -0.2, 0)).norm(), 1e-6);
  EXPECT_LT((turned.max() - Eigen::Vector3d(0.1, 0.2, 0.3)).norm(), 1e-6);
  const Eigen::AlignedBox3d kept = BoundingBox(result.scene->objects[1]);
  EXPECT_LT((kept.min() - Eigen::Vector3d(10, 5, 10)).norm(), 1e-5);
}

TEST(SceneFileTest, UnknownKeysAreNamedWithFileAndLine) {
  EXPECT_EQ(ErrorOf("objects: []\nobjcts: 1\n").substr(0, 39),
            "scene.yaml:2: objcts: unknown key; know");
  EXPECT_NE(ErrorOf("sensor: {hight: 1}").find("scene.yaml:1: sensor.hight: unknown key"),
            std::string::npos);
  EXPECT_NE(
      ErrorOf("objects:\n  - {box: {size: [1, 1, 1]}}\n  - {box: {size: [1, 1, 1]}, colour: 1}")
          .find("scene.yaml:3: objects[1].colour: unknown key"),
      std::string::npos);
  EXPECT_NE(ErrorOf("objects: [{box: {size: [1, 1, 1], radius: 1}}]").find("objects[0].box.radius"),
            std::string::npos);
}

TEST(SceneFileTest, WrongValuesAreNamed) {
  EXPECT_NE(ErrorOf("seed: x").find("seed: must be a whole number, is 'x'"), std::string::npos);
  EXPECT_NE(ErrorOf("sensor: {num_beams: 0}").find("sensor.num_beams: is 0, must be 2 .. 16384"),
            std::string::npos);
  EXPECT_NE(ErrorOf("sensor: {max_range: .nan}").find("sensor.max_range: is nan"),
            std::string::npos);
  EXPECT_NE(ErrorOf("sensor: {max_range: 1e999}").find("sensor.max_range"), std::string::npos);
  EXPECT_NE(ErrorOf("sensor: {position: [1, 2]}").find("must be a list of 3 numbers"),
            std::string::npos);
  EXPECT_NE(ErrorOf("sensor: {interlaced: maybe}").find("must be true or false"),
            std::string::npos);
  EXPECT_NE(ErrorOf("sensor: [1]").find("sensor: must be a map"), std::string::npos);
  EXPECT_NE(ErrorOf("sensor: {no_return: 5}").find("must not be below max_range"),
            std::string::npos);
  EXPECT_NE(ErrorOf("sensor: {tilt_step_deg: 0.001}").find("more than 20000 lines"),
            std::string::npos);
  EXPECT_NE(ErrorOf("sensor: {num_beams: 1000}").find("longer than a turn"), std::string::npos);
  EXPECT_NE(ErrorOf("sensor: {pause: 1, pause: 2}").find("sensor.pause: stands there twice"),
            std::string::npos);
  EXPECT_NE(ErrorOf("room: {min: [0, 0, 0], max: [1, 0, 1]}").find("room.max: must be above"),
            std::string::npos);
  EXPECT_NE(ErrorOf("room: {min: [0, 0, 0]}").find("room: lacks the key max"), std::string::npos);
}

TEST(SceneFileTest, WrongObjectsAreNamed) {
  EXPECT_NE(ErrorOf("objects: [{position: [1, 2, 3]}]").find("objects[0]: needs one of box"),
            std::string::npos);
  EXPECT_NE(ErrorOf("objects: [{shape: chair}]").find("there is no shape 'chair'"),
            std::string::npos);
  EXPECT_NE(ErrorOf("objects: [{sphere: {radius: 1}, parts: []}]").find("one shape only"),
            std::string::npos);
  EXPECT_NE(ErrorOf("objects: [{parts: []}]").find("objects[0].parts: is empty"),
            std::string::npos);
  EXPECT_NE(ErrorOf("objects: [{parts: [{parts: []}]}]").find("objects[0].parts[0].parts"),
            std::string::npos);
  EXPECT_NE(ErrorOf("objects: [{sphere: {radius: -1}}]").find("objects[0].sphere.radius: is -1"),
            std::string::npos);
  EXPECT_NE(ErrorOf("objects: [{sphere: {}}]").find("objects[0].sphere: lacks the key radius"),
            std::string::npos);
  EXPECT_NE(ErrorOf("objects: [{sphere: 1}]").find("objects[0].sphere: must be a map"),
            std::string::npos);
  EXPECT_NE(ErrorOf("objects: [{sphere: {radius: 1}, class: ../x}]").find("objects[0].class"),
            std::string::npos);
  EXPECT_NE(
      ErrorOf("objects: [{sphere: {radius: 1}, symmetry: round}]").find("must be one of none"),
      std::string::npos);
  EXPECT_NE(ErrorOf("objects: [{cone: {bottom_radius: 0, top_radius: 0, height: 1}}]")
                .find("one of the radii"),
            std::string::npos);
  EXPECT_NE(ErrorOf("objects: [{mesh: {file: nowhere.obj}}]").find("nowhere.obj"),
            std::string::npos);
  EXPECT_NE(ErrorOf("objects: [{mesh: {file: scene.yaml}}]").find("objects[0].mesh.file"),
            std::string::npos);
  EXPECT_NE(ErrorOf("shapes: {a: {sphere: {radius: 1}}}\ninclude: [scene.yaml]").find("scene.yaml"),
            std::string::npos);
}

TEST(SceneFileTest, BrokenFilesAreNamed) {
  EXPECT_NE(ErrorOf("objects: [").find("scene.yaml:"), std::string::npos);
  EXPECT_NE(ErrorOf("").find("scene.yaml:1: the file: must be a map"), std::string::npos);
  EXPECT_NE(ErrorOf("seed: 1").find("has neither a room nor objects"), std::string::npos);
  EXPECT_NE(ErrorOf(std::string(5000, '[')).find("scene.yaml"), std::string::npos);
  EXPECT_NE(ErrorOf(std::string("a\0b", 3)).find("scene.yaml"), std::string::npos);
  EXPECT_NE(ErrorOf("include: [missing.yaml]").find("missing.yaml"), std::string::npos);
  const TemporaryFolder folder;
  EXPECT_NE(ReadScene(folder.PathOf("nothing.yaml")).error.find("nothing.yaml"), std::string::npos);
  EXPECT_NE(ReadScene(folder.path()).error.find(folder.path()), std::string::npos);
}

TEST(SceneFileTest, TheSceneIsNamedAfterItsFile) {
  const SceneResult result = ReadText("room: {min: [0, 0, 0], max: [1, 1, 1]}");
  ASSERT_TRUE(result.scene) << result.error;
  EXPECT_EQ(result.scene->name, "scene");
}

TEST(SceneFileTest, TheScenesThatComeWithTheProjectAreRead) {
  const std::filesystem::path folder = std::filesystem::path(RIMOD_SOURCE_DIR) / "config/scenes";
  int num_scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name == "sick_lms.yaml" || name == "furniture.yaml") continue;  // for others to include
    const SceneResult result = ReadScene(entry.path().string());
    EXPECT_TRUE(result.scene) << result.error;
    ++num_scenes;
  }
  EXPECT_GE(num_scenes, 7);
}

}  // namespace
}  // namespace rimod::simulation
