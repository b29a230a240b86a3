#include "viewer_tools/scan_pictures.h"

#include "viewer_tools/html.h"
#include "viewer_tools/pictures.h"
#include "viewer_tools/png.h"

namespace rimod {
namespace {

void AddMissed(const CountedScan& scan, const HitCount& count,
               const std::vector<ObjectModel>& models, std::vector<DrawnObject>* objects) {
  for (std::size_t i = 0; i < scan.objects.size(); ++i) {
    if (!count.objects[0][i].counts || count.objects[0][i].found()) continue;
    Detection at_label;
    at_label.class_name = scan.objects[i].class_name;
    at_label.T_local_object = scan.objects[i].T_local_object;
    DrawnObject missed = MakeDrawnObjects({at_label}, models).front();
    if (missed.model == nullptr) continue;
    missed.detection.box_min = missed.model->box_min;
    missed.detection.box_max = missed.model->box_max;
    missed.colour = Colour(245, 245, 245);
    missed.label = at_label.class_name + ", missed";
    objects->push_back(missed);
  }
}

std::string ToUri(const cv::Mat& picture) { return DataUri("image/png", EncodePng(picture)); }

}  // namespace

std::vector<std::pair<std::string, std::string>> DrawScan(const std::string& name,
                                                          const RangeImage& image,
                                                          const CountedScan& scan,
                                                          const std::optional<HitCount>& count,
                                                          const std::vector<ObjectModel>& models) {
  std::vector<DrawnObject> objects = MakeDrawnObjects(scan.detections, models);
  if (count) {
    for (std::size_t i = 0; i < objects.size(); ++i) {
      const Verdict verdict = count->detections[0][i].verdict;
      if (verdict != Verdict::kRight) objects[i].label += std::string(", ") + VerdictText(verdict);
    }
    AddMissed(scan, *count, models, &objects);
  }
  return {{"range image", ToUri(DrawRangeImage(image, objects, name + ": range image"))},
          {"seen from above", ToUri(DrawTopView(image, objects, name + ": from above"))}};
}

}  // namespace rimod
