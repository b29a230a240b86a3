#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rimod/detection.h"

namespace rimod {

// A line of rimod-detect's output. The box is not in it and stays empty.
struct DetectionLine {
  std::string scan;  // the scan's name
  Detection detection;
};

struct ParsedDetectionLine {
  std::optional<DetectionLine> line;
  std::string error;  // the cause; empty when there is a line
};

// Parses {"scan":"000","class":"fan","pose":[tx,ty,tz,qw,qx,qy,qz],"score":0.83}; further keys are
// ignored. Missing keys, numbers that are not finite, quaternions that are not unit within 1 % and
// names that are not valid give an error.
ParsedDetectionLine ParseDetectionLine(const std::string& text);

struct DetectionLines {
  std::vector<DetectionLine> lines;
  std::string error;  // the file, the first bad line and its cause; empty when all is well
};

// Reads a file of such lines; empty ones are skipped, bad ones left out.
DetectionLines ReadDetectionLines(const std::string& path);

}  // namespace rimod
