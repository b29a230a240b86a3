#include "viewer_tools/png.h"

#include <opencv2/imgcodecs.hpp>
#include <vector>

namespace rimod {

std::string EncodePng(const cv::Mat& picture) {
  std::vector<unsigned char> bytes;
  if (picture.empty() || !cv::imencode(".png", picture, bytes, {cv::IMWRITE_PNG_COMPRESSION, 9}))
    return "";
  return {bytes.begin(), bytes.end()};
}

}  // namespace rimod
