#include "viewer_tools/view_layers.h"

#include <sstream>

namespace rimod {

const std::array<ViewLayerKey, 7> kViewLayerKeys = {{
    {'p', "points", &ViewLayers::points},
    {'m', "matched", &ViewLayers::matched},
    {'h', "hypotheses", &ViewLayers::hypotheses},
    {'v', "validated", &ViewLayers::validated},
    {'d', "detections", &ViewLayers::detections},
    {'e', "early", &ViewLayers::early},
    {'t', "top", &ViewLayers::top},
}};

std::string SetLayers(const std::string& names, ViewLayers* layers) {
  ViewLayers set;
  for (const ViewLayerKey& key : kViewLayerKeys) set.*key.layer = names == "all";
  if (names != "all" && names != "none") {
    std::istringstream list(names);
    for (std::string name; std::getline(list, name, ',');) {
      bool is_known = false;
      for (const ViewLayerKey& key : kViewLayerKeys) {
        if (name != key.name) continue;
        set.*key.layer = true;
        is_known = true;
      }
      if (!is_known) return "'" + name + "' is no layer";
    }
  }
  *layers = set;
  return "";
}

}  // namespace rimod
