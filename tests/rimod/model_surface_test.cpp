#include "rimod/model_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "rimod/point_tree.h"
#include "tests/support/executions.h"
#include "tests/support/matchers.h"
#include "tests/support/ray_caster.h"

namespace rimod {
namespace {

ModelSurfaceParams Params() {
  ModelSurfaceParams params;
  params.point_spacing = 0.01;
  params.box_margin = 0.02;
  params.ground_clearance = 0.02;
  params.normal_radius = 0.03;
  params.see_through = 0.05;
  params.min_neighbours = 4;
  return params;
}

void ExpectSound(const Surface& surface) {
  ASSERT_EQ(surface.points.size(), surface.normals.size());
  EXPECT_TRUE(std::isfinite(surface.point_spacing));
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    ASSERT_TRUE(surface.points[i].allFinite() && surface.normals[i].allFinite()) << i;
    ASSERT_NEAR(surface.normals[i].norm(), 1.0f, 1e-4f) << i;
  }
}

// --- recordings ------------------------------------------------------------------------------

// An armchair of two boxes: a seat 0.6 x 0.5 x 0.3 m and a back 0.1 m thick and 0.7 m high. Its
// bounding box is half air.
const Eigen::Vector3d kSeatHalf(0.3, 0.25, 0.15), kBackHalf(0.05, 0.25, 0.35);
const Eigen::Vector3d kSeatMiddle(0.0, 0.0, 0.15), kBackMiddle(-0.25, 0.0, 0.35);

double DistanceToBox(const Eigen::Vector3d& p, const Eigen::Vector3d& half) {
  const Eigen::Vector3d q = p.cwiseAbs() - half;
  return q.maxCoeff() > 0.0 ? q.cwiseMax(0.0).norm() : q.maxCoeff();  // negative inside
}

// Distance from the surface, object frame; negative inside.
double DistanceToArmchair(const Eigen::Vector3d& p) {
  return std::min(DistanceToBox(p - kSeatMiddle, kSeatHalf),
                  DistanceToBox(p - kBackMiddle, kBackHalf));
}

Recording RecordArmchair(double noise) {
  Recording recording;
  recording.class_name = "armchair";
  recording.T_local_object = Placed(1.0, -2.0, 0.5, 0.7);
  recording.box_min = Eigen::Vector3d(-0.3, -0.25, 0.0);
  recording.box_max = Eigen::Vector3d(0.3, 0.25, 0.7);
  World world;
  world.planes = {{Eigen::Vector3d(0, 0, 0.5), Eigen::Vector3d::UnitZ()}};
  BoxShape seat, back;
  seat.T_local_box = recording.T_local_object * Eigen::Translation3d(kSeatMiddle);
  seat.half_size = kSeatHalf;
  back.T_local_box = recording.T_local_object * Eigen::Translation3d(kBackMiddle);
  back.half_size = kBackHalf;
  world.boxes = {seat, back};
  for (int i = 0; i < 8; ++i) {
    const double angle = 2.0 * M_PI * i / 8;
    const Eigen::Vector3d position = recording.T_local_object.translation() +
                                     Eigen::Vector3d(2 * std::cos(angle), 2 * std::sin(angle), 1.0);
    BeamPattern pattern;
    pattern.azimuth_min = -0.35;
    pattern.azimuth_max = 0.35;
    pattern.elevation_min = -0.75;
    pattern.elevation_max = 0.05;
    pattern.noise = noise;
    pattern.seed = 100 + i;
    recording.scans.push_back(
        ScanWorld(world, LookAt(position, recording.T_local_object.translation()), pattern));
  }
  return recording;
}

// Without noise.
const Surface& ArmchairSurface() {
  static const Surface surface = SurfaceOfRecording(RecordArmchair(0.0), Params(), Execution{});
  return surface;
}

TEST(SurfaceOfRecordingTest, PointsLieOnTheFacesWithOutwardNormals) {
  const Surface& surface = ArmchairSurface();
  ExpectSound(surface);
  EXPECT_GT(surface.points.size(), 5000u);
  int off = 0, inward = 0;
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    const Eigen::Vector3d p = surface.points[i].cast<double>();
    off += std::abs(DistanceToArmchair(p)) > 0.012;
    const Eigen::Vector3d outside = p + 0.03 * surface.normals[i].cast<double>();
    inward += DistanceToArmchair(outside) < 0.0;
  }
  const int count = static_cast<int>(surface.points.size());
  EXPECT_LT(off, count / 100);
  EXPECT_LT(inward, count / 100);
}

