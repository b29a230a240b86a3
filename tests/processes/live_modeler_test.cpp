// rimod-modeler --live: a model from scans that come on the bus.

#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <memory>

#include "io/model_file.h"
#include "io/scan_messages.h"
#include "tests/support/bus_probe.h"
#include "tests/support/child_process.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tilting_laser.h"

namespace rimod {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kLong(60000);

class LiveModelerTest : public ::testing::Test {
 protected:
  // The box of the small room.
  void WriteDescription() {
    folder_.Write("model.json",
                  R"({"class": "box", "box": {"min": [-0.3, -0.25, 0], "max": [0.3, 0.25, 0.7]},
                      "object_pose": [2.2, -0.5, 0, )" +
                      std::to_string(std::cos(0.15)) + ", 0, 0, " + std::to_string(std::sin(0.15)) +
                      "]}");
  }
  void Start(int num_scans) {
    modeler_ = std::make_unique<ChildProcess>(
        std::vector<std::string>{std::string(RIMOD_BIN_DIR) + "/rimod-modeler", "--live",
                                 folder_.path(), "--scans", std::to_string(num_scans), "--out",
                                 elsewhere_.PathOf("box.rimod")},
        elsewhere_.PathOf("output"));
  }
  bool WaitForStatus() {
    return bus_.ListenUntil([this] { return bus_.Status("rimod-modeler").has_value(); }, kLong);
  }
  // A scan of the room from one of the places round the box.
  void PublishScan(int place) {
    const double angle = place * 2.1;
    const Eigen::Vector3d position(2.2 + 1.8 * std::cos(angle), -0.5 + 1.8 * std::sin(angle), 1.0);
    StampedScan scan;
    scan.utime = scan.utime_end = place + 1;
    scan.scan = ScanWorld(SmallRoom(), LookAt(position, {2.2, -0.5, 0.35}), BeamPattern());
    bus_.PublishAll("RIMOD_SCAN", ToSections(scan));
  }

  TemporaryFolder folder_;
  TemporaryFolder elsewhere_;
  BusProbe bus_;
  std::unique_ptr<ChildProcess> modeler_;
};

TEST_F(LiveModelerTest, AfterTheScansItBuildsTheModel) {
  WriteDescription();
  Start(3);
  ASSERT_TRUE(WaitForStatus());
  for (int place = 0; place < 3; ++place) PublishScan(place);
  EXPECT_EQ(modeler_->Wait(kLong), 0) << modeler_->Output();
  EXPECT_EQ(folder_.Names(), (std::vector<std::string>{"model.json", "scan_000.pcd", "scan_001.pcd",
                                                       "scan_002.pcd"}));
  const ModelFileResult model = ReadModelFile(elsewhere_.PathOf("box.rimod"));
  ASSERT_TRUE(model.model) << model.error;
  EXPECT_EQ(model.model->name, "box");
  EXPECT_GT(model.model->points.size(), 100u);
}

TEST_F(LiveModelerTest, CtrlCEndsTheRecordingAndTheModelIsBuilt) {
  WriteDescription();
  Start(100);
  ASSERT_TRUE(WaitForStatus());
  PublishScan(0);
  PublishScan(1);
  ASSERT_TRUE(bus_.ListenUntil([this] { return folder_.Names().size() == 3; }, kLong));
  modeler_->Signal(SIGINT);
  EXPECT_EQ(modeler_->Wait(kLong), 0) << modeler_->Output();
  EXPECT_TRUE(ReadModelFile(elsewhere_.PathOf("box.rimod")).model);
}

TEST_F(LiveModelerTest, WithoutAScanThereIsNoModel) {
  WriteDescription();
  Start(1);
  ASSERT_TRUE(WaitForStatus());
  bus_.Publish("RIMOD_SCAN", std::vector<std::uint8_t>{1, 2, 3});
  bus_.Listen(milliseconds(100));
  modeler_->Signal(SIGTERM);
  EXPECT_EQ(modeler_->Wait(milliseconds(1000)), 1) << modeler_->Output();
  EXPECT_EQ(folder_.Names(), std::vector<std::string>{"model.json"});
}

TEST_F(LiveModelerTest, AFolderWithoutDescriptionOrWithScansIsRefused) {
  Start(1);
  EXPECT_EQ(modeler_->Wait(kLong), 1);
  EXPECT_NE(modeler_->Output().find("model.json"), std::string::npos) << modeler_->Output();
  WriteDescription();
  folder_.Write("scan_007.pcd", "x");
  Start(1);
  EXPECT_EQ(modeler_->Wait(kLong), 1);
  EXPECT_NE(modeler_->Output().find("holds scans already"), std::string::npos)
      << modeler_->Output();
  EXPECT_EQ(folder_.Read("scan_007.pcd"), "x");
}

}  // namespace
}  // namespace rimod
