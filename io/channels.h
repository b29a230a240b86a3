#pragma once

#include <string>
#include <vector>

namespace rimod {

// The channels that our processes speak on. Every name can be changed on the command line.
struct Channels {
  std::string laser = "LASER";                                    // bot_core.planar_lidar_t
  std::string laser_to_local = "LASER_TO_LOCAL";                  // bot_core.rigid_transform_t
  std::string scan = "RIMOD_SCAN";                                // rimod.scan_t
  std::string range_image = "RIMOD_RANGE_IMAGE";                  // rimod.range_image_t
  std::string features = "RIMOD_FEATURES";                        // rimod.feature_set_t
  std::string model = "RIMOD_MODEL";                              // rimod.object_model_t
  std::string hypotheses = "RIMOD_HYPOTHESES";                    // rimod.pose_hypotheses_t
  std::string detections = "RIMOD_DETECTIONS";                    // rimod.detections_t
  std::string scan_ahead = "RIMOD_SCAN_AHEAD";                    // rimod.partial_scan_t
  std::string scan_end = "RIMOD_SCAN_END";                        // rimod.scan_end_t
  std::string partial_scan = "RIMOD_SCAN_PARTIAL";                // rimod.partial_scan_t
  std::string partial_range_image = "RIMOD_RANGE_IMAGE_PARTIAL";  // rimod.partial_range_image_t
  std::string partial_features = "RIMOD_FEATURES_PARTIAL";        // rimod.partial_feature_set_t
  std::string early_detections = "RIMOD_DETECTIONS_EARLY";        // rimod.early_detections_t
  std::string shards = "RIMOD_SHARDS";                            // rimod.shard_t
  std::string shard_candidates = "RIMOD_SHARD_CANDIDATES";        // rimod.shard_candidates_t
  std::string shard_scans = "RIMOD_SHARD_SCANS";                  // rimod.shard_scan_t
  std::string shard_turns = "RIMOD_SHARD_TURNS";                  // rimod.shard_turn_t
  std::string status = "RIMOD_STATUS";                            // rimod.status_t
  std::string preview = "RIMOD_PREVIEW";                          // bot_core.image_t
};

// Where scans come as point clouds; names of the user's own. Empty: none.
struct CloudChannels {
  std::string clouds;  // bot_core.pointcloud2_t
  std::string poses;   // bot_core.rigid_transform_t, the carrier's; empty: it stands at the origin
};

// Whether LCM and our messages take a name for a channel: 1 to 63 printable characters, no spaces.
bool IsUsableChannelName(const std::string& name);

// Applies one renaming "RIMOD_SCAN=OTHER", the left side being one of the default names. Returns an
// error text, empty when done: no such channel, or a name that is empty, longer than LCM takes (63)
// or holds characters that are not printable.
std::string RenameChannel(const std::string& renaming, Channels* channels);

// All default names, in the order above.
std::vector<std::string> DefaultChannelNames();

}  // namespace rimod
