#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

namespace rimod {

// A window on the screen; one at a time, of the main thread.
class ViewWindow {
 public:
  // Why no window can be opened here, and what to do; empty when one can.
  static std::string WhyNot();

  // Must not be called where WhyNot() gives a reason: the toolkit would end the process.
  explicit ViewWindow(std::string title);
  ~ViewWindow();
  ViewWindow(const ViewWindow&) = delete;
  ViewWindow& operator=(const ViewWindow&) = delete;

  void Show(const cv::Mat& picture);
  // Lets the window work for so long, ms. Returns the key that was pressed, -1: none.
  int Poll(int ms);
  // False after the user has closed it.
  bool IsOpen() const;
  // Where the mouse is, canvas pixels of the picture shown; (-1, -1) before it came.
  cv::Point mouse() const { return mouse_; }

 private:
  static void OnMouse(int event, int x, int y, int flags, void* self);

  std::string title_;
  cv::Point mouse_{-1, -1};
};

}  // namespace rimod
