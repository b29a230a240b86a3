#include "viewer_tools/case_points.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>

#include "viewer_tools/labels.h"

namespace rimod {
namespace {

constexpr int kSide = kCasePictureSide;
constexpr int kLineHeight = 22;  // canvas pixels, of a line of text
const cv::Scalar kBackground(32, 30, 28);
const cv::Scalar kAreaColour(20, 19, 18);
const cv::Scalar kTextColour(230, 230, 230);

// A view of the place along a direction, orthographic; canvas x along right, canvas y down along
// the negative of up.
struct DrawingPlane {
  Eigen::Vector3d centre;  // m, local frame
  Eigen::Vector3d right, up;
  double pixels_per_metre = 100.0;

  cv::Point ToCanvas(const Eigen::Vector3d& p) const {
    return {kSide / 2 + ToPixels(right.dot(p - centre)), kSide / 2 - ToPixels(up.dot(p - centre))};
  }
  int ToPixels(double metres) const {
    constexpr double kFarOutside = 1e6;  // canvas pixels; labels may be anywhere
    const double pixels = metres * pixels_per_metre;
    return std::abs(pixels) < kFarOutside ? cvRound(pixels) : static_cast<int>(kFarOutside);
  }
};

void PutDot(const cv::Point& at, int size, const cv::Scalar& colour, cv::Mat* picture) {
  const cv::Rect dot = cv::Rect(at, cv::Size(size, size)) & cv::Rect(0, 0, kSide, kSide);
  if (dot.area() > 0) (*picture)(dot).setTo(colour);
}

// Where a model's points fall.
cv::Mat_<unsigned char> MaskOf(const CasePose& pose, const DrawingPlane& projection) {
  cv::Mat_<unsigned char> mask(kSide, kSide, static_cast<unsigned char>(0));
  const int size =
      std::max(2, cvRound(pose.model->point_spacing * projection.pixels_per_metre) + 1);
  for (const Eigen::Vector3f& point : pose.model->points) {
    const cv::Rect dot = cv::Rect(projection.ToCanvas(pose.T_local_object * point.cast<double>()),
                                  cv::Size(size, size)) &
                         cv::Rect(0, 0, kSide, kSide);
    if (dot.area() > 0) mask(dot) = 1;
  }
  return mask;
}

// The models, and over them the measured points within radius (m) of the centre.
cv::Mat DrawPoints(const RangeImage& image, const std::vector<CasePose>& poses,
                   const DrawingPlane& projection, double radius) {
  cv::Mat picture(kSide, kSide, CV_8UC3, kAreaColour);
  constexpr double kOpacity = 0.35;
  for (std::size_t i = poses.size(); i-- > 0;) {
    const cv::Mat_<unsigned char> mask = MaskOf(poses[i], projection);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x)
        if (mask(y, x) != 0)
          picture.at<Colour>(y, x) = Blend(picture.at<Colour>(y, x), poses[i].colour, kOpacity);
  }
  for (int row = 0; row < image.height(); ++row) {
    for (int column = 0; column < image.width(); ++column) {
      if (!image.measured(row, column)) continue;
      const Eigen::Vector3d p = image.T_local_sensor() * image.point(row, column).cast<double>();
      if ((p - projection.centre).cwiseAbs().maxCoeff() > radius) continue;
      PutDot(projection.ToCanvas(p), 2, kTextColour, &picture);
    }
  }
  const int bar = cvRound(0.1 * projection.pixels_per_metre);  // 10 cm
  const std::string text = "10 cm";
  picture(cv::Rect(0, kSide - kLineHeight, bar + TextSize(text).width + 16, kLineHeight)) =
      kBackground;
  cv::line(picture, {8, kSide - 10}, {8 + bar, kSide - 10}, kTextColour, 2);
  DrawText(&picture, text, {12 + bar, kSide - kLineHeight}, kTextColour);
  return picture;
}

}  // namespace

std::vector<cv::Mat> DrawCasePoints(const RangeImage& image, const std::vector<CasePose>& poses) {
  const CasePose& first = poses.front();
  const ObjectModel& model = *first.model;
  const double radius = std::max(0.25, 0.5 * model.Diameter() + 0.1);  // m
  DrawingPlane projection;
  projection.centre = first.T_local_object * Eigen::Vector3d(0.5 * (model.box_min + model.box_max));
  Eigen::Vector3d sight = projection.centre - image.T_local_sensor().translation();
  sight.z() = 0.0;
  if (sight.norm() < 1e-6) sight = Eigen::Vector3d::UnitX();
  sight.normalize();
  projection.pixels_per_metre = 0.5 * kSide / radius;
  projection.right = sight.cross(Eigen::Vector3d::UnitZ());
  projection.up = sight;
  std::vector<cv::Mat> views = {DrawPoints(image, poses, projection, radius)};
  projection.right = sight;
  projection.up = Eigen::Vector3d::UnitZ();
  views.push_back(DrawPoints(image, poses, projection, radius));
  return views;
}

}  // namespace rimod
