// Writes small valid inputs for every fuzzer: fuzz_seeds FOLDER makes a folder a fuzzer in it.

#include <array>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "io/config.h"
#include "io/event_log.h"
#include "io/message_codec.h"
#include "io/model_file.h"
#include "io/point_cloud_file.h"
#include "tests/fuzz/message_types.h"
#include "tests/io/random_models.h"
#include "tests/support/sample_messages.h"

namespace rimod {
namespace {

class Seeds {
 public:
  explicit Seeds(std::string folder) : folder_(std::move(folder)) {}

  std::string PathOf(const std::string& fuzzer, const std::string& name) const {
    std::filesystem::create_directories(folder_ + "/" + fuzzer);
    return folder_ + "/" + fuzzer + "/" + name;
  }
  void Write(const std::string& fuzzer, const std::string& name, const std::string& bytes) const {
    std::ofstream(PathOf(fuzzer, name), std::ios::binary) << bytes;
  }

 private:
  std::string folder_;
};

// The fields of an encoded message: what follows the fingerprint.
template <typename Message>
std::string FieldsOf(const Message& message) {
  const std::vector<std::uint8_t> bytes = EncodeMessage(message);
  return {bytes.begin() + 8, bytes.end()};
}

std::string Byte(std::size_t value) { return std::string(1, static_cast<char>(value)); }

void WriteMessages(const Seeds& seeds) {
  std::size_t type = 0;
  ForEachMessageType([&](auto* none) {
    using Message = std::remove_pointer_t<decltype(none)>;
    seeds.Write("messages", std::to_string(type), Byte(type) + FieldsOf(SampleMessage<Message>()));
    ++type;
  });
}

template <typename Section>
std::string Pieces(std::size_t type, const std::vector<Section>& sections) {
  std::string pieces;
  for (const Section& section : sections) {
    const std::string fields = FieldsOf(section);
    pieces += Byte(type) + Byte(fields.size() / 256) + Byte(fields.size() % 256) + fields;
  }
  return pieces;
}

void WriteSections(const Seeds& seeds) {
  const auto in_two = [](auto section) {
    section.num_sections = 2;
    auto second = section;
    second.section = 1;
    return std::vector{section, second};
  };
  const std::string scan = Pieces(0, in_two(SampleMessage<scan_t>()));
  const std::string image = Pieces(1, in_two(SampleMessage<range_image_t>()));
  const std::string features = Pieces(2, in_two(SampleMessage<feature_set_t>()));
  const std::string model = Pieces(3, std::vector{SampleMessage<object_model_t>()});
  seeds.Write("sections", "scan", scan);
  seeds.Write("sections", "image", image);
  seeds.Write("sections", "features", features);
  seeds.Write("sections", "model", model);
  seeds.Write("sections", "all", scan + image + features + model);
}

template <typename Message>
void WriteEvent(EventLogWriter* log, const std::string& channel, const Message& message) {
  const std::vector<std::uint8_t> bytes = EncodeMessage(message);
  log->Write(message.utime, channel, bytes.data(), bytes.size());
}

// A tilt of a few beams, a ready scan, clouds.
void WriteLogs(const Seeds& seeds) {
  EventLogWriter laser(seeds.PathOf("event_logs", "laser"));
  for (int i = 0; i <= 40; ++i) {
    const Time time(1'000'000 + i * 26'670);
    TimedPose pose{time, Eigen::Isometry3d::Identity()};
    pose.T_local_laser.rotate(Eigen::AngleAxisd(0.02 * i, Eigen::Vector3d::UnitY()));
    WriteEvent(&laser, "LASER_TO_LOCAL", ToMessage(pose));
    WriteEvent(&laser, "LASER", ToMessage(LaserLine{time, -0.1, 0.1, {1.0f, 2.0f, 81.91f}}));
  }
  EventLogWriter others(seeds.PathOf("event_logs", "others"));
  WriteEvent(&others, "RIMOD_SCAN", SampleMessage<scan_t>());
  WriteEvent(&others, "POSE", SampleMessage<bot_core::rigid_transform_t>());
  WriteEvent(&others, "CLOUD", SampleMessage<bot_core::pointcloud2_t>());
  if (!(laser.Close() + others.Close()).empty()) throw std::runtime_error("no log was written");
}

void WriteClouds(const Seeds& seeds) {
  WritePcd(seeds.PathOf("clouds", "binary.pcd"), RandomValues(1).AScan(6, 0));
  const std::string pcd =
      "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 2\nTYPE F F F U\nCOUNT 1 1 1 "
      "1\n"
      "WIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 1 1 0 0 0\nPOINTS 2\n";
  seeds.Write("clouds", "ascii.pcd", pcd + "DATA ascii\n1 2 3 4\nnan 1 1 5\n");
  // One literal run of liblzf: length - 1, then that many bytes.
  seeds.Write("clouds", "compressed.pcd",
              pcd + "DATA binary_compressed\n" + std::string("\x1d\0\0\0\x1c\0\0\0", 8) +
                  std::string("\x1b", 1) + std::string(28, '\1'));
  const std::string vertices =
      "element vertex 2\nproperty float x\nproperty double y\nproperty float z\n";
  const std::string camera =
      "element camera 1\nproperty float view_px\nproperty float view_py\n"
      "property float view_pz\n";
  seeds.Write("clouds", "ascii.ply",
              "ply\nformat ascii 1.0\n" + vertices + camera + "end_header\n1 2 3\n4 5 6\n0 0 1\n");
  for (const std::string order : {"little", "big"})
    seeds.Write("clouds", order + ".ply",
                "ply\nformat binary_" + order + "_endian 1.0\n" + vertices + "end_header\n" +
                    std::string(32, '\1'));
  seeds.Write("clouds", "points.3d", "3\n100 200 300\n-1.5 2e2 3276 0.5\n10 10 10\n");
}

void WriteMeshes(const Seeds& seeds) {
  seeds.Write("meshes", "obj",
              Byte(0) +
                  "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 0 0 1\nf 1//1 2//1 3//1\n"
                  "f -4 -3 -1\nf 1/2/3 2 3 4\n");
  const std::string ply =
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  seeds.Write("meshes", "ply",
              Byte(1) + "ply\nformat ascii 1.0\n" + ply + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  seeds.Write("meshes", "binary_ply",
              Byte(1) + "ply\nformat binary_little_endian 1.0\n" + ply + std::string(36, '\2') +
                  "\3" + std::string(12, '\0'));
  seeds.Write("meshes", "stl",
              Byte(2) +
                  "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                  "vertex 0 1 0\nendloop\nendfacet\nendsolid a\n");
  seeds.Write("meshes", "binary_stl",
              Byte(2) + std::string(80, ' ') + std::string("\1\0\0\0", 4) + std::string(12, '\0') +
                  std::string(36, '\2') + std::string(2, '\0'));
}

void WriteTexts(const Seeds& seeds) {
  for (const Method method : {Method::kDefault, Method::kPaper})
    seeds.Write("config", method == Method::kPaper ? "paper" : "default",
                DumpConfiguration(DefaultConfiguration(method)));
  seeds.Write("config", "short", "method: paper\nbus:\n  idle_time: 0.5\n");
  seeds.Write("labels", "labels",
              R"({"scans":[{"scan":"a","objects":[{"class":"fan","pose":[1,2,3,1,0,0,0],)"
              R"("points":10,"visible":0.5,"distance":2.5}]}]})");
  seeds.Write("labels", "line",
              R"({"scan":"000","class":"fan","pose":[1,2,3,1,0,0,0],"score":0.83})"
              "\n");
  seeds.Write("recordings", "json",
              R"({"class":"fan","object_pose":[0.5,0.4,0,1,0,0,0],"symmetry":"none",)"
              R"("box":{"min":[-0.1,-0.1,0],"max":[0.1,0.1,0.5]}})");
  seeds.Write("run_files", "run",
              "processes:\n  - name: a\n    command: [/bin/sh, -c, 'exit 1']\n    restart: never\n"
              "stop_patience: 1\nfirst_pause: 0.5\nlongest_pause: 3\nsteady_time: 10\n");
  seeds.Write("scenes", "scene",
              "seed: 7\nsensor:\n  position: [0, 0, 1]\n  yaw_deg: 3\nroom:\n  min: [-2, -2, 0]\n"
              "  max: [2, 2, 2]\n  reflectivity: 0.7\nshapes:\n  post:\n    parts:\n"
              "      - {cylinder: {radius: 0.1, height: 1}, position: [0, 0, 0]}\nobjects:\n"
              "  - {box: {size: [1, 1, 1]}, position: [1, 0, 0], yaw_deg: 8}\n"
              "  - {shape: post, position: [1, 1, 0]}\n");
}

}  // namespace
}  // namespace rimod

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: fuzz_seeds FOLDER\n";
    return 2;
  }
  const rimod::Seeds seeds(argv[1]);
  rimod::WriteMessages(seeds);
  rimod::WriteSections(seeds);
  rimod::WriteLogs(seeds);
  rimod::WriteClouds(seeds);
  rimod::WriteMeshes(seeds);
  rimod::WriteTexts(seeds);
  // The files end with their checksum, which the fuzzer puts there itself.
  const std::string model = rimod::EncodeModelFile(rimod::RandomModel(1, 2, 5));
  seeds.Write("models", "sealed", rimod::Byte(0) + model.substr(0, model.size() - 4));
  seeds.Write("models", "as_is", rimod::Byte(1) + model);
}
