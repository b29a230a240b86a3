#include "viewer_tools/view_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "rimod/range_patch.h"
#include "viewer_tools/labels.h"
#include "viewer_tools/matched_features.h"

namespace rimod {
namespace {

constexpr int kBorder = 12;      // canvas pixels
constexpr int kLineHeight = 22;  // of a line of text
const cv::Scalar kBackground(32, 30, 28);
const cv::Scalar kTextColour(230, 230, 230);
const cv::Scalar kFaintText(165, 165, 165);
const cv::Scalar kPlate(48, 46, 44);
const Colour kPointColour(255, 255, 255);

template <typename... Values>
std::string Format(const char* format, Values... values) {
  char text[256];
  std::snprintf(text, sizeof(text), format, values...);
  return text;
}

const ObjectModel* FindModel(const std::vector<ObjectModel>& models, const std::string& name) {
  for (const ObjectModel& model : models)
    if (model.name == name) return &model;
  return nullptr;
}

// The same colour for a class in every layer and scan: that of its place among the models, or among
// all names that the scan has.
class ClassColours {
 public:
  ClassColours(const ViewedScan& scan, const std::vector<ObjectModel>& models) {
    for (const ObjectModel& model : models) indices_.emplace(model.name, 0);
    if (scan.hypotheses)
      for (const PoseHypothesis& hypothesis : scan.hypotheses->listed)
        indices_.emplace(hypothesis.class_name, 0);
    if (scan.detections)
      for (const Detection& detection : scan.detections->detections)
        indices_.emplace(detection.class_name, 0);
    if (scan.early)
      for (const EarlyObject& object : scan.early->objects)
        indices_.emplace(object.detection.class_name, 0);
    int index = 0;
    for (auto& [name, value] : indices_) value = index++;
  }
  Colour Of(const std::string& name) const { return ObjectColour(indices_.at(name)); }

 private:
  std::map<std::string, int> indices_;
};

// Hypotheses name a pose only: the box is the model's, or a small one where there is no model.
DrawnObject OutlineOf(const PoseHypothesis& hypothesis, const ObjectModel* model,
                      const Colour& colour) {
  constexpr double kUnknownSize = 0.1;  // m
  DrawnObject outline;
  outline.colour = colour;
  outline.detection.class_name = hypothesis.class_name;
  outline.detection.T_local_object = hypothesis.T_local_object;
  outline.detection.box_min = model ? model->box_min : Eigen::Vector3d::Constant(-kUnknownSize);
  outline.detection.box_max = model ? model->box_max : Eigen::Vector3d::Constant(kUnknownSize);
  return outline;
}

class ViewContents {
 public:
  ViewContents(const ViewedScan& scan, const std::vector<ObjectModel>& models,
               const ViewStyle& style)
      : scan_(scan), models_(models), style_(style), colours_(scan, models) {}

  std::vector<DrawnObject> Objects() const {
    std::vector<DrawnObject> objects;
    if (style_.layers.detections && scan_.detections) {
      for (const Detection& detection : scan_.detections->detections)
        Add(detection, /*is_provisional=*/false, &objects);
    }
    if (style_.layers.early && scan_.early && !scan_.detections) {
      for (const EarlyObject& object : scan_.early->objects)
        if (object.status != EarlyStatus::kWithdrawn)
          Add(object.detection, /*is_provisional=*/true, &objects);
    }
    return objects;
  }

  PictureExtras Extras() const {
    PictureExtras extras;
    extras.range_image_width = style_.range_image_width;
    extras.top_view_side = style_.top_view_side;
    AddPoints(&extras);
    if (!scan_.hypotheses) return extras;
    for (const bool validated : {false, true}) {
      if (!(validated ? style_.layers.validated : style_.layers.hypotheses)) continue;
      for (const PoseHypothesis& hypothesis : scan_.hypotheses->listed) {
        if ((hypothesis.stage == HypothesisStage::kValidated) != validated) continue;
        DrawnObject outline = OutlineOf(hypothesis, FindModel(models_, hypothesis.class_name),
                                        colours_.Of(hypothesis.class_name));
        outline.is_provisional = !validated;
        extras.outlines.push_back(std::move(outline));
      }
    }
    return extras;
  }

