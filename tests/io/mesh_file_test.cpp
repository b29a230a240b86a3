#include "io/mesh_file.h"

#include <gtest/gtest.h>

#include <cstring>

#include "tests/io/random_values.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_matchers.h"

namespace rimod {
namespace {

double AreaOf(const Mesh& mesh) {
  double area = 0.0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const Eigen::Vector3d& a = mesh.vertices[static_cast<std::size_t>(t[0])];
    const Eigen::Vector3d& b = mesh.vertices[static_cast<std::size_t>(t[1])];
    const Eigen::Vector3d& c = mesh.vertices[static_cast<std::size_t>(t[2])];
    area += 0.5 * (b - a).cross(c - a).norm();
  }
  return area;
}

std::string BinaryStl(const std::vector<std::vector<float>>& triangles, std::uint32_t count) {
  std::string bytes(80, ' ');
  bytes.append(reinterpret_cast<const char*>(&count), 4);
  for (const std::vector<float>& corners : triangles) {
    bytes.append(12, '\0');  // normal
    bytes.append(reinterpret_cast<const char*>(corners.data()), 36);
    bytes.append(2, '\0');
  }
  return bytes;
}

TEST(MeshFileTest, TheSameSquareInEveryFormat) {
  const TemporaryFolder folder;
  const std::string obj =
      folder.Write("a.obj", "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 9 9 9\nf 1 2 3 4\n");
  const std::string ply = folder.Write(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n2 0 0\n2 2 0\n0 2 0\n4 0 1 2 3\n");
  const std::string stl = folder.Write(
      "a.STL", BinaryStl({{0, 0, 0, 2, 0, 0, 2, 2, 0}, {0, 0, 0, 2, 2, 0, 0, 2, 0}}, 2));
  for (const std::string& path : {obj, ply, stl}) {
    const MeshResult read = ReadMesh(path);
    ASSERT_TRUE(read.mesh) << read.error;
    EXPECT_EQ(read.mesh->triangles.size(), 2u) << path;
    EXPECT_EQ(read.mesh->vertices.size(), 4u) << path;
    EXPECT_NEAR(AreaOf(*read.mesh), 4.0, 1e-6) << path;
    EXPECT_EQ(read.dropped_triangles, 0);
  }
}

TEST(MeshFileTest, PartsAreJoined) {
  const TemporaryFolder folder;
  const MeshResult read = ReadMesh(
      folder.Write("a.obj",
                   "o one\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no two\nv 0 0 5\nv 1 0 5\nv 0 1 5\n"
                   "f 4 5 6\n"));
  ASSERT_TRUE(read.mesh) << read.error;
  EXPECT_EQ(read.mesh->triangles.size(), 2u);
  EXPECT_NEAR(AreaOf(*read.mesh), 1.0, 1e-6);
}

TEST(MeshFileTest, TrianglesWithoutAreaOrFiniteCornersAreLeftOut) {
  const TemporaryFolder folder;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> good = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::vector<float> thin = {0, 0, 0, 1, 0, 0, 2, 0, 0};
  const std::vector<float> bad = {0, 0, 0, nan, 0, 0, 0, 1, 0};
  const std::vector<float> far = {0, 0, 0, 1e30f, 0, 0, 0, 1, 0};
  const MeshResult some = ReadMesh(folder.Write("a.stl", BinaryStl({good, thin, bad, far}, 4)));
  ASSERT_TRUE(some.mesh) << some.error;
  EXPECT_EQ(some.mesh->triangles.size(), 1u);
  EXPECT_EQ(some.mesh->vertices.size(), 3u);
  EXPECT_EQ(some.dropped_triangles, 3);
  const MeshResult none = ReadMesh(folder.Write("b.stl", BinaryStl({thin, bad}, 2)));
  EXPECT_FALSE(none.mesh);
  EXPECT_TRUE(Mentions(none.error, {"b.stl"}));
}

TEST(MeshFileTest, BadFilesAreErrors) {
  const TemporaryFolder folder;
  const std::string ply_start = "ply\nformat binary_little_endian 1.0\nelement vertex ";
  const std::string ply_end =
      "\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n";
  for (const std::string& path :
       {folder.Write("empty.obj", ""), folder.Write("text.obj", "Hello, world\n"),
        folder.Write("empty.ply", ""), folder.Write("cut.ply", "ply\nformat ascii 1.0\n"),
        folder.Write("cloud.ply", ply_start + "1" + ply_end + std::string(12, '\0')),
        folder.Write("huge.ply", ply_start + "4000000000" + ply_end + "abcd"),
        folder.Write("lie.ply", ply_start + "9223372036854775807" + ply_end + "abcd"),
        folder.Write("no.stl", BinaryStl({}, 0)),
        folder.Write("lie.stl", BinaryStl({}, 0xffffffff)),
        folder.Write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"),
        folder.Write("index.obj", "v 0 0 0\nf 1 2 99\n"), folder.Write("scene.dae", "<xml/>"),
        folder.PathOf("none.obj"), folder.path()}) {
    const MeshResult read = ReadMesh(path);
    EXPECT_FALSE(read.mesh) << path;
    EXPECT_TRUE(Mentions(read.error, {path})) << read.error;
  }
}

TEST(MeshFileTest, FacesMayCountFromTheEndAndCarryTexture) {
  const TemporaryFolder folder;
  const MeshResult read = ReadMesh(
      folder.Write("a.obj",
                   "mtllib none.mtl\nv 0 0 0\nv 2 0 0\nv 0 2 0\nvn 0 0 1\nf -3//1 -2//1 -1//1\n"
                   "f 1/1/1 2/2/2 3/3/3\nl 1 2\n"));
  ASSERT_TRUE(read.mesh) << read.error;
  EXPECT_EQ(read.mesh->triangles.size(), 2u);
  EXPECT_NEAR(AreaOf(*read.mesh), 4.0, 1e-6);
}

// Whatever bytes are flipped or cut off: an answer, never a crash, and indices that are valid.
TEST(MeshFileTest, DamagedFilesGiveAnAnswer) {
  const TemporaryFolder folder;
  RandomValues random(5);
  const std::vector<std::pair<std::string, std::string>> files = {
      {".obj", "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4\nf -1 -2 -3\n"},
      {".stl", BinaryStl({{0, 0, 0, 2, 0, 0, 2, 2, 0}, {0, 0, 0, 2, 2, 0, 0, 2, 0}}, 2)},
      {".stl",
       "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
       "vertex 0 1 0\nendloop\nendfacet\nendsolid a\n"},
      {".ply",
       "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
       "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
       "end_header\n0 0 0\n2 0 0\n2 2 0\n3 0 1 2\n"}};
  int number = 0;
  for (const auto& [ending, good] : files) {
    ASSERT_TRUE(ReadMesh(folder.Write("good" + ending, good)).mesh);
    for (int round = 0; round < 300; ++round) {
      std::string bytes = good;
      const int last = static_cast<int>(good.size()) - 1;
      for (int flips = random.Int(1, 4); flips > 0; --flips) {
        bytes[static_cast<std::size_t>(random.Int(0, last))] =
            static_cast<char>(random.Int(0, 255));
      }
      if (random.Int(0, 3) == 0) bytes.resize(static_cast<std::size_t>(random.Int(0, last)));
      const MeshResult read = ReadMesh(folder.Write(std::to_string(number++) + ending, bytes));
      ASSERT_NE(read.mesh.has_value(), !read.error.empty());
      if (!read.mesh) continue;
      for (const Eigen::Vector3i& triangle : read.mesh->triangles) {
        EXPECT_GE(triangle.minCoeff(), 0);
        EXPECT_LT(triangle.maxCoeff(), static_cast<int>(read.mesh->vertices.size()));
      }
    }
  }
}

}  // namespace
}  // namespace rimod
