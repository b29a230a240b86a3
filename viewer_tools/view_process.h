#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "io/raw_subscription.h"
#include "rimod/object_model.h"
#include "viewer_tools/scan_follower.h"
#include "viewer_tools/view_command.h"
#include "viewer_tools/view_screen.h"

namespace rimod {

// Follows the running pipeline: joins what it hears, draws the newest scan (into a window, or into
// files when an output folder is given) and sends previews. What comes faster than it draws is
// passed over. options and models must outlive it.
class ViewProcess {
 public:
  ViewProcess(lcm::LCM* lcm, const ViewOptions& options, const std::vector<ObjectModel>& models);

  // To be called again and again, after messages were handled.
  void OnIdle();
  bool Done() const;
  // A picture could not be written.
  bool failed() const { return failed_; }

 private:
  void OnMessage(const std::string& channel, const void* bytes, std::size_t size);
  void Complain(const std::string& channel, const std::string& cause);
  void UpdateScreen();
  void WritePictures();
  void SendPreview();

  lcm::LCM* lcm_;
  const ViewOptions& options_;
  const std::vector<ObjectModel>& models_;
  ScanFollower follower_;
  std::optional<ViewScreen> screen_;
  std::int64_t seen_version_ = 0;
  std::int64_t previewed_version_ = 0;
  std::chrono::steady_clock::time_point next_preview_;
  int num_written_ = 0;
  bool failed_ = false;
  std::set<std::string> told_;  // complaints, each once
  std::vector<std::unique_ptr<BytesSubscription>> subscriptions_;
};

}  // namespace rimod
