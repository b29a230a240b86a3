#include "scanner_proc/simulated_sweeps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/event_log.h"
#include "io/laser_messages.h"
#include "io/message_codec.h"
#include "io/point_cloud_file.h"
#include "io/recording.h"
#include "io/scan_source.h"
#include "scanner_proc/ground_truth.h"
#include "scanner_proc/laser_scanner.h"
#include "tests/support/temporary_folder.h"

namespace rimod::simulation {
namespace {

constexpr double kDegree = M_PI / 180.0;

SceneObject MakeObject(const std::string& class_name, Shape shape,
                       const Eigen::Vector3d& position) {
  Part part;
  part.shape = std::move(shape);
  SceneObject object;
  object.class_name = class_name;
  object.T_scene_object.translation() = position;
  object.parts.push_back(std::move(part));
  return object;
}

// A hall of 8 x 8 m with a crate at 2 m; a coarse scanner, so that tests are quick.
Scene MakeScene() {
  Scene scene;
  scene.name = "hall";
  scene.sensor.tilt_step = 1.0 * kDegree;
  scene.sensor.angle_step = 1.0 * kDegree;
  scene.sensor.num_beams = 181;
  scene.objects.push_back(MakeObject("", BoxShape{{8, 8, 4}}, {0, 0, 0}));
  scene.objects.push_back(MakeObject("crate", BoxShape{{0.5, 0.5, 0.5}}, {2, 0, 0}));
  return scene;
}

Noise MakeNoise() {
  Noise noise;
  noise.range_sigma = 0.01;
  noise.range_step = 0.01;
  noise.angle_sigma = 0.001;
  noise.beam_divergence = 0.005;
  noise.rays_per_beam = 5;
  noise.mixing_distance = 0.3;
  noise.drop_out = 0.01;
  noise.dark_signal = 0.02;
  return noise;
}

const std::atomic<bool> kGoOn{false};
const std::atomic<bool> kStop{true};

SweepFilesResult Write(const Scene& scene, int num_sweeps, const SweepFiles& files,
                       const std::atomic<bool>& stop = kGoOn) {
  return WriteSweeps(scene, num_sweeps, Channels(), SweepParamsFor(scene.sensor, SweepParams()),
                     files, stop);
}

TEST(SimulatedSweepsTest, LogAssembledAgainGivesThePointsThatTheBeamsHit) {
  const TemporaryFolder folder;
  const Scene scene = MakeScene();
  const std::string log = folder.PathOf("hall.lcm");
  const SweepFilesResult result = Write(scene, 1, {log, "", ""});
  EXPECT_TRUE(result.errors.empty());
  EXPECT_EQ(result.num_lines, 91);
  std::vector<NamedScan> scans;
  const ScanSourceReport report =
      ReadScans(log, SweepParamsFor(scene.sensor, SweepParams()),
                [&](NamedScan scan) { scans.push_back(std::move(scan)); });
  EXPECT_TRUE(report.errors.empty());
  ASSERT_EQ(scans.size(), 1u);
  EXPECT_EQ(scans[0].name, "hall");
  EXPECT_EQ(scans[0].utime, scene.start_utime);

  const RayCaster caster(scene.objects);
  const LaserScanner scanner(scene.sensor, scene.noise, caster, scene.seed, scene.start_utime);
  std::size_t next = 0;
  const std::vector<Eigen::Vector3f>& points = scans[0].scan.points;
  for (int line = 0; line < scanner.num_lines(); ++line) {
    for (const Beam& beam : scanner.Scan(line).beams) {
      const double range = caster.Cast(beam.ray, 80.0)->range;
      const Eigen::Vector3d expected = beam.ray.origin + range * beam.ray.direction;
      ASSERT_LT(next, points.size());
      ASSERT_LT((points[next++].cast<double>() - expected).norm(), 5e-6);
    }
  }
  EXPECT_EQ(next, points.size());
}

TEST(SimulatedSweepsTest, EqualScenesGiveEqualBytes) {
  const TemporaryFolder folder;
  Scene scene = MakeScene();
  scene.noise = MakeNoise();
  const auto write = [&](const std::string& name) {
    EXPECT_TRUE(Write(scene, 1, {folder.PathOf(name + ".lcm"), folder.PathOf(name + ".pcd"), ""})
                    .errors.empty());
  };
  write("a");
  write("b");
  scene.seed = 2;
  write("c");
  EXPECT_GT(folder.Read("a.lcm").size(), 60000u);
  EXPECT_EQ(folder.Read("a.lcm"), folder.Read("b.lcm"));
  EXPECT_EQ(folder.Read("a.pcd"), folder.Read("b.pcd"));
  EXPECT_NE(folder.Read("a.lcm"), folder.Read("c.lcm"));
}

TEST(SimulatedSweepsTest, LogHoldsAPoseBeforeEachLineAndOneAfterTheLast) {
  const TemporaryFolder folder;
  Write(MakeScene(), 1, {folder.PathOf("log"), "", ""});
  EventLogReader reader(folder.PathOf("log"));
  std::int64_t number = 0;
  while (const std::optional<LogEvent> event = reader.Next()) {
    EXPECT_EQ(event->channel, number % 2 == 0 ? "LASER_TO_LOCAL" : "LASER");
    if (number % 2 == 0) {
      const auto message =
          DecodeMessage<bot_core::rigid_transform_t>(event->bytes.data(), event->bytes.size());
      ASSERT_TRUE(message.message) << message.error;
      EXPECT_EQ(message.message->utime, event->utime);
    }
    EXPECT_EQ(event->number, number++);
  }
  EXPECT_EQ(number, 2 * 91 + 1);
  EXPECT_TRUE(reader.error().empty());
}

TEST(SimulatedSweepsTest, PcdEqualsTheScanOfTheLog) {
  const TemporaryFolder folder;
  Scene scene = MakeScene();
  scene.sensor.position = {0.5, -0.25, 1.2};
  scene.sensor.yaw = 20 * kDegree;
  Write(scene, 1, {folder.PathOf("hall.lcm"), folder.PathOf("hall.pcd"), ""});
  const PointCloudResult cloud = ReadPointCloud(folder.PathOf("hall.pcd"));
  ASSERT_TRUE(cloud.scan) << cloud.error;
  std::vector<NamedScan> scans;
  ReadScans(folder.PathOf("hall.lcm"), SweepParamsFor(scene.sensor, SweepParams()),
            [&](NamedScan scan) { scans.push_back(std::move(scan)); });
  ASSERT_EQ(scans.size(), 1u);
  EXPECT_EQ(cloud.scan->points, scans[0].scan.points);
  const Eigen::Isometry3d& T = cloud.scan->T_local_sensor;
  EXPECT_LT((T.translation() - scene.sensor.position).norm(), 1e-9);
  const Eigen::Vector3d forward = T.linear().col(0);
  EXPECT_NEAR(std::atan2(forward.y(), forward.x()), 20 * kDegree, 1e-9);
}

TEST(SimulatedSweepsTest, SeveralSweepsAreNamedAsTheLogsReaderNamesThem) {
  const TemporaryFolder folder;
  Write(MakeScene(), 3, {folder.PathOf("x.lcm"), folder.PathOf("y.pcd"), folder.PathOf("z.json")});
  EXPECT_EQ(folder.Names(),
            (std::vector<std::string>{"x.lcm", "y#0.pcd", "y#1.pcd", "y#2.pcd", "z.json"}));
  std::vector<std::string> names;
  ReadScans(folder.PathOf("x.lcm"), SweepParamsFor(MakeScene().sensor, SweepParams()),
            [&](NamedScan scan) { names.push_back(scan.name); });
  const auto truth = nlohmann::json::parse(folder.Read("z.json"));
  ASSERT_EQ(truth["scans"].size(), 3u);
  ASSERT_EQ(names.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(truth["scans"][i]["scan"], names[i]);
}

TEST(SimulatedSweepsTest, TruthTellsClassPosePointsVisibilityAndDistance) {
  const TemporaryFolder folder;
  Scene scene = MakeScene();
  // A board hides the right half of a second crate; a third one is behind a wall.
  scene.objects.push_back(MakeObject("crate", BoxShape{{0.5, 0.5, 0.5}}, {1.5, 3, 0}));
  scene.objects.push_back(MakeObject("", BoxShape{{2, 0.02, 2}}, {1.75, 1.5, 0}));
  scene.objects.push_back(MakeObject("hidden", BoxShape{{0.5, 0.5, 0.5}}, {9, 0, 0}));
  scene.objects[1].T_scene_object.rotate(Eigen::AngleAxisd(30 * kDegree, Eigen::Vector3d::UnitZ()));
  Write(scene, 1, {"", "", folder.PathOf("truth.json")});
  const auto truth = nlohmann::json::parse(folder.Read("truth.json"));
  ASSERT_EQ(truth["scans"].size(), 1u);
  EXPECT_EQ(truth["scans"][0]["scan"], "hall");
  const auto& objects = truth["scans"][0]["objects"];
  ASSERT_EQ(objects.size(), 3u);
  EXPECT_EQ(objects[0]["class"], "crate");
  const std::vector<double> pose = objects[0]["pose"];
  const std::vector<double> expected = {
      2, 0, 0, std::cos(15 * kDegree), 0, 0, std::sin(15 * kDegree)};
  ASSERT_EQ(pose.size(), 7u);
  for (int i = 0; i < 7; ++i) EXPECT_NEAR(pose[i], expected[i], 1e-6);
  EXPECT_EQ(objects[0]["visible"], 1.0);
  EXPECT_EQ(objects[0]["distance"], 2.0);
  EXPECT_GT(objects[1]["visible"], 0.3);
  EXPECT_LT(objects[1]["visible"], 0.7);
  EXPECT_EQ(objects[2]["visible"], 0.0);
  EXPECT_EQ(objects[2]["points"], 0);

  // The points told are those of the cloud that lie on the crate.
  Write(scene, 1, {"", folder.PathOf("hall.pcd"), ""});
  const PointCloudResult cloud = ReadPointCloud(folder.PathOf("hall.pcd"));
  const Eigen::Isometry3d T_object_scene = scene.objects[1].T_scene_object.inverse();
  int num_points = 0;
  for (const Eigen::Vector3f& point : cloud.scan->points) {
    const Eigen::Vector3d p_object = T_object_scene * point.cast<double>();
    const bool on_crate = p_object.head<2>().cwiseAbs().maxCoeff() < 0.2501 &&
                          p_object.z() > 1e-4 && p_object.z() < 0.5001;
    num_points += on_crate ? 1 : 0;
  }
  EXPECT_NEAR(num_points, objects[0]["points"].get<int>(), 2);
  EXPECT_GT(num_points, 100);
}

TEST(SimulatedSweepsTest, StoppedRunLeavesNothingHalfWritten) {
  const TemporaryFolder folder;
  const SweepFilesResult result =
      Write(MakeScene(), 1,
            {folder.PathOf("a.lcm"), folder.PathOf("a.pcd"), folder.PathOf("a.json")}, kStop);
  EXPECT_TRUE(result.stopped);
  EXPECT_TRUE(folder.Names().empty());
}

TEST(SimulatedSweepsTest, FilesThatCannotBeWrittenAreNamed) {
  const TemporaryFolder folder;
  const std::string nowhere = folder.PathOf("missing/x");
  const SweepFilesResult result = Write(MakeScene(), 1, {nowhere, nowhere, nowhere});
  ASSERT_EQ(result.errors.size(), 3u);
  for (const std::string& error : result.errors) EXPECT_NE(error.find(nowhere), std::string::npos);
}

TEST(SimulatedSweepsTest, AShortSweepOfASmallTurnIsStillAScan) {
  const TemporaryFolder folder;
  Scene scene = MakeScene();
  scene.sensor.tilt_start = 0.0;
  scene.sensor.tilt_end = 5 * kDegree;
  const SweepFilesResult result = Write(scene, 2, {"", folder.PathOf("a.pcd"), ""});
  EXPECT_TRUE(result.errors.empty()) << result.errors[0];
  EXPECT_EQ(folder.Names(), (std::vector<std::string>{"a#0.pcd", "a#1.pcd"}));
}

TEST(SimulatedSweepsTest, ACarrierInMotionGivesTheSamePoints) {
  const TemporaryFolder folder;
  Scene scene = MakeScene();
  scene.sensor.speed = 0.3;
  scene.sensor.turn_rate = 10 * kDegree;
  scene.objects.pop_back();
  Write(scene, 1, {"", folder.PathOf("a.pcd"), ""});
  const PointCloudResult cloud = ReadPointCloud(folder.PathOf("a.pcd"));
  ASSERT_TRUE(cloud.scan) << cloud.error;
  EXPECT_GT(cloud.scan->points.size(), 10000u);
  for (const Eigen::Vector3f& point : cloud.scan->points) {
    // On one of the hall's faces.
    const double off_wall = std::abs(point.head<2>().cwiseAbs().maxCoeff() - 4.0f);
    const double off =
        std::min<double>({off_wall, std::abs(point.z()), std::abs(point.z() - 4.0f)});
    ASSERT_LT(off, 2e-4);
  }
}

TEST(RecordingTest, SensorsStandRoundTheObjectAndLookAtIt) {
  Scene scene = MakeScene();
  scene.objects[1].T_scene_object.translation() = Eigen::Vector3d(1, 2, 0);
  scene.recording.num_views = 6;
  scene.recording.distance = 1.5;
  scene.recording.heights = {1.0, 0.5};
  const std::vector<Sensor> sensors = RecordingSensors(scene, scene.objects[1]);
  ASSERT_EQ(sensors.size(), 6u);
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const Eigen::Vector2d to_object = Eigen::Vector2d(1, 2) - sensors[i].position.head<2>();
    EXPECT_NEAR(to_object.norm(), 1.5, 1e-9);
    EXPECT_NEAR(std::remainder(std::atan2(to_object.y(), to_object.x()) - sensors[i].yaw, 2 * M_PI),
                0.0, 1e-9);
    EXPECT_EQ(sensors[i].position.z(), i % 2 == 0 ? 1.0 : 0.5);
  }
}

TEST(RecordingTest, WrittenRecordingIsReadBack) {
  const TemporaryFolder folder;
  Scene scene = MakeScene();
  scene.objects[1].symmetry = "yaw4";
  scene.recording.num_views = 3;
  const std::string path = folder.PathOf("deep/crate");
  EXPECT_EQ(WriteRecording(scene, SweepParamsFor(scene.sensor, SweepParams()), path, kGoOn), "");
  const RecordingResult result = ReadRecording(path);
  ASSERT_TRUE(result.recording) << result.error;
  const Recording& recording = *result.recording;
  EXPECT_EQ(recording.class_name, "crate");
  EXPECT_LT((recording.T_local_object.translation() - Eigen::Vector3d(2, 0, 0)).norm(), 1e-9);
  EXPECT_LT((recording.box_min - Eigen::Vector3d(-0.25, -0.25, 0)).norm(), 1e-9);
  EXPECT_LT((recording.box_max - Eigen::Vector3d(0.25, 0.25, 0.5)).norm(), 1e-9);
  ASSERT_EQ(recording.scans.size(), 3u);
  for (const Scan& scan : recording.scans) {
    const Eigen::Vector3d towards =
        recording.T_local_object.translation() - scan.T_local_sensor.translation();
    EXPECT_NEAR(towards.head<2>().norm(), 2.0, 1e-6);
    EXPECT_GT(scan.T_local_sensor.linear().col(0).dot(towards.normalized()), 0.8);
    int on_crate = 0;
    for (const Eigen::Vector3f& point : scan.points) {
      const Eigen::Vector3d p = point.cast<double>() - Eigen::Vector3d(2, 0, 0.25);
      on_crate += p.cwiseAbs().maxCoeff() < 0.2501 && p.z() > -0.249 ? 1 : 0;
    }
    EXPECT_GT(on_crate, 50);
  }
  EXPECT_EQ(nlohmann::json::parse(folder.Read("deep/crate/model.json"))["symmetry"], "yaw4");
}

TEST(RecordingTest, NeedsExactlyOneObjectOfAClass) {
  const TemporaryFolder folder;
  Scene scene = MakeScene();
  const SweepParams params = SweepParamsFor(scene.sensor, SweepParams());
  scene.objects.push_back(scene.objects[1]);
  EXPECT_NE(WriteRecording(scene, params, folder.PathOf("a"), kGoOn), "");
  scene.objects.resize(1);
  EXPECT_NE(WriteRecording(scene, params, folder.PathOf("a"), kGoOn), "");
  EXPECT_TRUE(folder.Names().empty());
}

TEST(RecordingTest, StoppedRecordingHasNoModelFile) {
  const TemporaryFolder folder;
  const Scene scene = MakeScene();
  EXPECT_NE(
      WriteRecording(scene, SweepParamsFor(scene.sensor, SweepParams()), folder.PathOf("a"), kStop),
      "");
  EXPECT_EQ(folder.Read("a/model.json"), "");
}

}  // namespace
}  // namespace rimod::simulation
