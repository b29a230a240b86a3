// Every process against messages that are wrong in every way, on every channel that it reads: it
// counts them, lives on and then does its work as if nothing had been.

#include <gtest/gtest.h>

#include <csignal>
#include <limits>
#include <memory>

#include "io/config.h"
#include "io/model_messages.h"
#include "rimod/detector.h"
#include "tests/support/bus_probe.h"
#include "tests/support/child_process.h"
#include "tests/support/sample_messages.h"
#include "tests/support/surfel_models.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tilting_laser.h"

namespace rimod {
namespace {

using std::chrono::milliseconds;
using Bytes = std::vector<std::uint8_t>;

constexpr milliseconds kLong(20000);

class HostileMessagesTest : public ::testing::Test {
 protected:
  void Start(const std::string& executable, const std::vector<std::string>& more = {}) {
    executable_ = executable;
    const std::string config = folder_.Write(
        "quick.yaml", "bus:\n  idle_time: 0.3\n  join_patience: 0.5\n  max_waiting_scans: 100\n");
    std::vector<std::string> words = {std::string(RIMOD_BIN_DIR) + "/" + executable, "--config",
                                      config};
    words.insert(words.end(), more.begin(), more.end());
    process_ = std::make_unique<ChildProcess>(words, folder_.PathOf("output"));
    ASSERT_TRUE(bus_.ListenUntil([this] { return Status().has_value(); }, kLong))
        << process_->Output();
  }

  std::optional<status_t> Status() { return bus_.Status(executable_); }

  void Send(const std::string& channel, const Bytes& bytes) {
    bus_.Publish(channel, bytes);
    ++num_sent_;
    bus_.Listen(milliseconds(num_sent_ % 8 == 0 ? 1 : 0));
  }

  // Everything that can be wrong with the bytes of a message.
  template <typename Message>
  void SendWrongBytes(const std::string& channel) {
    const Bytes good = EncodeMessage(SampleMessage<Message>());
    Send(channel, {});
    Send(channel, {0});
    Send(channel, Bytes(3000000, 0xff));
    for (std::size_t size = 1; size < good.size(); size += 7) {
      Send(channel, Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)));
    }
    Bytes bytes = good;
    bytes[0] ^= 1;  // the fingerprint
    Send(channel, bytes);
    bytes = good;
    bytes.push_back(0);
    Send(channel, bytes);
    // Wherever the counts are, they become negative, huge and wrong.
    for (std::size_t position = 8; position + 4 <= good.size(); position += 4) {
      for (const int first : {0xff, 0x7f, 0x00}) {
        bytes = good;
        bytes[position] = static_cast<std::uint8_t>(first);
        bytes[position + 2] ^= 0x10;
        bytes[position + 3] ^= 0x05;
        Send(channel, bytes);
      }
    }
  }

  // Waits until the process has counted all that was sent, and some of it as bad.
  void ExpectAliveAndCounting(std::int64_t min_rejected) {
    EXPECT_TRUE(bus_.ListenUntil([this] { return Status()->num_in >= num_sent_; }, kLong))
        << "received " << Status()->num_in << " of " << num_sent_;
    bus_.Listen(milliseconds(1500));  // for the next status, and for idle times to pass
    EXPECT_GE(Status()->num_rejected, min_rejected);
    EXPECT_FALSE(Status()->last_error.empty());
    ASSERT_TRUE(process_->running()) << process_->Output();
    // Each kind is logged once.
    const std::string output = process_->Output();
    EXPECT_LT(std::count(output.begin(), output.end(), '\n'), 200) << output;
    bus_.Forget();
  }

  // Waits for that many messages of a scan on a channel and compares them.
  void ExpectReceived(const std::string& channel, std::int64_t utime,
                      const std::vector<std::string>& sums) {
    bus_.ListenUntil([&] { return bus_.Sums(channel, utime).size() >= sums.size(); }, kLong);
    EXPECT_EQ(bus_.Sums(channel, utime), sums) << channel << "\n" << process_->Output();
  }

  void ExpectStopsCleanly() {
    process_->Signal(SIGTERM);
    EXPECT_EQ(process_->Wait(milliseconds(1000)), 0) << process_->Output();
  }

  TemporaryFolder folder_;
  BusProbe bus_;
  std::string executable_;
  std::unique_ptr<ChildProcess> process_;
  std::int64_t num_sent_ = 0;
};

