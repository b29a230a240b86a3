#include "io/model_messages.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "io/feature_messages.h"
#include "io/message_codec.h"
#include "io/section_header.h"

namespace rimod {
namespace {

constexpr std::size_t kFixedBytes = 400;  // of an encoded section, without its strings; generously
constexpr std::size_t kMaxSourceBytes = 1000;

constexpr std::size_t kPointBytes = 6 * sizeof(float);  // with normal
constexpr std::size_t kViewBytes = 3 * sizeof(double) + 3 * sizeof(std::int32_t);
constexpr std::size_t kOutsidePointBytes = 3 * sizeof(float);

void Require(bool condition, const std::string& complaint) {
  if (!condition) throw std::invalid_argument("object model: " + complaint);
}

void Append(const Eigen::Vector3f& v, std::vector<float>* x, std::vector<float>* y,
            std::vector<float>* z) {
  x->push_back(v.x());
  y->push_back(v.y());
  z->push_back(v.z());
}

// Cuts a model's lists into sections: whatever is added goes into the last section that has room.
class SectionWriter {
 public:
  explicit SectionWriter(const object_model_t& header) : header_(header) {
    budget_ = kSectionBytes - kFixedBytes - header.name.size() - header.source.size() -
              header.descriptor.size();
    StartSection();
  }

  void AddPoint(const Eigen::Vector3f& point, const Eigen::Vector3f& normal) {
    object_model_t& section = RoomFor(kPointBytes);
    Append(point, &section.x, &section.y, &section.z);
    Append(normal, &section.normal_x, &section.normal_y, &section.normal_z);
  }

  void AddView(const ModelView& view) {
    model_view_t message = {};
    for (int i = 0; i < 3; ++i) message.viewpoint[i] = view.viewpoint[i];
    message.num_features = static_cast<std::int32_t>(view.features.size());
    message.num_validation_points = static_cast<std::int32_t>(view.validation_points.size());
    message.num_outside_points = static_cast<std::int32_t>(view.outside_points.size());
    RoomFor(kViewBytes).views.push_back(message);
  }

  void AddFeature(const Feature& feature) {
    object_model_t& section =
        RoomFor(kPointBytes + sizeof(std::int16_t) * feature.descriptor.size());
    Append(feature.position, &section.feature_x, &section.feature_y, &section.feature_z);
    Append(feature.normal, &section.feature_normal_x, &section.feature_normal_y,
           &section.feature_normal_z);
    section.values.insert(section.values.end(), feature.descriptor.begin(),
                          feature.descriptor.end());
  }

  void AddValidationPoint(const Eigen::Vector3f& point, const Eigen::Vector3f& normal) {
    object_model_t& section = RoomFor(kPointBytes);
    Append(point, &section.validation_x, &section.validation_y, &section.validation_z);
    Append(normal, &section.validation_normal_x, &section.validation_normal_y,
           &section.validation_normal_z);
  }

  void AddOutsidePoint(const Eigen::Vector3f& point) {
    object_model_t& section = RoomFor(kOutsidePointBytes);
    Append(point, &section.outside_x, &section.outside_y, &section.outside_z);
  }

  // The sections with their numbers and counts set.
  std::vector<object_model_t> Finish() {
    for (std::size_t i = 0; i < sections_.size(); ++i) {
      object_model_t& section = sections_[i];
      section.section = static_cast<std::int32_t>(i);
      section.num_sections = static_cast<std::int32_t>(sections_.size());
      section.num_points = static_cast<std::int32_t>(section.x.size());
      section.num_views = static_cast<std::int32_t>(section.views.size());
      section.num_features = static_cast<std::int32_t>(section.feature_x.size());
      section.num_values = static_cast<std::int32_t>(section.values.size());
      section.num_validation_points = static_cast<std::int32_t>(section.validation_x.size());
      section.num_outside_points = static_cast<std::int32_t>(section.outside_x.size());
    }
    return std::move(sections_);
  }

 private:
  void StartSection() {
    sections_.push_back(header_);
    used_ = 0;
  }

  object_model_t& RoomFor(std::size_t bytes) {
    if (used_ > 0 && used_ + bytes > budget_) StartSection();
    used_ += bytes;
    return sections_.back();
  }

