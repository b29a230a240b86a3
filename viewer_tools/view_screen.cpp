#include "viewer_tools/view_screen.h"

namespace rimod {
namespace {

constexpr auto kRedrawPeriod = std::chrono::milliseconds(100);

}  // namespace

ViewScreen::ViewScreen(const ViewOptions& options, const std::vector<ObjectModel>& models)
    : options_(options), models_(models), state_(options.layers), window_("rimod-view") {
  window_.Show(DrawWaiting(options.source.empty()
                               ? "waiting for range images on " + options.channels.range_image
                               : "reading " + options.source));
}

void ViewScreen::Poll(int ms) {
  state_.HandleKey(window_.Poll(ms));
  if (state_.shown() == nullptr) return;
  if (state_.TakeSaveWish()) {
    ViewStyle style = StyleFrom(options_);
    style.layers = state_.layers();
    style.help = state_.help();
    SavePicture(*state_.shown(), models_, style, options_.save);
  }
  const auto now = std::chrono::steady_clock::now();
  if (state_.version() != drawn_version_ && now - drawn_at_ >= kRedrawPeriod) {
    Draw();
    drawn_at_ = now;
    return;
  }
  if (!picture_.canvas.empty() && window_.mouse() != read_out_at_) FollowMouse();
}

void ViewScreen::Draw() {
  ViewStyle style = StyleFrom(options_);
  style.layers = state_.layers();
  style.help = state_.help();
  picture_ = DrawView(*state_.shown(), models_, style, state_.Status());
  drawn_version_ = state_.version();
  FollowMouse();
}

void ViewScreen::FollowMouse() {
  read_out_at_ = window_.mouse();
  // What was drawn may be an older scan than what is chosen now: the next picture says it.
  if (drawn_version_ == state_.version())
    DrawReadOut(ReadOut(*state_.shown(), picture_, read_out_at_), &picture_);
  window_.Show(picture_.canvas);
}

}  // namespace rimod
