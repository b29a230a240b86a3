#include "viewer_tools/view_state.h"

#include <utility>

namespace rimod {
namespace {

constexpr std::size_t kMaxScans = 20;
constexpr int kEscape = 27;
constexpr int kNoKey = -1;
constexpr int kKeyBits = 0xff;  // above stand modifiers

}  // namespace

void ViewState::Add(ViewedScan scan) {
  ++version_;
  if (!scans_.empty() && scans_.back().utime == scan.utime &&
      scans_.back().known_until == scan.known_until) {
    scans_.back() = std::move(scan);
    return;
  }
  scans_.push_back(std::move(scan));
  if (scans_.size() > kMaxScans) {
    scans_.pop_front();
    if (shown_ > 0) --shown_;
  }
  if (!paused_) shown_ = scans_.size() - 1;
}

void ViewState::HandleKey(int key) {
  if (key == kNoKey) return;
  ++version_;
  const int letter = key & kKeyBits;
  for (const ViewLayerKey& layer : kViewLayerKeys)
    if (letter == layer.key) layers_.*layer.layer = !(layers_.*layer.layer);
  switch (letter) {
    case ' ':
      paused_ = !paused_;
      if (!paused_ && !scans_.empty()) shown_ = scans_.size() - 1;
      break;
    case 'n':
      Step(+1);
      break;
    case 'b':
      Step(-1);
      break;
    case 's':
      wants_save_ = true;
      break;
    case '?':
      help_ = !help_;
      break;
    case 'q':
    case kEscape:
      quit_ = true;
      break;
    default:
      break;
  }
}

void ViewState::Step(int direction) {
  paused_ = true;
  if (direction < 0) {
    if (shown_ > 0) --shown_;
  } else if (shown_ + 1 < scans_.size()) {
    ++shown_;
  } else {
    wants_next_ = true;
  }
}

std::string ViewState::Status() const {
  if (scans_.empty() || (!paused_ && shown_ + 1 == scans_.size())) return "";
  return std::to_string(shown_ + 1) + " of the last " + std::to_string(scans_.size()) +
         (paused_ ? ", paused" : "");
}

bool ViewState::TakeSaveWish() { return std::exchange(wants_save_, false); }

bool ViewState::TakeNextWish() { return std::exchange(wants_next_, false); }

}  // namespace rimod
