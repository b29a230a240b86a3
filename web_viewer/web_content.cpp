#include "web_viewer/web_content.h"

#include <nlohmann/json.hpp>
#include <utility>

namespace rimod {

void WebContent::OnChange(const std::function<void()>& on_change) {
  on_change_ = on_change;
  scans_.OnChange(on_change);
}

void WebContent::SetPlayback(const Playback& playback) {
  const nlohmann::ordered_json header = {{"type", "playback"},
                                         {"playing", playback.playing},
                                         {"at_end", playback.at_end},
                                         {"position", playback.position},
                                         {"duration", playback.duration},
                                         {"speed", playback.speed},
                                         {"warning", playback.warning}};
  Frame frame =
      MakeFrame(header.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    playback_ = {playback_.version + 1, std::move(frame)};
  }
  on_change_();
}

Frame WebContent::Model(const std::string& name) const {
  const auto found = models_.find(name);
  return found == models_.end() ? nullptr : found->second;
}

ScanHistory::Part WebContent::PlaybackPart() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return playback_;
}

}  // namespace rimod
