#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rimod/detection.h"
#include "rimod/early_detection.h"
#include "rimod/object_model.h"
#include "rimod/scan.h"

namespace rimod {

// What the page is told, as binary frames: uint32 (little-endian) number of bytes of the header,
// the header (JSON, padded with spaces so that what follows is at a multiple of 8), then the lists
// that the header names, each at a multiple of 8. The header's "type" names the kind of frame.
// Shared by all clients, so never changed.
using Frame = std::shared_ptr<const std::string>;

// A frame without lists; header: JSON.
Frame MakeFrame(std::string header);

// The field of view of a scan, level sensor frame.
struct FieldOfView {
  double azimuth_right = 0.0, azimuth_left = 0.0;  // rad, right < left; a full circle: -pi .. pi
  double elevation_bottom = 0.0, elevation_top = 0.0;
  double range = 0.0;  // m, nine of ten points are nearer
};

// The smallest sector that holds all points and beams; zeros for an empty scan.
FieldOfView FieldOfViewOf(const Scan& scan);

// Points that a frame draws: a scan with more is thinned, each with so many on.
constexpr std::size_t kMaxDrawnPoints = 300'000;
// m from the sensor; points farther away are left out: they would make the steps of all coarse.
constexpr double kMaxDrawnRange = 300.0;

// "type": "scan", with "id", "utime" (text: it may need more than a double holds), "sensor" (pose),
// "view" (azimuth, elevation, range), "num_points" and the drawn "points": uint16 x, y, z in steps
// of "step" (m) from "origin", local frame.
Frame ScanFrame(std::int64_t id, std::int64_t utime, const Scan& scan);

// What is known of one scan's objects.
struct SceneObjects {
  std::optional<std::vector<Detection>> detections;
  int num_models = 0;  // that were looked for
  double detection_ms = 0.0;
  std::vector<PoseHypothesis> hypotheses;
  int num_hypotheses = 0;  // that were found
  std::vector<EarlyObject> early;
  std::optional<Eigen::Isometry3d> T_local_sensor;  // level
};

// Hypotheses that a frame holds, the best.
constexpr std::size_t kMaxGhosts = 400;

// "type": "objects", with the id and utime of their scan.
Frame ObjectsFrame(std::int64_t id, std::int64_t utime, const SceneObjects& objects);

// Surface points of a model that a frame draws at most.
constexpr std::size_t kMaxModelPoints = 40'000;

// "type": "model", with "name", "box", "spacing" (m, between drawn points), "points" as in a scan,
// object frame, and "normals": int8 x, y, z, 0 in steps of 1 / 127.
Frame ModelFrame(const ObjectModel& model);

}  // namespace rimod
