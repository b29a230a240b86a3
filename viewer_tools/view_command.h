#pragma once

#include <string>
#include <vector>

#include "io/channels.h"
#include "io/config.h"
#include "viewer_tools/view_layers.h"
#include "viewer_tools/view_picture.h"

namespace rimod {

// What to look at and how.
struct ViewOptions {
  std::string models;      // folder of the models that are looked for; empty: boxes only
  std::string source;      // log or scan file; empty: the bus
  std::string output;      // folder for a picture of each scan, without a window; empty: a window
  std::string save = ".";  // folder for pictures that the key s saves
  ViewLayers layers;
  double interval = 1.0;      // s that each scan of a file is shown; > 0
  double preview_rate = 2.0;  // previews sent a second at most, live; 0: none
  int max_scans = 1000;       // pictures written at most; >= 1
  std::string lcm_url;
  Channels channels;
  Configuration configuration;
};

// The style that the options ask for.
ViewStyle StyleFrom(const ViewOptions& options);

// Draws the scan and writes it as PNG into a folder, which is made when missing; prints the path on
// stdout. The file has the scan's name. False when that fails, which was told on stderr.
bool SavePicture(const ViewedScan& scan, const std::vector<ObjectModel>& models,
                 const ViewStyle& style, const std::string& folder);

// Shows until the user ends it, or writes pictures. Returns the exit code: 1 when something could
// not be read or written, no window opened or the bus not joined (told on stderr).
int RunView(const ViewOptions& options);

}  // namespace rimod
