#pragma once

#include <cstdint>
#include <vector>

#include "drake/lcmt_point_cloud.hpp"
#include "drake/lcmt_viewer_draw.hpp"
#include "drake/lcmt_viewer_load_robot.hpp"
#include "rimod/detection.h"
#include "rimod/range_image.h"

namespace rimod {

// A scan for meldis, the viewer of Drake (python3 -m pydrake.visualization.meldis), in its own
// messages; all in the local frame.

// Where meldis listens.
constexpr char kMeldisLoadChannel[] = "DRAKE_VIEWER_LOAD_ROBOT";
constexpr char kMeldisDrawChannel[] = "DRAKE_VIEWER_DRAW";
constexpr char kMeldisCloudChannel[] = "DRAKE_POINT_CLOUD_RIMOD";

// A translucent box a detection, in its class's colour, named by class and rank; a ball for the
// sensor. As many detections as fit into a message, the best ones.
drake::lcmt_viewer_load_robot MeldisScene(const std::vector<Detection>& detections);

// Where these boxes and the ball are. utime: us, the scan's.
drake::lcmt_viewer_draw MeldisPoses(const std::vector<Detection>& detections,
                                    const Eigen::Isometry3d& T_local_sensor, std::int64_t utime);

// The image's points, coloured by distance as in our pictures. Where they are more than a message
// holds (kMaxMessageBytes), every second one, every third ..
drake::lcmt_point_cloud MeldisCloud(const RangeImage& image, std::int64_t utime);

}  // namespace rimod