  object_model_t header_;
  std::size_t budget_ = 0;  // bytes of list entries in a section
  std::size_t used_ = 0;    // of the last section
  std::vector<object_model_t> sections_;
};

object_model_t HeaderFrom(const ObjectModel& model, std::int64_t utime) {
  object_model_t header = {};
  header.utime = utime;
  header.name = model.name;
  header.source = model.source;
  for (int i = 0; i < 3; ++i) header.box_min[i] = model.box_min[i];
  for (int i = 0; i < 3; ++i) header.box_max[i] = model.box_max[i];
  header.point_spacing = model.point_spacing;
  header.descriptor = model.descriptor_kind;
  header.descriptor_size = model.descriptor_size;
  header.descriptor_unit = kDescriptorUnit;
  return header;
}

// True when every list of a section is as long as its count says.
bool CountsFit(const object_model_t& s) {
  const auto fits = [](std::int32_t count, std::initializer_list<std::size_t> sizes) {
    return count >= 0 && std::all_of(sizes.begin(), sizes.end(), [count](std::size_t size) {
             return size == static_cast<std::size_t>(count);
           });
  };
  return fits(s.num_points, {s.x.size(), s.y.size(), s.z.size(), s.normal_x.size(),
                             s.normal_y.size(), s.normal_z.size()}) &&
         fits(s.num_views, {s.views.size()}) &&
         fits(s.num_features,
              {s.feature_x.size(), s.feature_y.size(), s.feature_z.size(),
               s.feature_normal_x.size(), s.feature_normal_y.size(), s.feature_normal_z.size()}) &&
         fits(s.num_values, {s.values.size()}) &&
         static_cast<std::int64_t>(s.num_features) * s.descriptor_size == s.num_values &&
         fits(s.num_validation_points,
              {s.validation_x.size(), s.validation_y.size(), s.validation_z.size(),
               s.validation_normal_x.size(), s.validation_normal_y.size(),
               s.validation_normal_z.size()}) &&
         fits(s.num_outside_points, {s.outside_x.size(), s.outside_y.size(), s.outside_z.size()});
}

// The sections 0 .. n - 1 in order. Returns an error text.
std::string OrderSections(const std::vector<object_model_t>& sections,
                          std::vector<const object_model_t*>* ordered) {
  if (sections.empty()) return "no sections";
  const object_model_t& first = sections.front();
  constexpr std::int32_t kMaxSections = 100'000;
  if (first.num_sections < 1 || first.num_sections > kMaxSections)
    return "absurd number of sections";
  ordered->assign(static_cast<std::size_t>(first.num_sections), nullptr);
  for (const object_model_t& section : sections) {
    if (!SameHeader(section, first)) return "sections are of different models";
    if (section.section < 0 || section.section >= first.num_sections) {
      return "a section's number is out of range";
    }
    const object_model_t*& place = (*ordered)[static_cast<std::size_t>(section.section)];
    if (place && EncodeMessage(*place) != EncodeMessage(section)) {
      return "section " + std::to_string(section.section) + " is there twice and differs";
    }
    place = &section;
  }
  const auto missing = std::find(ordered->begin(), ordered->end(), nullptr);
  if (missing == ordered->end()) return "";
  return "section " + std::to_string(missing - ordered->begin()) + " of " +
         std::to_string(ordered->size()) + " is missing";
}

// Every list of the model, continued over the sections.
struct JoinedLists {
  std::vector<model_view_t> views;
  std::vector<Feature> features;
  std::vector<Eigen::Vector3f> validation_points;
  std::vector<Eigen::Vector3f> validation_normals;
  std::vector<Eigen::Vector3f> outside_points;
};

void AppendSection(const object_model_t& s, ObjectModel* model, JoinedLists* lists) {
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    model->points.emplace_back(s.x[i], s.y[i], s.z[i]);
    model->normals.emplace_back(s.normal_x[i], s.normal_y[i], s.normal_z[i]);
  }
  lists->views.insert(lists->views.end(), s.views.begin(), s.views.end());
  for (std::size_t i = 0; i < s.feature_x.size(); ++i) {
    Feature feature;
    feature.position = Eigen::Vector3f(s.feature_x[i], s.feature_y[i], s.feature_z[i]);
    feature.normal =
        Eigen::Vector3f(s.feature_normal_x[i], s.feature_normal_y[i], s.feature_normal_z[i]);
    const auto begin = s.values.begin() + static_cast<std::ptrdiff_t>(i) * s.descriptor_size;
    feature.descriptor.assign(begin, begin + s.descriptor_size);
    lists->features.push_back(std::move(feature));
  }
  for (std::size_t i = 0; i < s.validation_x.size(); ++i) {
    lists->validation_points.emplace_back(s.validation_x[i], s.validation_y[i], s.validation_z[i]);
    lists->validation_normals.emplace_back(s.validation_normal_x[i], s.validation_normal_y[i],
                                           s.validation_normal_z[i]);
  }
  for (std::size_t i = 0; i < s.outside_x.size(); ++i)
    lists->outside_points.emplace_back(s.outside_x[i], s.outside_y[i], s.outside_z[i]);
}

// Moves the next count entries out of a list; false when it has fewer left.
template <typename T>
bool TakeNext(std::vector<T>* list, std::int32_t count, std::size_t* next, std::vector<T>* taken) {
  if (count < 0 || static_cast<std::size_t>(count) > list->size() - *next) return false;
  const auto begin = std::make_move_iterator(list->begin() + static_cast<std::ptrdiff_t>(*next));
  taken->assign(begin, begin + count);
  *next += static_cast<std::size_t>(count);
  return true;
}

// Hands the features and points out to their views. Returns an error text.
std::string FillViews(JoinedLists* lists, ObjectModel* model) {
  std::size_t next_feature = 0, next_point = 0, next_normal = 0, next_outside = 0;
  model->views.reserve(lists->views.size());
  for (const model_view_t& message : lists->views) {
    ModelView view;
    view.viewpoint = Eigen::Vector3d(message.viewpoint);
    const std::int32_t num_points = message.num_validation_points;
    if (!TakeNext(&lists->features, message.num_features, &next_feature, &view.features) ||
        !TakeNext(&lists->validation_points, num_points, &next_point, &view.validation_points) ||
        !TakeNext(&lists->validation_normals, num_points, &next_normal, &view.validation_normals) ||
        !TakeNext(&lists->outside_points, message.num_outside_points, &next_outside,
                  &view.outside_points)) {
      return "a view counts features or points that are not there";
    }
    model->views.push_back(std::move(view));
  }
  const bool all_used = next_feature == lists->features.size() &&
                        next_point == lists->validation_points.size() &&
                        next_outside == lists->outside_points.size();
  return all_used ? "" : "features or points that belong to no view";
}

}  // namespace