TEST(SurfaceOfRecordingTest, CoversAllThatWasSeen) {
  const Surface& surface = ArmchairSurface();
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3f& p : surface.points) points.push_back(p.cast<double>());
  const PointTree tree(points);
  // The middles of the seat's top and front and of the back's rear, top and sides.
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(0.05, 0, 0.3), Eigen::Vector3d(0.3, 0, 0.15), Eigen::Vector3d(-0.3, 0, 0.4),
        Eigen::Vector3d(-0.25, 0, 0.7), Eigen::Vector3d(-0.25, 0.25, 0.5),
        Eigen::Vector3d(-0.2, 0, 0.5)})
    EXPECT_LT(tree.DistanceToNearest(p, 1), 0.02) << p.transpose();
}

TEST(SurfaceOfRecordingTest, TheFloorIsRemoved) {
  const Surface& surface = ArmchairSurface();
  for (const Eigen::Vector3f& p : surface.points) EXPECT_GT(p.z(), 0.015f);
}

TEST(SurfaceOfRecordingTest, NoiseIsEvenedOut) {
  const Surface surface = SurfaceOfRecording(RecordArmchair(0.006), Params(), Execution{});
  ExpectSound(surface);
  double sum_sq = 0.0;
  for (const Eigen::Vector3f& p : surface.points)
    sum_sq += std::pow(DistanceToArmchair(p.cast<double>()), 2);
  EXPECT_LT(std::sqrt(sum_sq / static_cast<double>(surface.points.size())), 0.006);
}

TEST(SurfaceOfRecordingTest, FlyingPixelsAreRemoved) {
  // Points in the air above the seat, each reported by one scan: the others look through them.
  Recording recording = RecordArmchair(0.0);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> x(-0.15, 0.25), y(-0.2, 0.2), z(0.4, 0.65);
  for (Scan& scan : recording.scans) {
    for (int i = 0; i < 60; ++i) {
      const Eigen::Vector3d p =
          recording.T_local_object * Eigen::Vector3d(x(random), y(random), z(random));
      scan.points.push_back(p.cast<float>());
    }
  }
  const Surface surface = SurfaceOfRecording(recording, Params(), Execution{});
  int flying = 0;
  for (const Eigen::Vector3f& p : surface.points)
    flying += DistanceToArmchair(p.cast<double>()) > 0.05;
  EXPECT_LE(flying, 24);  // of 480: few others look through some of them
}

TEST(SurfaceOfRecordingTest, PointsAreAboutAsFarApartAsTold) {
  ModelSurfaceParams params = Params();
  params.point_spacing = 0.03;
  const Surface coarse = SurfaceOfRecording(RecordArmchair(0.0), params, Execution{});
  const Surface& fine = ArmchairSurface();
  EXPECT_LT(coarse.points.size(), fine.points.size() / 3);
  EXPECT_GE(coarse.point_spacing, 0.03);
  EXPECT_LT(coarse.point_spacing, 0.05);
}

TEST(SurfaceOfRecordingTest, ThreadsDoNotMatter) {
  const Recording recording = RecordArmchair(0.004);
  const Surface alone = SurfaceOfRecording(recording, Params(), Execution{});
  for (const Execution& execution : {OnThreads(4), Backwards()}) {
    const Surface other = SurfaceOfRecording(recording, Params(), execution);
    EXPECT_EQ(other.points, alone.points);
    EXPECT_EQ(other.normals, alone.normals);
    EXPECT_EQ(other.point_spacing, alone.point_spacing);
  }
}

TEST(SurfaceOfRecordingTest, NothingInTheBoxIsNoSurface) {
  Recording recording;
  EXPECT_TRUE(SurfaceOfRecording(recording, Params(), Execution{}).points.empty());
  recording = RecordArmchair(0.0);
  recording.T_local_object.translation().z() += 5.0;
  EXPECT_TRUE(SurfaceOfRecording(recording, Params(), Execution{}).points.empty());
  for (Scan& scan : recording.scans) scan.points.clear();
  EXPECT_TRUE(SurfaceOfRecording(recording, Params(), Execution{}).points.empty());
}

