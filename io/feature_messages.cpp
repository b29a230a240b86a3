#include "io/feature_messages.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "io/message_codec.h"
#include "io/section_header.h"

namespace rimod {
namespace {

constexpr std::size_t kHeaderBytes = 100;  // fixed fields, generously; without the kind's name

// Features that a section takes.
std::size_t FeaturesPerSection(const FeatureSet& features) {
  const std::size_t fixed = kHeaderBytes + features.descriptor_kind.size();
  const std::size_t per_feature =
      6 * sizeof(float) + sizeof(std::int16_t) * static_cast<std::size_t>(features.descriptor_size);
  return std::max<std::size_t>(1, (kSectionBytes - fixed) / per_feature);
}

void CheckSet(const FeatureSet& features) {
  if (features.descriptor_size < 0 || features.descriptor_size > kMaxDescriptorSize) {
    throw std::invalid_argument("descriptor_size is " + std::to_string(features.descriptor_size) +
                                ", not within 0 .. " + std::to_string(kMaxDescriptorSize));
  }
  if (features.descriptor_kind.size() > static_cast<std::size_t>(kMaxDescriptorKindBytes)) {
    throw std::invalid_argument("descriptor_kind is longer than " +
                                std::to_string(kMaxDescriptorKindBytes) + " bytes");
  }
  for (const Feature& feature : features.features) {
    if (feature.descriptor.size() != static_cast<std::size_t>(features.descriptor_size)) {
      throw std::invalid_argument("a descriptor has " + std::to_string(feature.descriptor.size()) +
                                  " values, the set's have " +
                                  std::to_string(features.descriptor_size));
    }
  }
}

void AppendFeature(const Feature& feature, feature_set_t* section) {
  section->x.push_back(feature.position.x());
  section->y.push_back(feature.position.y());
  section->z.push_back(feature.position.z());
  section->normal_x.push_back(feature.normal.x());
  section->normal_y.push_back(feature.normal.y());
  section->normal_z.push_back(feature.normal.z());
  section->values.insert(section->values.end(), feature.descriptor.begin(),
                         feature.descriptor.end());
}

std::string CheckSection(const feature_set_t& section, const feature_set_t& first,
                         std::size_t index, std::size_t total) {
  if (section.section != static_cast<std::int32_t>(index) ||
      section.num_sections != static_cast<std::int32_t>(total)) {
    return "sections are not in order or not complete";
  }
  if (!SameHeader(section, first)) return "sections are of different feature sets";
  if (section.num_features < 0 || section.num_values < 0) return "a count is negative";
  const auto size = static_cast<std::size_t>(section.num_features);
  for (const std::vector<float>* const list :
       {&section.x, &section.y, &section.z, &section.normal_x, &section.normal_y,
        &section.normal_z}) {
    if (list->size() != size) return "a count does not fit its list";
  }
  if (section.values.size() != static_cast<std::size_t>(section.num_values) ||
      static_cast<std::int64_t>(section.num_features) * section.descriptor_size !=
          static_cast<std::int64_t>(section.num_values)) {
    return "a count does not fit its list";
  }
  return "";
}

Feature FeatureAt(const feature_set_t& section, std::size_t i) {
  Feature feature;
  feature.position = Eigen::Vector3f(section.x[i], section.y[i], section.z[i]);
  feature.normal = Eigen::Vector3f(section.normal_x[i], section.normal_y[i], section.normal_z[i]);
  const auto begin =
      section.values.begin() + static_cast<std::ptrdiff_t>(i) * section.descriptor_size;
  feature.descriptor.assign(begin, begin + section.descriptor_size);
  return feature;
}

std::string CheckFeature(const Feature& feature) {
  constexpr float kMaxLengthError = 0.01f;
  if (!feature.position.allFinite()) return "a feature's position is not finite";
  if (!(std::abs(feature.normal.norm() - 1.0f) <= kMaxLengthError)) {
    return "a feature's normal is not a unit vector";
  }
  return "";
}

}  // namespace

std::vector<feature_set_t> ToSections(const FeatureSet& features, std::int64_t utime) {
  CheckSet(features);
  const std::size_t num_features = features.features.size();
  const std::size_t per_section = FeaturesPerSection(features);
  const std::size_t num_sections =
      std::max<std::size_t>(1, (num_features + per_section - 1) / per_section);

  feature_set_t header = {};
  header.utime = utime;
  header.num_sections = static_cast<std::int32_t>(num_sections);
  header.descriptor = features.descriptor_kind;
  header.descriptor_size = features.descriptor_size;
  header.descriptor_unit = kDescriptorUnit;

  std::vector<feature_set_t> sections(num_sections, header);
  for (std::size_t i = 0; i < num_sections; ++i) {
    feature_set_t& section = sections[i];
    section.section = static_cast<std::int32_t>(i);
    const std::size_t end = std::min((i + 1) * per_section, num_features);
    for (std::size_t k = i * per_section; k < end; ++k) {
      AppendFeature(features.features[k], &section);
    }
    section.num_features = static_cast<std::int32_t>(section.x.size());
    section.num_values = static_cast<std::int32_t>(section.values.size());
  }
  return sections;
}

JoinedFeatures JoinFeatureSections(const std::vector<feature_set_t>& sections) {
  if (sections.empty()) return {std::nullopt, "no sections"};
  const feature_set_t& first = sections.front();
  if (first.descriptor_unit != kDescriptorUnit) {
    return {std::nullopt, "descriptors in another unit than ours"};
  }
  if (first.descriptor_size < 0 || first.descriptor_size > kMaxDescriptorSize ||
      first.descriptor.size() > static_cast<std::size_t>(kMaxDescriptorKindBytes)) {
    return {std::nullopt, "absurd kind of descriptor"};
  }
  FeatureSet features;
  features.descriptor_kind = first.descriptor;
  features.descriptor_size = first.descriptor_size;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    std::string error = CheckSection(sections[i], first, i, sections.size());
    for (std::size_t k = 0; error.empty() && k < sections[i].x.size(); ++k) {
      features.features.push_back(FeatureAt(sections[i], k));
      error = CheckFeature(features.features.back());
    }
    if (!error.empty()) return {std::nullopt, std::move(error)};
  }
  return {std::move(features), ""};
}

}  // namespace rimod