  // What the scan holds, in words.
  std::string Summary() const {
    std::string text;
    if (scan_.features) text += Format("%zu interest points  |  ", scan_.features->features.size());
    if (scan_.hypotheses) {
      const auto& listed = scan_.hypotheses->listed;
      const auto num_validated = std::count_if(
          listed.begin(), listed.end(),
          [](const PoseHypothesis& h) { return h.stage == HypothesisStage::kValidated; });
      text += Format("%d hypotheses found, %zu listed, %td validated  |  ",
                     scan_.hypotheses->num_found, listed.size(), num_validated);
    }
    if (scan_.detections) {
      text += Format("%zu objects found, %d models looked for", scan_.detections->detections.size(),
                     scan_.detections->num_models);
    } else if (scan_.early) {
      const auto num_told = std::count_if(
          scan_.early->objects.begin(), scan_.early->objects.end(),
          [](const EarlyObject& object) { return object.status != EarlyStatus::kWithdrawn; });
      text += Format("the sweep goes on: %td objects told so far", num_told);
    } else {
      text += "no detections yet";
    }
    return text;
  }

 private:
  void Add(const Detection& detection, bool is_provisional,
           std::vector<DrawnObject>* objects) const {
    DrawnObject object;
    object.detection = detection;
    object.model = FindModel(models_, detection.class_name);
    object.colour = colours_.Of(detection.class_name);
    object.label = detection.class_name + Format(" %.2f", detection.score);
    if (is_provisional) object.label += " so far";
    object.is_provisional = is_provisional;
    objects->push_back(std::move(object));
  }

  void AddPoints(PictureExtras* extras) const {
    if (!scan_.features) return;
    if (style_.layers.points) {
      for (const Feature& feature : scan_.features->features)
        extras->points.push_back({feature.position.cast<double>(), kPointColour, false});
    }
    if (!style_.layers.matched || !scan_.detections) return;
    const Eigen::Isometry3d T_sensor_local = scan_.image->T_local_sensor().inverse();
    for (const Detection& detection : scan_.detections->detections) {
      const ObjectModel* const model = FindModel(models_, detection.class_name);
      if (model == nullptr) continue;
      for (const int index :
           MatchedFeatures(*scan_.features, *model, T_sensor_local * detection.T_local_object)) {
        extras->points.push_back({scan_.features->features[index].position.cast<double>(),
                                  colours_.Of(detection.class_name), true});
      }
    }
  }

