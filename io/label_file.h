#pragma once

#include <optional>
#include <string>
#include <vector>

#include "rimod/hit_counting.h"

namespace rimod {

// The objects of one scan, as somebody labelled them.
struct LabelledScan {
  std::string scan;  // the scan's name
  std::vector<LabelledObject> objects;
};

struct LabelFile {
  std::vector<LabelledScan> scans;
  std::string error;  // the file and what is wrong with it; empty when all is well
};

// Reads {"scans":[{"scan":"000","objects":[{"class","pose":[tx,ty,tz,qw,qx,qy,qz],"points",
// "visible","distance"}]}]}; points, visible and distance may be absent, further keys are ignored.
// Anything else is an error and gives no scans.
LabelFile ReadLabelFile(const std::string& path);
LabelFile ParseLabels(const std::string& text, const std::string& name);

// The symmetry that a recording's model.json names: none where it is absent; nothing when the file
// cannot be read or names an unknown one.
std::optional<Symmetry> ReadSymmetry(const std::string& recording);

}  // namespace rimod
