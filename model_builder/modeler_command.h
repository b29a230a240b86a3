#pragma once

#include <string>

#include "io/config.h"
#include "io/process_options.h"

namespace rimod {

// What rimod-modeler was asked to do.
struct ModelerOptions {
  std::string inspect;     // model file of which a picture is wanted; one of these five is given
  std::string output;      // that picture
  std::string recording;   // folder
  std::string live;        // folder with model.json only: scans come on the bus
  std::string cloud;       // point cloud file
  std::string mesh;        // mesh file
  std::string class_name;  // empty: what the source says
  std::string out;         // model file
  int num_live_scans = 8;  // that end a live recording; >= 1
  int num_threads = 0;     // 0: as many as the machine has
  bool publish = false;    // also on RIMOD_MODEL
  BusOptions bus;
};

// Builds a model and writes it, or draws one; prints a summary on stdout, messages go to the log.
// Returns the exit code: 0 done, 1 the input could not be read or used, or the output not written
// or sent, 2 bad usage (no usable class name).
int RunModeler(const ModelerOptions& options, const Configuration& configuration);

}  // namespace rimod
