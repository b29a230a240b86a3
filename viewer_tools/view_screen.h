#pragma once

#include <chrono>
#include <vector>

#include "rimod/object_model.h"
#include "viewer_tools/view_command.h"
#include "viewer_tools/view_state.h"
#include "viewer_tools/view_window.h"

namespace rimod {

// The window with what a person looks at. options and models must outlive it.
class ViewScreen {
 public:
  ViewScreen(const ViewOptions& options, const std::vector<ObjectModel>& models);

  ViewState& state() { return state_; }
  // Does what the keyboard asks for and draws what has changed, ten times a second at most; waits
  // for so long, ms.
  void Poll(int ms);
  bool Ended() const { return state_.quit() || !window_.IsOpen(); }
  // The picture shown; empty before the first scan.
  const cv::Mat& canvas() const { return picture_.canvas; }

 private:
  void Draw();
  void FollowMouse();

  const ViewOptions& options_;
  const std::vector<ObjectModel>& models_;
  ViewState state_;
  ViewWindow window_;
  ViewPicture picture_;
  int drawn_version_ = -1;
  std::chrono::steady_clock::time_point drawn_at_;
  cv::Point read_out_at_{-1, -1};
};

}  // namespace rimod