// --- clouds ----------------------------------------------------------------------------------

std::vector<Eigen::Vector3f> PlaneCloud(int side, float spacing) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      points.push_back({spacing * static_cast<float>(i), spacing * static_cast<float>(j), 0.5f});
  return points;
}

TEST(SurfaceOfPointsTest, EveryPointHasBothSides) {
  const Surface surface = SurfaceOfPoints(PlaneCloud(40, 0.01f), Params());
  ExpectSound(surface);
  int up = 0, down = 0;
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    EXPECT_NEAR(surface.points[i].z(), 0.5f, 1e-5f);
    EXPECT_NEAR(std::abs(surface.normals[i].z()), 1.0f, 1e-4f);
    (surface.normals[i].z() > 0.0f ? up : down) += 1;
  }
  EXPECT_EQ(up, down);
  EXPECT_GT(up, 1200);
  EXPECT_NEAR(surface.point_spacing, 0.01, 0.003);
}

TEST(SurfaceOfPointsTest, SparseCloudsGetTheirOwnSpacing) {
  const Surface surface = SurfaceOfPoints(PlaneCloud(20, 0.05f), Params());
  ExpectSound(surface);
  EXPECT_GT(surface.points.size(), 600u);
  EXPECT_NEAR(surface.point_spacing, 0.05, 0.005);
}

TEST(SurfaceOfPointsTest, DuplicatesCountOnce) {
  std::vector<Eigen::Vector3f> points = PlaneCloud(30, 0.01f);
  const Surface once = SurfaceOfPoints(points, Params());
  const std::vector<Eigen::Vector3f> copy = points;
  for (int i = 0; i < 4; ++i) points.insert(points.end(), copy.begin(), copy.end());
  const Surface often = SurfaceOfPoints(points, Params());
  EXPECT_EQ(often.points.size(), once.points.size());
}

TEST(SurfaceOfPointsTest, PointsThatAreNoNumbersAreLeftOut) {
  std::vector<Eigen::Vector3f> points = PlaneCloud(30, 0.01f);
  const Surface clean = SurfaceOfPoints(points, Params());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  points.insert(points.begin() + 100, {{nan, 0.1f, 0.5f}, {0.1f, 0.1f, infinite}});
  points.insert(points.end(), 50, Eigen::Vector3f(nan, nan, nan));
  const Surface surface = SurfaceOfPoints(points, Params());
  ExpectSound(surface);
  EXPECT_EQ(surface.points, clean.points);
}

TEST(SurfaceOfPointsTest, DegenerateCloudsGiveNoNonsense) {
  std::vector<Eigen::Vector3f> line;
  for (int i = 0; i < 300; ++i) line.push_back({0.005f * static_cast<float>(i), 0.0f, 0.0f});
  for (const std::vector<Eigen::Vector3f>& points :
       {std::vector<Eigen::Vector3f>{},
        {Eigen::Vector3f(1, 2, 3)},
        std::vector<Eigen::Vector3f>(1000, Eigen::Vector3f(1, 2, 3)),
        line})
    ExpectSound(SurfaceOfPoints(points, Params()));
}

// --- meshes ----------------------------------------------------------------------------------

Mesh CubeMesh(double size) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back(size * Eigen::Vector3d(i & 1, (i >> 1) & 1, (i >> 2) & 1));
  const int faces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                           {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
  for (const auto& f : faces) {
    mesh.triangles.push_back({f[0], f[1], f[2]});
    mesh.triangles.push_back({f[0], f[2], f[3]});
  }
  return mesh;
}

Mesh OneTriangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return {{a, b, c}, {{0, 1, 2}}};
}

// Largest distance of random points of the triangle from the surface's points.
double LargestGap(const Mesh& mesh, const Surface& surface) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3f& p : surface.points) points.push_back(p.cast<double>());
  const PointTree tree(points);
  std::mt19937 generator(2);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double largest = 0.0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    for (int i = 0; i < 300; ++i) {
      double u = unit(generator), v = unit(generator);
      if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
      const Eigen::Vector3d p = mesh.vertices[t[0]] +
                                u * (mesh.vertices[t[1]] - mesh.vertices[t[0]]) +
                                v * (mesh.vertices[t[2]] - mesh.vertices[t[0]]);
      largest = std::max(largest, tree.DistanceToNearest(p, 1));
    }
  }
  return largest;
}

