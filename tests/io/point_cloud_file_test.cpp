#include "io/point_cloud_file.h"

#include <gtest/gtest.h>
#include <lzf.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "io/files.h"
#include "tests/io/random_values.h"
#include "tests/support/matchers.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_matchers.h"

namespace rimod {
namespace {

const float kNaN = std::numeric_limits<float>::quiet_NaN();

template <typename T>
void Append(T value, std::string* bytes) {  // little-endian machine, as all that run these tests
  char text[sizeof value];
  std::memcpy(text, &value, sizeof value);
  bytes->append(text, sizeof value);
}

template <typename T>
void AppendBig(T value, std::string* bytes) {
  std::string little;
  Append(value, &little);
  bytes->append(little.rbegin(), little.rend());
}

std::string PcdHeader(const std::string& points, const std::string& encoding) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " +
         points + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA " + encoding +
         "\n";
}

PointCloudResult Read(const std::string& bytes) {
  const TemporaryFolder folder;
  return ReadPointCloud(folder.Write("cloud", bytes));
}

TEST(PcdTest, WrittenScansAreReadBackBitForBit) {
  const TemporaryFolder folder;
  RandomValues random(1);
  for (int round = 0; round < 20; ++round) {
    const Scan scan = random.AScan(random.Int(1, 500), 0);
    ASSERT_EQ(WritePcd(folder.PathOf("scan.pcd"), scan), "");
    const PointCloudResult read = ReadPointCloud(folder.PathOf("scan.pcd"));
    ASSERT_TRUE(read.scan) << read.error;
    EXPECT_EQ(read.scan->points, scan.points);
    EXPECT_TRUE(PosesNear(read.scan->T_local_sensor, scan.T_local_sensor, 1e-12, 1e-7));
  }
}

TEST(PcdTest, ViewpointBecomesTheLevelSensor) {
  RandomValues random(2);
  for (int round = 0; round < 20; ++round) {
    Scan scan = random.AScan(1, 0);
    scan.T_local_sensor = random.Pose();
    const TemporaryFolder folder;
    ASSERT_EQ(WritePcd(folder.PathOf("scan.pcd"), scan), "");
    const PointCloudResult read = ReadPointCloud(folder.PathOf("scan.pcd"));
    ASSERT_TRUE(read.scan) << read.error;
    EXPECT_TRUE(PosesNear(read.scan->T_local_sensor, LevelPose(scan.T_local_sensor), 1e-12, 1e-6));
  }
}

// x as double, y as int16, z as uint8, with other fields between, in every encoding.
struct MixedFields {
  std::string header =
      "VERSION .7\r\nFIELDS a z fpfh x _ y\r\nSIZE 1 1 4 8 1 2\r\nTYPE I U F F U I\r\n"
      "COUNT 1 1 3 1 2 1\r\nWIDTH 2\r\nHEIGHT 1\r\nPOINTS 2\r\n";
  std::string Record(double x, std::int16_t y, std::uint8_t z) const {
    std::string bytes;
    Append<std::int8_t>(-3, &bytes);
    Append(z, &bytes);
    for (float f : {kNaN, 1.0f, 2.0f}) Append(f, &bytes);
    Append(x, &bytes);
    bytes += "??";
    Append(y, &bytes);
    return bytes;
  }
};

void ExpectMixedPoints(const PointCloudResult& read) {
  ASSERT_TRUE(read.scan) << read.error;
  ASSERT_EQ(read.scan->points.size(), 2u);
  EXPECT_EQ(read.scan->points[0], Eigen::Vector3f(1.25f, -300.0f, 200.0f));
  EXPECT_EQ(read.scan->points[1], Eigen::Vector3f(-0.5f, 7.0f, 0.0f));
}

TEST(PcdTest, FieldsMayBeOfAnyTypeInAnyOrder) {
  const MixedFields mixed;
  const std::string records = mixed.Record(1.25, -300, 200) + mixed.Record(-0.5, 7, 0);
  ExpectMixedPoints(Read(mixed.header + "DATA binary\r\n" + records));
  ExpectMixedPoints(
      Read(mixed.header + "DATA ascii\n-3 200 nan 1 2 1.25 0 0 -300\n\n-3 0 nan 1 2 -.5 0 0 +7\n"));
}

TEST(PcdTest, CompressedPointsAreFieldByField) {
  const MixedFields mixed;
  const std::string a = mixed.Record(1.25, -300, 200);
  const std::string b = mixed.Record(-0.5, 7, 0);
  std::string columns;
  std::size_t at = 0;
  for (std::size_t size : {1u, 1u, 12u, 8u, 2u, 2u}) {
    columns += a.substr(at, size) + b.substr(at, size);
    at += size;
  }
  std::string packed(1000, '\0');
  packed.resize(lzf_compress(columns.data(), static_cast<unsigned>(columns.size()), packed.data(),
                             static_cast<unsigned>(packed.size())));
  ASSERT_GT(packed.size(), 0u);
  std::string sizes;
  Append(static_cast<std::uint32_t>(packed.size()), &sizes);
  Append(static_cast<std::uint32_t>(columns.size()), &sizes);
  const std::string file = mixed.header + "DATA binary_compressed\n" + sizes + packed;
  ExpectMixedPoints(Read(file));
  EXPECT_TRUE(Mentions(Read(file.substr(0, file.size() - 3)).error, {"truncated"}));
  std::string damaged = file;
  for (std::size_t i = file.size() - packed.size(); i < file.size(); ++i) damaged[i] = '\x7f';
  EXPECT_TRUE(Mentions(Read(damaged).error, {"damaged"}));
}

TEST(PcdTest, PointsThatAreNotFiniteAreLeftOutAndCounted) {
  const PointCloudResult read =
      Read(PcdHeader("4", "ascii") + "nan nan nan\n1 2 3\n1 inf 3\n1 2 1e30\n");
  ASSERT_TRUE(read.scan) << read.error;
  EXPECT_EQ(read.scan->points, std::vector<Eigen::Vector3f>{Eigen::Vector3f(1, 2, 3)});
  EXPECT_EQ(read.counts.declared, 4);
  EXPECT_EQ(read.counts.used, 1);
  EXPECT_EQ(read.counts.not_finite, 3);
  EXPECT_TRUE(Mentions(read.warning, {"cloud", "3 of 4"}));
  EXPECT_TRUE(
      Mentions(Read(PcdHeader("1", "ascii") + "nan 0 0\n").error, {"cloud", "none of its 1"}));
}

TEST(PcdTest, WrongCountsAreErrors) {
  EXPECT_TRUE(Mentions(Read(PcdHeader("0", "binary")).error, {"cloud", "no points"}));
  EXPECT_TRUE(Mentions(Read(PcdHeader("3", "ascii") + "1 2 3\n4 5 6\n").error, {"truncated", "2"}));
  EXPECT_TRUE(
      Mentions(Read(PcdHeader("1", "ascii") + "1 2\n").error, {"2 instead of 3", "line 1"}));
  EXPECT_TRUE(Mentions(Read(PcdHeader("1", "ascii") + "1 2 x\n").error, {"no number"}));
  EXPECT_TRUE(Mentions(Read(PcdHeader("2", "binary") + std::string(23, 'a')).error, {"truncated"}));
  EXPECT_TRUE(Mentions(Read(PcdHeader("-1", "binary")).error, {"WIDTH"}));
  EXPECT_TRUE(Mentions(Read(PcdHeader("99999999999999999999", "binary")).error, {"WIDTH"}));
  EXPECT_TRUE(Mentions(Read(PcdHeader("4611686018427387904", "binary")).error, {"more than"}));
  std::string differ = PcdHeader("2", "binary");
  differ.replace(differ.find("POINTS 2"), 8, "POINTS 3");
  EXPECT_TRUE(Mentions(Read(differ + std::string(24, 'a')).error, {"counts differ", "3", "2"}));
}

TEST(PcdTest, MorePointsThanDeclaredAreLeftOutWithAWarning) {
  const PointCloudResult text = Read(PcdHeader("1", "ascii") + "1 2 3\n4 5 6\n");
  ASSERT_TRUE(text.scan);
  EXPECT_EQ(text.scan->points.size(), 1u);
  EXPECT_TRUE(Mentions(text.warning, {"cloud", "more points"}));
  const PointCloudResult binary = Read(PcdHeader("1", "binary") + std::string(24, '\0'));
  ASSERT_TRUE(binary.scan);
  EXPECT_TRUE(Mentions(binary.warning, {"cloud", "more bytes"}));
}

TEST(PcdTest, TenMillionPointsInATinyFileAreAnErrorAtOnce) {
  for (const char* encoding : {"ascii", "binary", "binary_compressed"}) {
    EXPECT_TRUE(Mentions(Read(PcdHeader("10000000", encoding) + "12345678").error, {"cloud"}));
  }
}

TEST(PcdTest, CompressedSizesThatLieAreErrorsAtOnce) {
  std::string sizes;
  Append<std::uint32_t>(4, &sizes);
  Append<std::uint32_t>(120'000'000, &sizes);
  const std::string header = PcdHeader("10000000", "binary_compressed");
  EXPECT_TRUE(Mentions(Read(header + sizes + "abcd").error, {"cannot be that many"}));
  std::string other = sizes;
  other[4] = 'x';
  EXPECT_TRUE(Mentions(Read(header + other + "abcd").error, {"counts differ"}));
}

TEST(PcdTest, TenMillionRealPointsAreRead) {
  const TemporaryFolder folder;
  Scan scan;
  scan.points.assign(10'000'000, Eigen::Vector3f(1.0f, 2.0f, 3.0f));
  ASSERT_EQ(WritePcd(folder.PathOf("large.pcd"), scan), "");
  const PointCloudResult read = ReadPointCloud(folder.PathOf("large.pcd"));
  ASSERT_TRUE(read.scan) << read.error;
  EXPECT_EQ(read.scan->points.size(), scan.points.size());
  EXPECT_EQ(read.scan->points.back(), scan.points.back());
}

TEST(PcdTest, BadHeadersAreErrors) {
  const auto replaced = [](const std::string& what, const std::string& by) {
    std::string header = PcdHeader("1", "ascii");
    header.replace(header.find(what), what.size(), by);
    return Read(header + "1 2 3\n").error;
  };
  EXPECT_TRUE(Mentions(replaced("DATA ascii", "DATA zip"), {"encoding 'zip'"}));
  EXPECT_TRUE(Mentions(replaced("DATA ascii\n", ""), {"header"}));
  EXPECT_TRUE(Mentions(replaced("FIELDS x y z", "FIELDS x y w"), {"no field z"}));
  EXPECT_TRUE(Mentions(replaced("FIELDS x y z", "FIELDS x y"), {"SIZE does not fit"}));
  EXPECT_TRUE(Mentions(replaced("SIZE 4 4 4", "SIZE 4 4 3"), {"SIZE 3"}));
  EXPECT_TRUE(Mentions(replaced("SIZE 4 4 4", "SIZE 4 4 2"), {"float of 2 bytes"}));
  EXPECT_TRUE(Mentions(replaced("TYPE F F F", "TYPE F F Q"), {"TYPE Q"}));
  EXPECT_TRUE(Mentions(replaced("COUNT 1 1 1", "COUNT 1 1 2"), {"no field z"}));
  EXPECT_TRUE(Mentions(replaced("COUNT 1 1 1", "COUNT 1 1 -2"), {"COUNT -2"}));
  EXPECT_TRUE(Mentions(replaced("VIEWPOINT 0 0 0 1", "VIEWPOINT 0 nan 0 1"), {"VIEWPOINT"}));
  EXPECT_TRUE(Mentions(replaced("VIEWPOINT 0 0 0 1 0 0 0", "VIEWPOINT 0 0 0"), {"VIEWPOINT"}));
  EXPECT_EQ(replaced("VIEWPOINT 0 0 0 1 0 0 0", "VIEWPOINT 0 0 0 0 0 0 0"), "");
}

TEST(PlyTest, TextAndBothByteOrdersGiveTheSamePoints) {
  const std::string elements =
      "comment made by hand\nelement face 2\nproperty list uchar int vertex_indices\n"
      "element vertex 2\nproperty double z\nproperty uchar red\nproperty list uint8 float32 t\n"
      "property float x\nproperty short y\nend_header\n";
  std::string little, big;
  for (int face = 0; face < 2; ++face) {
    little += '\x01', big += '\x01';
    Append<std::int32_t>(0, &little), AppendBig<std::int32_t>(0, &big);
  }
  for (int i = 0; i < 2; ++i) {
    Append(0.5 + i, &little), AppendBig(0.5 + i, &big);
    little += "r", big += "r";
    little += '\x01', big += '\x01';
    Append(9.0f, &little), AppendBig(9.0f, &big);
    Append(-1.5f, &little), AppendBig(-1.5f, &big);
    Append<std::int16_t>(-7, &little), AppendBig<std::int16_t>(-7, &big);
  }
  const std::vector<Eigen::Vector3f> points = {{-1.5f, -7.0f, 0.5f}, {-1.5f, -7.0f, 1.5f}};
  const std::string text = "1 0\n3 0 0 0\n.5 1 2 9 9 -1.5 -7 1.5 1 0 -1.5\n-7";
  for (const auto& [format, body] : {std::pair<std::string, std::string>("ascii", text),
                                     {"binary_little_endian", little},
                                     {"binary_big_endian", big}}) {
    const PointCloudResult read = Read("ply\nformat " + format + " 1.0\n" + elements + body);
    ASSERT_TRUE(read.scan) << read.error;
    EXPECT_EQ(read.scan->points, points) << format;
    EXPECT_TRUE(read.scan->T_local_sensor.isApprox(Eigen::Isometry3d::Identity()));
  }
}

TEST(PlyTest, CameraIsTheSensorsPosition) {
  const PointCloudResult read = Read(
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nelement camera 1\nproperty float view_px\nproperty float view_py\n"
      "property float view_pz\nproperty float x_axisx\nend_header\n1 2 3\n0.5 -1 1.25 0\n");
  ASSERT_TRUE(read.scan) << read.error;
  EXPECT_EQ(read.scan->T_local_sensor.translation(), Eigen::Vector3d(0.5, -1.0, 1.25));
}

TEST(PlyTest, BadFilesAreErrors) {
  const std::string vertex = "property float x\nproperty float y\nproperty float z\nend_header\n";
  const std::string start = "ply\nformat binary_little_endian 1.0\nelement vertex ";
  EXPECT_TRUE(Mentions(Read(start + "0\n" + vertex).error, {"cloud", "no points"}));
  EXPECT_TRUE(Mentions(Read(start + "2\n" + vertex + std::string(23, 'a')).error, {"truncated"}));
  EXPECT_TRUE(Mentions(Read(start + "10000000\n" + vertex + "aaaa").error, {"truncated"}));
  EXPECT_TRUE(Mentions(Read(start + "9999999999999\n" + vertex).error, {"more than"}));
  EXPECT_TRUE(Mentions(Read(start + "-5\n" + vertex).error, {"element"}));
  EXPECT_TRUE(Mentions(Read(start + "1\nproperty float x\nend_header\nabcd").error, {"x, y, z"}));
  EXPECT_TRUE(Mentions(Read(start + "1\nproperty vec3 x\nend_header\n").error, {"unknown type"}));
  EXPECT_TRUE(Mentions(Read(start + "1\n" + vertex.substr(0, 20)).error, {"header"}));
  EXPECT_TRUE(Mentions(Read("ply\nelement vertex 1\n" + vertex).error, {"format"}));
  EXPECT_TRUE(Mentions(Read("ply\nformat ascii 1.0\nelement vertex 1\n" + vertex + "1 2 x").error,
                       {"number 0"}));
  // Elements without properties take no bytes, however many: no loop over them.
  EXPECT_TRUE(Mentions(Read("ply\nformat ascii 1.0\nelement nothing 9000000000000000000\n"
                            "element vertex 1\n" +
                            vertex + "1 2")
                           .error,
                       {"number 0"}));
}

TEST(ThreedtkTest, AxesAndUnitsAreTurnedIntoOurs) {
  const PointCloudResult read = Read("resolution\n100 200 300\n-50 0 100.5 17\n");
  ASSERT_TRUE(read.scan) << read.error;
  ASSERT_EQ(read.scan->points.size(), 2u);
  EXPECT_TRUE(read.scan->points[0].isApprox(Eigen::Vector3f(3.0f, -1.0f, 2.0f)));
  EXPECT_TRUE(read.scan->points[1].isApprox(Eigen::Vector3f(1.005f, 0.5f, 0.0f)));
}

TEST(ThreedtkTest, NearAndMissingReturnsAreNoPoints) {
  const PointCloudResult read =
      Read("0 0 100\n0 0 19.9\n0 0 0\n0 0 3276.7\n3276.7 0 0\n0 0 5000\n");
  ASSERT_TRUE(read.scan) << read.error;
  EXPECT_EQ(read.scan->points.size(), 2u);
  EXPECT_EQ(read.counts.near, 2);
  EXPECT_EQ(read.counts.no_return, 2);
  ASSERT_EQ(read.scan->no_return_directions.size(), 2u);
  EXPECT_TRUE(read.scan->no_return_directions[0].isApprox(Eigen::Vector3f::UnitX()));
  EXPECT_TRUE(read.scan->no_return_directions[1].isApprox(-Eigen::Vector3f::UnitY()));
}

TEST(ThreedtkTest, BadLinesAreErrors) {
  EXPECT_TRUE(Mentions(Read("1 2 3\n1 2 3\n4 five 6\n7 8 9\n").error, {"cloud"}));
  std::string cut;
  for (int i = 0; i < 2000; ++i) cut += "100 200 300\n";
  EXPECT_TRUE(Mentions(Read(cut + "100 2").error, {"truncated", "line 2001"}));
  EXPECT_TRUE(Mentions(Read(cut + "100 2\n100 200 300\n").error, {"line 2001"}));
  EXPECT_TRUE(Mentions(Read("0 0 10\n0 0 12\n").error, {"none of its 2"}));
}

TEST(PointCloudFileTest, ForeignFilesAreErrors) {
  const TemporaryFolder folder;
  EXPECT_TRUE(Mentions(Read("").error, {"cloud", "empty"}));
  EXPECT_TRUE(Mentions(Read("Hello, world\nthis is text\n").error, {"cloud", "neither"}));
  EXPECT_TRUE(Mentions(Read(std::string("\x7f"
                                        "ELF\0\0\0",
                                        7))
                           .error,
                       {"neither"}));
  EXPECT_TRUE(
      Mentions(ReadPointCloud(folder.PathOf("none.pcd")).error, {"none.pcd", "cannot be read"}));
  EXPECT_TRUE(Mentions(ReadPointCloud(folder.path()).error, {"not a file"}));
  EXPECT_EQ(RecognisePointCloud(folder.PathOf("none.pcd")), PointCloudFormat::kUnknown);
}

// Whatever bytes are flipped or cut off: an answer, never a crash, never more points than bytes.
TEST(PointCloudFileTest, DamagedFilesGiveAnAnswer) {
  const TemporaryFolder folder;
  RandomValues random(3);
  const MixedFields mixed;
  const std::string ply =
      "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty list uchar int i\n"
      "property float x\nproperty float y\nproperty float z\nend_header\n" +
      std::string(60, '\0');
  const std::vector<std::string> files = {
      mixed.header + "DATA binary\n" + mixed.Record(1, 2, 3) + mixed.Record(4, 5, 6),
      PcdHeader("2", "ascii") + "1 2 3\n4 5 6\n", ply, "100 200 300\n1 2 3\n"};
  int number = 0;
  for (const std::string& good : files) {
    for (int round = 0; round < 300; ++round) {
      std::string bytes = good;
      for (int flips = random.Int(1, 4); flips > 0; --flips) {
        const auto at = static_cast<std::size_t>(random.Int(0, static_cast<int>(good.size()) - 1));
        bytes[at] = static_cast<char>(random.Int(0, 255));
      }
      if (random.Int(0, 2) == 0) bytes.resize(static_cast<std::size_t>(random.Int(0, 60)));
      const PointCloudResult read = ReadPointCloud(folder.Write(std::to_string(number++), bytes));
      EXPECT_NE(read.scan.has_value(), !read.error.empty());
      if (read.scan) {
        EXPECT_LE(read.scan->points.size(), bytes.size());
      }
    }
  }
}

}  // namespace
}  // namespace rimod
