#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/channels.h"
#include "rimod/sweep.h"
#include "scanner_proc/scene.h"

namespace rimod::simulation {

// Files to write; an empty path: not wanted.
struct SweepFiles {
  std::string log;    // LCM log of both channels, event times = message times
  std::string pcd;    // the assembled cloud; several sweeps: NAME#0.pcd, NAME#1.pcd, ..
  std::string truth;  // JSON, ground truth a sweep

  bool any() const { return !log.empty() || !pcd.empty() || !truth.empty(); }
};

struct SweepFilesResult {
  std::vector<std::string> errors;  // each names a file; empty when all went well
  bool stopped = false;             // by the stop flag: log and truth were not written
  std::int64_t num_lines = 0;
  std::vector<std::size_t> num_points;  // of each sweep's cloud
};

// The parameters to assemble this sensor's sweeps with: base with what the sensor knows better.
SweepParams SweepParamsFor(const Sensor& sensor, SweepParams base);

// Scans num_sweeps sweeps of the scene and writes them. The same scene gives the same bytes.
SweepFilesResult WriteSweeps(const Scene& scene, int num_sweeps, const Channels& channels,
                             const SweepParams& params, const SweepFiles& files,
                             const std::atomic<bool>& stop);

// Writes a recording of the scene's only object of a class into the folder, which is made: a
// scan_NNN.pcd from each viewpoint round it and, when all are there, model.json. Returns an error
// text, empty when done.
std::string WriteRecording(const Scene& scene, const SweepParams& params, const std::string& folder,
                           const std::atomic<bool>& stop);

// The sensor poses of a recording of the object. Throws std::invalid_argument when the sensor would
// stand in the object's origin.
std::vector<Sensor> RecordingSensors(const Scene& scene, const SceneObject& object);

}  // namespace rimod::simulation