TEST(SurfaceOfMeshTest, CoversACubeOnBothSides) {
  const Surface surface = SurfaceOfMesh(CubeMesh(0.4), Params());
  ExpectSound(surface);
  EXPECT_LT(LargestGap(CubeMesh(0.4), surface), 0.02);
  // 6 faces of 40 x 40 points, twice; more where the sides' cells meet.
  EXPECT_GT(surface.points.size(), 15000u);
  EXPECT_LT(surface.points.size(), 35000u);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    sum += surface.normals[i];
    const Eigen::Vector3f middle = (surface.points[i] - Eigen::Vector3f::Constant(0.2f)).cwiseAbs();
    EXPECT_NEAR(middle.maxCoeff(), 0.2f, 0.01f);
  }
  EXPECT_LT(sum.norm(), 0.01f * static_cast<float>(surface.points.size()));
}

TEST(SurfaceOfMeshTest, CoversTrianglesOfAnyShape) {
  for (const Mesh& mesh : {OneTriangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
                           OneTriangle({0, 0, 0}, {1, 0, 0}, {0.5, 1e-4, 0}),
                           OneTriangle({0, 0, 0}, {1e-4, 0, 0}, {0, 0, 1}),
                           OneTriangle({0, 0, 0}, {2, 0, 0}, {1.9, 0.3, 0}),
                           OneTriangle({0, 0, 0}, {0.001, 0, 0}, {0, 0.001, 0})}) {
    const Surface surface = SurfaceOfMesh(mesh, Params());
    ExpectSound(surface);
    EXPECT_FALSE(surface.points.empty());
    EXPECT_LT(LargestGap(mesh, surface), 0.02);
  }
}

TEST(SurfaceOfMeshTest, TrianglesWithoutAreaAreLeftOut) {
  for (const Mesh& mesh : {Mesh{}, OneTriangle({0, 0, 0}, {0, 0, 0}, {0, 0, 0}),
                           OneTriangle({0, 0, 0}, {1, 1, 1}, {2, 2, 2}),
                           OneTriangle({0, 0, 0}, {1, 0, 0}, {1, 0, 0})}) {
    const Surface surface = SurfaceOfMesh(mesh, Params());
    ExpectSound(surface);
    EXPECT_LE(surface.points.size(), 1000u);
  }
}

TEST(SurfaceOfMeshTest, VerticesThatAreNoNumbersDoNotGetThrough) {
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e300}) {
    Mesh mesh = CubeMesh(0.4);
    mesh.vertices[3].y() = bad;
    try {
      ExpectSound(SurfaceOfMesh(mesh, Params()));
    } catch (const std::invalid_argument&) {
    }
  }
}

TEST(SurfaceOfMeshTest, HugeMeshesGetAWiderSpacing) {
  const Surface house = SurfaceOfMesh(CubeMesh(100.0), Params());
  ExpectSound(house);
  EXPECT_GT(house.points.size(), 10000u);
  EXPECT_LT(house.points.size(), 1'000'000u);
  EXPECT_GT(house.point_spacing, 0.1);
}

TEST(SurfaceOfMeshTest, ManySliversDoNotMakeManyPoints) {
  Mesh mesh;
  const int count = 20000;
  for (int i = 0; i < count; ++i) {
    const double x = 1e-5 * i;
    mesh.vertices.insert(mesh.vertices.end(), {{x, 0, 0}, {x + 1e-5, 0, 0}, {x, 1, 0}});
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const Surface surface = SurfaceOfMesh(mesh, Params());
  ExpectSound(surface);
  EXPECT_LT(surface.points.size(), 100'000u);
}

TEST(SurfaceOfMeshTest, IndicesOutsideThrow) {
  Mesh mesh = CubeMesh(0.4);
  mesh.triangles.push_back({0, 1, 8});
  EXPECT_THROW(SurfaceOfMesh(mesh, Params()), std::exception);
  mesh.triangles.back() = {0, 1, -1};
  EXPECT_THROW(SurfaceOfMesh(mesh, Params()), std::exception);
}

}  // namespace
}  // namespace rimod