// What a scan of the small room gives, computed here.
struct Expected {
  explicit Expected(std::int64_t utime)
      : params(DefaultConfiguration(Method::kDefault).pipeline),
        laser(TiltInFrontOf(SmallRoom(), Time(utime), 60)) {
    const std::vector<Sweep> sweeps = Assemble(laser, params.sweep);
    EXPECT_EQ(sweeps.size(), 1u);
    EXPECT_TRUE(sweeps.at(0).complete()) << sweeps.at(0).incomplete_reason;
    scan = {sweeps[0].begin.count(), sweeps[0].end.count(), sweeps[0].num_lines,
            sweeps[0].num_missing_lines, sweeps[0].scan};
    image = ComputeRangeImage(scan.scan, params, Execution());
    features = ExtractFeatures(image, params, Execution());
    EXPECT_GT(image.CountMeasured(), 1000);
  }
  PipelineParams params;
  TiltingLaser laser;
  StampedScan scan;
  RangeImage image;
  FeatureSet features;
};

TEST_F(HostileMessagesTest, Assembler) {
  Start("rimod-assembler");
  SendWrongBytes<bot_core::planar_lidar_t>("LASER");
  SendWrongBytes<bot_core::rigid_transform_t>("LASER_TO_LOCAL");

  const Expected expected(1'000'000'000);
  bot_core::planar_lidar_t line = expected.laser.lines[0];
  line.rad0 = std::numeric_limits<float>::quiet_NaN();
  Send("LASER", EncodeMessage(line));
  for (float& range : line.ranges) range = std::numeric_limits<float>::quiet_NaN();
  line.rad0 = 0.0f;
  Send("LASER", EncodeMessage(line));
  for (const std::int64_t utime : {INT64_MIN, INT64_MAX, std::int64_t{0}, std::int64_t{-1}}) {
    line.utime = utime;
    Send("LASER", EncodeMessage(line));
    bot_core::rigid_transform_t pose = expected.laser.poses[0];
    pose.utime = utime;
    Send("LASER_TO_LOCAL", EncodeMessage(pose));
    pose.quat[0] = std::numeric_limits<double>::quiet_NaN();
    Send("LASER_TO_LOCAL", EncodeMessage(pose));
  }
  ExpectAliveAndCounting(40);

  for (const bot_core::rigid_transform_t& pose : expected.laser.poses) {
    bus_.Publish("LASER_TO_LOCAL", pose);
  }
  for (const bot_core::planar_lidar_t& laser_line : expected.laser.lines) {
    bus_.Publish("LASER", laser_line);
    bus_.Listen(milliseconds(1));
  }
  ExpectReceived("RIMOD_SCAN", expected.scan.utime, SumsOf(ToSections(expected.scan)));
  ExpectStopsCleanly();
}

TEST_F(HostileMessagesTest, Extractor) {
  Start("rimod-extractor");
  SendWrongBytes<scan_t>("RIMOD_SCAN");

  const Expected expected(1'000'000'000);
  const std::vector<scan_t> sections = ToSections(expected.scan);
  scan_t bad = sections[0];
  bad.num_sections = 1;
  bad.x[3] = std::numeric_limits<float>::quiet_NaN();
  Send("RIMOD_SCAN", EncodeMessage(bad));
  bad = sections[0];
  bad.num_sections = 1;
  bad.sensor_orientation[0] = 5.0;
  Send("RIMOD_SCAN", EncodeMessage(bad));
  bad = sections[0];
  bad.num_sections = 1;
  for (float& x : bad.x) x = 3e38f;
  for (float& y : bad.y) y = -3e38f;
  Send("RIMOD_SCAN", EncodeMessage(bad));
  bad.num_sections = INT32_MAX;
  Send("RIMOD_SCAN", EncodeMessage(bad));
  bad.section = -1;
  Send("RIMOD_SCAN", EncodeMessage(bad));
  ExpectAliveAndCounting(50);

  bus_.PublishAll("RIMOD_SCAN", sections);
  const std::int64_t utime = expected.scan.utime;
  ExpectReceived("RIMOD_RANGE_IMAGE", utime, SumsOf(ToSections(expected.image, utime)));
  ExpectReceived("RIMOD_FEATURES", utime, SumsOf(ToSections(expected.features, utime)));
  ExpectStopsCleanly();
}

TEST_F(HostileMessagesTest, ExtractorOfClouds) {
  Start("rimod-extractor", {"--cloud-channel", "LIDAR", "--cloud-pose-channel", "BODY_TO_LOCAL"});
  SendWrongBytes<bot_core::pointcloud2_t>("LIDAR");
  SendWrongBytes<bot_core::rigid_transform_t>("BODY_TO_LOCAL");

  const SensorCloud cloud = {Time(1'000'000'000), RandomValues(1).AScan(3000, 0).points};
  const bot_core::pointcloud2_t good = ToMessage(cloud, "lidar");
  for (const std::int32_t number : {INT32_MIN, -1, 0, 5, INT32_MAX}) {
    for (std::int32_t bot_core::pointcloud2_t::*const field :
         {&bot_core::pointcloud2_t::height, &bot_core::pointcloud2_t::width,
          &bot_core::pointcloud2_t::point_step, &bot_core::pointcloud2_t::row_step}) {
      bot_core::pointcloud2_t bad = good;
      bad.*field = number;
      bad.utime = 500;
      Send("LIDAR", EncodeMessage(bad));
    }
    bot_core::pointcloud2_t bad = good;
    bad.fields[1].offset = number == 0 ? 1 << 20 : number;
    bad.utime = 500;
    Send("LIDAR", EncodeMessage(bad));
  }
  for (const std::int64_t utime : {INT64_MIN, INT64_MAX, std::int64_t{0}, std::int64_t{-1}}) {
    bot_core::pointcloud2_t bad = good;
    bad.utime = utime;
    for (std::uint8_t& byte : bad.data) byte = 0xff;  // not a number
    Send("LIDAR", EncodeMessage(bad));
    TimedPose pose;
    pose.time = Time(utime);
    Send("BODY_TO_LOCAL", EncodeMessage(ToMessage(pose)));
  }
  ExpectAliveAndCounting(40);

  TimedPose pose = {cloud.time, Placed(1.0, 2.0, 0.5, 0.3)};
  const bot_core::rigid_transform_t pose_message = ToMessage(pose);
  bus_.Publish("BODY_TO_LOCAL", pose_message);
  bus_.Publish("LIDAR", good);
  const PipelineParams params = DefaultConfiguration(Method::kDefault).pipeline;
  CloudPlacer placer(params.cloud, /*with_poses=*/true);
  placer.AddPose(*FromMessage(pose_message).pose);
  const std::vector<PlacedCloud> placed = placer.AddCloud(cloud);
  ASSERT_EQ(placed.size(), 1u);
  const RangeImage image = ComputeRangeImage(placed[0].scan, params, Execution());
  const FeatureSet features = ExtractFeatures(image, params, Execution());
  const std::int64_t utime = cloud.time.count();
  ExpectReceived("RIMOD_RANGE_IMAGE", utime, SumsOf(ToSections(image, utime)));
  ExpectReceived("RIMOD_FEATURES", utime, SumsOf(ToSections(features, utime)));
  ExpectStopsCleanly();
}

TEST_F(HostileMessagesTest, PartialScans) {
  Start("rimod-extractor");
  SendWrongBytes<partial_scan_t>("RIMOD_SCAN_PARTIAL");
  SendWrongBytes<partial_scan_t>("RIMOD_SCAN_AHEAD");
  SendWrongBytes<scan_end_t>("RIMOD_SCAN_END");
  const Expected expected(1'000'000'000);
  SweepGrowth growth;
  growth.sweep_begin = growth.begin = growth.end = Time(expected.scan.utime);
  growth.scan = expected.scan.scan;
  partial_scan_t bad = ToPartialSections(growth)[0];
  for (const std::int32_t step : {INT32_MIN, -1, 1, INT32_MAX}) {
    bad.step = step;
    bad.section.num_sections = 1;
    bad.section.utime = bad.section.utime_end = expected.scan.utime + step;
    Send("RIMOD_SCAN_PARTIAL", EncodeMessage(bad));
  }
  ExpectAliveAndCounting(30);
  EXPECT_TRUE(bus_.Bytes("RIMOD_RANGE_IMAGE_PARTIAL").empty());
  bus_.PublishAll("RIMOD_SCAN", ToSections(expected.scan));
  const std::int64_t utime = expected.scan.utime;
  ExpectReceived("RIMOD_FEATURES", utime, SumsOf(ToSections(expected.features, utime)));
  ExpectStopsCleanly();
}

TEST_F(HostileMessagesTest, PartialImagesAndFeatures) {
  Start("rimod-matcher");
  SendWrongBytes<partial_range_image_t>("RIMOD_RANGE_IMAGE_PARTIAL");
  SendWrongBytes<partial_feature_set_t>("RIMOD_FEATURES_PARTIAL");
  const Expected expected(1'000'000'000);
  FeatureSet foreign = expected.features;
  foreign.descriptor_kind = "of another kind";
  for (const auto& section : ToPartialSections(foreign, 5, 6)) {
    Send("RIMOD_FEATURES_PARTIAL", EncodeMessage(section));
  }
  for (const auto& section : ToPartialSections(expected.image, 5, 6)) {
    Send("RIMOD_RANGE_IMAGE_PARTIAL", EncodeMessage(section));
  }
  ExpectAliveAndCounting(30);
  EXPECT_TRUE(bus_.Bytes("RIMOD_DETECTIONS_EARLY").empty());
  ExpectStopsCleanly();
}

TEST_F(HostileMessagesTest, Matcher) {
  Start("rimod-matcher");
  SendWrongBytes<range_image_t>("RIMOD_RANGE_IMAGE");
  SendWrongBytes<feature_set_t>("RIMOD_FEATURES");
  SendWrongBytes<object_model_t>("RIMOD_MODEL");

  const Expected expected(1'000'000'000);
  const std::int64_t utime = expected.scan.utime;
  FeatureSet foreign = expected.features;
  foreign.descriptor_kind = "of another kind";
  for (const feature_set_t& section : ToSections(foreign, utime + 1)) {
    Send("RIMOD_FEATURES", EncodeMessage(section));
  }
  for (const range_image_t& section : ToSections(expected.image, utime + 1)) {
    Send("RIMOD_RANGE_IMAGE", EncodeMessage(section));
  }
  range_image_t bad = ToSections(expected.image, utime + 2)[0];
  bad.num_sections = 1;
  bad.width = bad.height = INT32_MAX;
  Send("RIMOD_RANGE_IMAGE", EncodeMessage(bad));
  ObjectModel model = BoxModel("box", {0.6, 0.5, 0.7}, 0.03);
  object_model_t bad_model = ToSections(model, 1)[0];
  bad_model.num_sections = 1;
  bad_model.name = "../box";
  Send("RIMOD_MODEL", EncodeMessage(bad_model));
  bad_model.name = "box";
  bad_model.x[0] = std::numeric_limits<float>::infinity();
  Send("RIMOD_MODEL", EncodeMessage(bad_model));
  ExpectAliveAndCounting(100);

  // The model comes over the bus; it is used from the next scan on.
  bus_.PublishAll("RIMOD_MODEL", ToSections(model, 2));
  bus_.Listen(milliseconds(300));
  bus_.PublishAll("RIMOD_FEATURES", ToSections(expected.features, utime));
  bus_.PublishAll("RIMOD_RANGE_IMAGE", ToSections(expected.image, utime));
  const ModelDatabase database({model}, expected.params, Execution());
  const DetectionResult result =
      DetectObjects(expected.image, expected.features, database, expected.params, Execution());
  ExpectReceived("RIMOD_HYPOTHESES", utime,
                 SumsOf<pose_hypotheses_t>(
                     {ToMessage(result.hypotheses, result.num_hypotheses_found, utime)}));
  bus_.ListenUntil([&] { return !bus_.Sums("RIMOD_DETECTIONS", utime).empty(); }, kLong);
  const auto detections = bus_.Messages<detections_t>("RIMOD_DETECTIONS");
  ASSERT_FALSE(detections.empty());
  detections_t received = detections.back();
  EXPECT_GT(received.num_stage_times, 3);
  received.stage_times.clear();
  received.num_stage_times = 0;
  const StampedDetections sent = {utime, expected.image.T_local_sensor(), 1, result.detections, {}};
  EXPECT_EQ(SumOf(EncodeMessage(received)), SumOf(EncodeMessage(ToMessage(sent))));
  ExpectStopsCleanly();
}

}  // namespace
}  // namespace rimod