  const ViewedScan& scan_;
  const std::vector<ObjectModel>& models_;
  const ViewStyle& style_;
  ClassColours colours_;
};

std::string TitleOf(const ViewedScan& scan, const std::string& status) {
  std::string title = scan.name.empty() ? "scan " + std::to_string(scan.utime) : scan.name;
  if (scan.is_partial())
    title += Format(", %.1f s of a sweep that goes on",
                    1e-6 * static_cast<double>(scan.known_until - scan.utime));
  return title + ", " + std::to_string(scan.image->width()) + " x " +
         std::to_string(scan.image->height()) + " pixels" + (status.empty() ? "" : "  |  ") +
         status;
}

std::string LayerText(const ViewLayerKey& key, const ViewLayers& layers) {
  return std::string("[") + key.key + "] " + key.name + (layers.*key.layer ? " on" : " off");
}

constexpr char kKeys[] =
    "[space] pause / go on   [n] next   [b] back   [s] save   [?] these lines   [q] quit";
constexpr char kLegend[] =
    "dot: interest point   disc: one that a detection explains   thin dashed: hypothesis   thin: "
    "validated   thick: detection   thick dashed: told early";

int NeededWidth(const std::string& summary, const ViewStyle& style) {
  int width = TextSize(summary).width;
  if (style.for_screen && style.help) width = std::max(width, TextSize(kLegend).width);
  return width + 2 * kBorder;
}

// The keys of the layers, those that are off fainter, the marks' meaning and the other keys.
void DrawHelp(const ViewLayers& layers, cv::Point corner, cv::Mat* canvas) {
  const int left = corner.x;
  for (const ViewLayerKey& key : kViewLayerKeys) {
    const std::string text = LayerText(key, layers);
    DrawText(canvas, text, corner, layers.*key.layer ? kTextColour : kFaintText);
    corner.x += TextSize(text).width + kBorder;
  }
  for (const char* const line : {kLegend, kKeys}) {
    corner = {left, corner.y + kLineHeight};
    DrawText(canvas, line, corner, kFaintText);
  }
}

}  // namespace

ViewPicture DrawView(const ViewedScan& scan, const std::vector<ObjectModel>& models,
                     const ViewStyle& style, const std::string& status) {
  const ViewContents contents(scan, models, style);
  const std::vector<DrawnObject> objects = contents.Objects();
  const PictureExtras extras = contents.Extras();
  ViewPicture picture;
  const cv::Mat range_image = DrawRangeImage(*scan.image, objects, TitleOf(scan, status), extras);
  picture.range_image = LayOutRangeImage(*scan.image, extras.range_image_width);
  cv::Size upper = range_image.size();
  cv::Mat top_view;
  if (style.layers.top) {
    top_view = DrawTopView(*scan.image, objects, "", extras);
    picture.top_view = LayOutTopView(*scan.image, objects, extras.top_view_side);
    picture.top_view_corner = cv::Point(upper.width, 0);
    upper = {upper.width + top_view.cols, std::max(upper.height, top_view.rows)};
  }
  const std::string summary = contents.Summary();
  const int width = std::max(upper.width, NeededWidth(summary, style));
  const int num_lines = !style.for_screen ? 1 : style.help ? 5 : 2;
  picture.canvas =
      cv::Mat(upper.height + num_lines * kLineHeight + kBorder, width, CV_8UC3, kBackground);
  range_image.copyTo(picture.canvas(cv::Rect({0, 0}, range_image.size())));
  if (style.layers.top)
    top_view.copyTo(picture.canvas(cv::Rect(picture.top_view_corner, top_view.size())));
  cv::Point corner(kBorder, upper.height);
  DrawText(&picture.canvas, summary, corner, kTextColour);
  if (!style.for_screen) return picture;
  corner.y += kLineHeight;
  picture.readout = cv::Rect(kBorder, corner.y, width - 2 * kBorder, kLineHeight);
  DrawReadOut("", &picture);
  if (style.help) DrawHelp(style.layers, {corner.x, corner.y + kLineHeight}, &picture.canvas);
  return picture;
}

cv::Mat DrawWaiting(const std::string& text) {
  cv::Mat canvas(240, 1000, CV_8UC3, kBackground);
  DrawText(&canvas, text, {kBorder, 90}, kTextColour);
  DrawText(&canvas, "[q] quit", {kBorder, 90 + kLineHeight}, kFaintText);
  return canvas;
}

std::string ReadOut(const ViewedScan& scan, const ViewPicture& picture, const cv::Point& mouse) {
  constexpr double kDegPerRad = 180.0 / M_PI;
  constexpr double kNormalRadius = 0.1;  // m, of the points that the normal is told from
  constexpr int kMinPoints = 8;
  const RangeImage& image = *scan.image;
  if (picture.top_view && (picture.top_view->area + picture.top_view_corner).contains(mouse)) {
    const cv::Point at = mouse - picture.top_view_corner - picture.top_view->area.tl();
    return Format("from above: x %.2f, y %.2f m, local frame",
                  picture.top_view->max_x - at.y / picture.top_view->pixels_per_metre,
                  picture.top_view->max_y - at.x / picture.top_view->pixels_per_metre);
  }
  if (!picture.range_image.area.contains(mouse)) return "";
  const cv::Point at = mouse - picture.range_image.area.tl();
  const PixelIndex pixel{at.y / picture.range_image.scale, at.x / picture.range_image.scale};
  if (!image.grid().Contains(pixel.row, pixel.column)) return "";
  const Direction direction = PixelDirection(image.grid(), pixel.row + 0.5, pixel.column + 0.5);
  std::string text =
      Format("row %d, column %d: azimuth %+.1f, elevation %+.1f deg", pixel.row, pixel.column,
             direction.azimuth * kDegPerRad, direction.elevation * kDegPerRad);
  if (!image.measured(pixel.row, pixel.column)) {
    const bool no_return = image.pixel(pixel.row, pixel.column) == Pixel::kNoReturn;
    return text + (no_return ? ", no return" : ", never observed");
  }
  const Eigen::Vector3d p_local =
      image.T_local_sensor() * image.point(pixel.row, pixel.column).cast<double>();
  text += Format(", range %.3f m, point (%.2f, %.2f, %.2f) m", image.range(pixel.row, pixel.column),
                 p_local.x(), p_local.y(), p_local.z());
  const std::optional<Eigen::Vector3d> normal = NormalAt(image, pixel, kNormalRadius, kMinPoints);
  if (!normal) return text + ", no normal";
  const Eigen::Vector3d n_local = image.T_local_sensor().linear() * *normal;
  return text + Format(", normal (%+.2f, %+.2f, %+.2f), local frame", n_local.x(), n_local.y(),
                       n_local.z());
}

void DrawReadOut(const std::string& text, ViewPicture* picture) {
  picture->canvas(picture->readout).setTo(kPlate);
  DrawText(&picture->canvas, text.empty() ? "point with the mouse: range, point, normal" : text,
           picture->readout.tl(), text.empty() ? kFaintText : kTextColour);
}

}  // namespace rimod
