#include "viewer_tools/view_window.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <opencv2/highgui.hpp>
#include <utility>

namespace rimod {
namespace {

constexpr int kWindowFlags = cv::WINDOW_AUTOSIZE | cv::WINDOW_GUI_NORMAL;

// Tries in a child process, which the toolkit may end as it likes.
bool CanOpenWindow() {
  const pid_t child = fork();
  if (child < 0) return false;
  if (child == 0) {
    const int nowhere = open("/dev/null", O_WRONLY);
    if (nowhere >= 0) {
      dup2(nowhere, STDERR_FILENO);
      dup2(nowhere, STDOUT_FILENO);
    }
    try {
      cv::namedWindow("rimod-view", kWindowFlags);
    } catch (const cv::Exception&) {
      _exit(1);
    }
    _exit(0);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return false;
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

std::string ViewWindow::WhyNot() {
  const std::string advice = ": rimod-view is a window; --output DIR writes pictures without one";
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr)
    return "DISPLAY is not set" + advice;
  return CanOpenWindow() ? "" : "no window can be opened on this screen" + advice;
}

ViewWindow::ViewWindow(std::string title) : title_(std::move(title)) {
  cv::namedWindow(title_, kWindowFlags);
  cv::setMouseCallback(title_, &ViewWindow::OnMouse, this);
}

ViewWindow::~ViewWindow() { cv::destroyAllWindows(); }

void ViewWindow::Show(const cv::Mat& picture) { cv::imshow(title_, picture); }

int ViewWindow::Poll(int ms) { return cv::waitKey(ms); }

bool ViewWindow::IsOpen() const { return cv::getWindowProperty(title_, cv::WND_PROP_VISIBLE) > 0; }

void ViewWindow::OnMouse(int /*event*/, int x, int y, int /*flags*/, void* self) {
  static_cast<ViewWindow*>(self)->mouse_ = {x, y};
}

}  // namespace rimod