std::vector<object_model_t> ToSections(const ObjectModel& model, std::int64_t utime) {
  ValidateModel(model);
  Require(model.source.size() <= kMaxSourceBytes, "source is too long a text");
  Require(model.descriptor_size >= 0 && model.descriptor_size <= kMaxDescriptorSize,
          "descriptors are too large");
  Require(model.descriptor_kind.size() <= static_cast<std::size_t>(kMaxDescriptorKindBytes),
          "kind of descriptor is too long a text");
  SectionWriter writer(HeaderFrom(model, utime));
  for (std::size_t i = 0; i < model.points.size(); ++i) {
    writer.AddPoint(model.points[i], model.normals[i]);
  }
  for (const ModelView& view : model.views) writer.AddView(view);
  for (const ModelView& view : model.views) {
    for (const Feature& feature : view.features) writer.AddFeature(feature);
  }
  for (const ModelView& view : model.views) {
    for (std::size_t i = 0; i < view.validation_points.size(); ++i)
      writer.AddValidationPoint(view.validation_points[i], view.validation_normals[i]);
  }
  for (const ModelView& view : model.views) {
    for (const Eigen::Vector3f& point : view.outside_points) writer.AddOutsidePoint(point);
  }
  return writer.Finish();
}

JoinedModel JoinModelSections(const std::vector<object_model_t>& sections) {
  std::vector<const object_model_t*> ordered;
  std::string error = OrderSections(sections, &ordered);
  if (!error.empty()) return {std::nullopt, std::move(error)};
  const object_model_t& first = *ordered.front();
  if (first.descriptor_unit != kDescriptorUnit) {
    return {std::nullopt, "descriptors in another unit than ours"};
  }
  if (first.descriptor_size < 0 || first.descriptor_size > kMaxDescriptorSize) {
    return {std::nullopt, "absurd size of descriptors"};
  }
  ObjectModel model;
  model.name = first.name;
  model.source = first.source;
  model.box_min = Eigen::Vector3d(first.box_min);
  model.box_max = Eigen::Vector3d(first.box_max);
  model.point_spacing = first.point_spacing;
  model.descriptor_kind = first.descriptor;
  model.descriptor_size = first.descriptor_size;
  JoinedLists lists;
  std::size_t num_points = 0;
  for (const object_model_t* const section : ordered) num_points += section->x.size();
  model.points.reserve(num_points);
  model.normals.reserve(num_points);
  for (const object_model_t* const section : ordered) {
    if (!CountsFit(*section)) return {std::nullopt, "a count does not fit its list"};
    AppendSection(*section, &model, &lists);
  }
  error = FillViews(&lists, &model);
  if (!error.empty()) return {std::nullopt, std::move(error)};
  try {
    ValidateModel(model);
  } catch (const std::invalid_argument& invalid) {
    return {std::nullopt, invalid.what()};
  }
  return {std::move(model), ""};
}

}  // namespace rimod
