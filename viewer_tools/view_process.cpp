#include "viewer_tools/view_process.h"

#include <spdlog/spdlog.h>

#include <utility>

#include "io/message_codec.h"
#include "viewer_tools/preview.h"

namespace rimod {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kQueueCapacity = 1000;  // some whole scans, in sections
constexpr int kPreviewWidth = 1200;   // canvas pixels
constexpr std::size_t kMaxTold = 64;  // different complaints
constexpr int kPollMs = 10;

}  // namespace

ViewProcess::ViewProcess(lcm::LCM* lcm, const ViewOptions& options,
                         const std::vector<ObjectModel>& models)
    : lcm_(lcm),
      options_(options),
      models_(models),
      follower_(options.channels, options.configuration.bus) {
  if (options.output.empty()) screen_.emplace(options, models);
  SubscriptionObserver observer;
  observer.on_received = [](const std::string&) {};
  observer.on_rejected = [this](const std::string& channel, const std::string& cause) {
    Complain(channel, cause);
  };
  for (const std::string& name : follower_.channel_names()) {
    subscriptions_.push_back(std::make_unique<BytesSubscription>(
        lcm, name, kQueueCapacity, observer,
        [this, name](const void* bytes, std::size_t size) { OnMessage(name, bytes, size); }));
  }
}

void ViewProcess::OnMessage(const std::string& channel, const void* bytes, std::size_t size) {
  const std::string cause = follower_.Take(channel, bytes, size, Clock::now());
  if (!cause.empty()) Complain(channel, cause);
}

void ViewProcess::Complain(const std::string& channel, const std::string& cause) {
  const bool is_new = told_.size() < kMaxTold && told_.insert(channel + ": " + cause).second;
  if (is_new) spdlog::warn("{}: message left out: {}", channel, cause);
}

bool ViewProcess::Done() const {
  return screen_ ? screen_->Ended() : num_written_ >= options_.max_scans;
}

void ViewProcess::OnIdle() {
  if (screen_) {
    UpdateScreen();
  } else {
    WritePictures();
  }
  if (options_.preview_rate > 0.0) SendPreview();
}

void ViewProcess::UpdateScreen() {
  if (follower_.newest_version() != seen_version_) {
    seen_version_ = follower_.newest_version();
    if (follower_.newest() != nullptr) screen_->state().Add(*follower_.newest());
  }
  screen_->Poll(kPollMs);
}

void ViewProcess::WritePictures() {
  const std::vector<ViewedScan> finished = follower_.TakeFinished();
  if (finished.empty() || Done()) return;
  ++num_written_;
  if (!SavePicture(finished.back(), models_, StyleFrom(options_), options_.output)) failed_ = true;
}

void ViewProcess::SendPreview() {
  const auto now = Clock::now();
  if (follower_.newest() == nullptr || follower_.newest_version() == previewed_version_ ||
      now < next_preview_)
    return;
  previewed_version_ = follower_.newest_version();
  next_preview_ = now + std::chrono::duration_cast<Clock::duration>(
                            std::chrono::duration<double>(1.0 / options_.preview_rate));
  ViewStyle style = StyleFrom(options_);
  style.for_screen = false;
  const cv::Mat picture = DrawView(*follower_.newest(), models_, style, "").canvas;
  const auto preview = MakePreview(picture, follower_.newest()->utime, kPreviewWidth);
  if (!preview) return;
  const std::vector<std::uint8_t> bytes = EncodeMessage(*preview);
  lcm_->publish(options_.channels.preview, bytes.data(), static_cast<unsigned>(bytes.size()));
}

}  // namespace rimod
