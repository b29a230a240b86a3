#include "viewer_tools/preview.h"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "io/message_codec.h"

namespace rimod {
namespace {

constexpr std::size_t kFixedBytes = 1000;  // fields other than the data, generously

bot_core::image_t ToMessage(const cv::Size& size, std::vector<unsigned char> jpeg,
                            std::int64_t utime) {
  bot_core::image_t message = {};
  message.utime = utime;
  message.width = size.width;
  message.height = size.height;
  message.row_stride = 0;  // compressed
  message.pixelformat = bot_core::image_t::PIXEL_FORMAT_MJPEG;
  message.size = static_cast<std::int32_t>(jpeg.size());
  message.data = std::move(jpeg);
  return message;
}

}  // namespace

std::optional<bot_core::image_t> MakePreview(const cv::Mat& picture, std::int64_t utime,
                                             int max_width) {
  if (picture.empty()) return std::nullopt;
  cv::Mat scaled = picture;
  if (picture.cols > max_width) {
    const double scale = static_cast<double>(max_width) / picture.cols;
    cv::resize(picture, scaled, {max_width, std::max(1, cvRound(picture.rows * scale))}, 0.0, 0.0,
               cv::INTER_AREA);
  }
  while (true) {
    for (const int quality : {90, 75, 60}) {
      std::vector<unsigned char> jpeg;
      if (!cv::imencode(".jpg", scaled, jpeg, {cv::IMWRITE_JPEG_QUALITY, quality}))
        return std::nullopt;
      if (jpeg.size() + kFixedBytes <= static_cast<std::size_t>(kMaxMessageBytes))
        return ToMessage(scaled.size(), std::move(jpeg), utime);
    }
    cv::Mat half;
    cv::resize(scaled, half, {std::max(1, scaled.cols / 2), std::max(1, scaled.rows / 2)}, 0.0, 0.0,
               cv::INTER_AREA);
    scaled = half;
  }
}

}  // namespace rimod
