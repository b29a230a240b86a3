#pragma once

#include <array>
#include <string>

namespace rimod {

// What rimod-view draws over the range image.
struct ViewLayers {
  bool points = true;       // interest points
  bool matched = true;      // .. those that a detection explains
  bool hypotheses = false;  // poses before validation
  bool validated = true;    // poses after it
  bool detections = true;   // the models, with name and score
  bool early = true;        // what is told before the sweep has ended
  bool top = true;          // the view from above
};

// A layer by name and key.
struct ViewLayerKey {
  char key;
  const char* name;
  bool ViewLayers::*layer;
};
extern const std::array<ViewLayerKey, 7> kViewLayerKeys;

// Sets the layers to those of a list such as "points,detections"; "all" and "none" are such lists,
// too. Returns an error text, empty when done.
std::string SetLayers(const std::string& names, ViewLayers* layers);

}  // namespace rimod
