#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "rimod/model_building.h"

// Scene, ray, part, .. mean other things in the library: the simulator has a namespace of its own.
namespace rimod::simulation {

// Shapes that parts are made of, metres. Each stands on the origin of its part: the origin is the
// middle of the bounding box's bottom face, z up.

struct BoxShape {
  Eigen::Vector3d size = Eigen::Vector3d::Ones();  // along x, y, z; > 0
};

// A cylinder when both radii are equal, a cone when one is 0.
struct FrustumShape {
  double bottom_radius = 0.5;  // >= 0
  double top_radius = 0.5;     // >= 0
  double height = 1.0;         // > 0
};

struct SphereShape {
  double radius = 0.5;  // > 0
};

// Without thickness, in the part's x-y plane, seen from both sides.
struct RectangleShape {
  Eigen::Vector2d size = Eigen::Vector2d::Ones();  // along x, y; > 0
};

// Triangles, seen from both sides.
struct MeshShape {
  std::shared_ptr<const Mesh> mesh;  // never null; vertices as they stand in the part
};

using Shape = std::variant<BoxShape, FrustumShape, SphereShape, RectangleShape, MeshShape>;

struct Part {
  Shape shape;
  Eigen::Isometry3d T_object_part = Eigen::Isometry3d::Identity();
  double reflectivity =
      0.6;  // share of the light that comes back from a surface hit squarely; 0 .. 1
};

struct SceneObject {
  std::string name;               // for people
  std::string class_name;         // empty: not told as ground truth
  std::string symmetry = "none";  // none, yaw2, yaw4, yaw_continuous
  Eigen::Isometry3d T_scene_object = Eigen::Isometry3d::Identity();
  std::vector<Part> parts;
};

// A line scanner on a unit that tilts steadily, like a SICK LMS 2xx.
struct Sensor {
  Eigen::Vector3d position = {0.0, 0.0, 1.1};  // m, of the laser, scene frame
  double yaw = 0.0;                            // rad, direction of the level laser's x-axis
  double tilt_start = -M_PI / 6.0;             // rad, at the first line's start; > 0 looks down
  double tilt_end = M_PI / 3.0;                // rad, at the last line's start
  double tilt_step = M_PI / 720.0;             // rad from one line to the next; > 0
  double line_period = 0.02667;                // s, from one line's first beam to the next line's
  double first_angle = -M_PI / 2.0;            // rad, first beam of even lines
  double angle_step = M_PI / 360.0;            // rad, from one beam to the next
  int num_beams = 361;                         // of a line; beam i at i / num_beams * line_period
  bool interlaced = true;    // odd lines begin half an angle_step later and have a beam less
  double max_range = 80.0;   // m, farther surfaces give no return
  double no_return = 81.91;  // m, what the scanner says then
  double pause = 0.0;        // s, rest of the tilt between sweeps
  double speed = 0.0;        // m/s, of the carrier along its heading
  double turn_rate = 0.0;    // rad/s, of the carrier to the left
};

// What makes readings differ from the truth. All zero: exact.
struct Noise {
  double range_sigma = 0.0;      // m
  double range_step = 0.0;       // m, readings are whole multiples; 0: not rounded
  double angle_sigma = 0.0;      // rad, of a beam's direction, each way
  double beam_divergence = 0.0;  // rad, whole opening angle of a beam
  int rays_per_beam = 1;  // spread over the beam; edges give mixed readings with more than one
  double mixing_distance =
      0.0;                   // m, surfaces in a beam nearer to each other than this are averaged
  double drop_out = 0.0;     // share of readings lost at random
  double dark_signal = 0.0;  // readings with a signal about this weak are lost; see LaserScanner
};

// How a recording of a scene's only object of a class is made.
struct RecordingPlan {
  int num_views = 8;            // evenly round the object
  double distance = 0.0;        // m, from the object's origin; 0: that of the scene's sensor
  std::vector<double> heights;  // m, of the sensor, in turn; empty: that of the scene's sensor
};

struct Scene {
  std::string name;
  std::uint64_t seed = 1;
  std::int64_t start_utime = 1000000000000000;  // us, first beam in logs
  Sensor sensor;
  Noise noise;
  RecordingPlan recording;
  std::vector<SceneObject> objects;  // the room's walls are one of them
};

// Smallest axis-aligned box in the object's frame that holds its parts.
Eigen::AlignedBox3d BoundingBox(const SceneObject& object);

// The object frame of models and labels: origin at the middle of the bounding box's bottom face,
// axes as the object's.
struct ObjectFrame {
  Eigen::Isometry3d T_scene_object = Eigen::Isometry3d::Identity();
  Eigen::AlignedBox3d box;  // in that frame
};
ObjectFrame ObjectFrameOf(const SceneObject& object);

// Triangles in the part's frame.
Mesh TrianglesOf(const BoxShape& box);
Mesh TrianglesOf(const RectangleShape& rectangle);

}  // namespace rimod::simulation
