#pragma once

#include <cstddef>
#include <deque>
#include <string>

#include "viewer_tools/view_layers.h"
#include "viewer_tools/viewed_scan.h"

namespace rimod {

// What a person looks at: which of the last scans, with which layers. Values in, values out: keys
// and scans come from whoever has a keyboard and a pipeline.
class ViewState {
 public:
  explicit ViewState(const ViewLayers& layers) : layers_(layers) {}

  // A new scan, or more of the last one (equal utime and known_until), which it replaces. The
  // newest is shown unless paused. Scans before the last twenty are forgotten.
  void Add(ViewedScan scan);

  // A key of the keyboard as OpenCV's waitKey() gives it; others than ours are ignored.
  void HandleKey(int key);

  // Null before the first scan; valid until the next Add().
  const ViewedScan* shown() const { return scans_.empty() ? nullptr : &scans_[shown_]; }
  // "3 of 20, paused" and the like; empty while the newest is shown.
  std::string Status() const;
  const ViewLayers& layers() const { return layers_; }
  bool help() const { return help_; }
  bool paused() const { return paused_; }
  bool quit() const { return quit_; }

  // True once after the key for it.
  bool TakeSaveWish();
  // True once after a step beyond the newest scan: whoever has a log reads on.
  bool TakeNextWish();
  // Changes whenever the picture is another one.
  int version() const { return version_; }

 private:
  void Step(int direction);

  ViewLayers layers_;
  std::deque<ViewedScan> scans_;
  std::size_t shown_ = 0;
  bool help_ = true;
  bool paused_ = false;
  bool quit_ = false;
  bool wants_save_ = false;
  bool wants_next_ = false;
  int version_ = 0;
};

}  // namespace rimod
