#include "io/partial_messages.h"

#include <utility>

namespace rimod {
namespace {

template <typename Partial, typename Section>
std::vector<Partial> Wrap(std::int64_t sweep_utime, std::vector<Section> sections) {
  std::vector<Partial> partials;
  for (Section& section : sections) {
    Partial partial = {};
    partial.utime = sweep_utime;
    partial.section = std::move(section);
    partials.push_back(std::move(partial));
  }
  return partials;
}

}  // namespace

std::vector<partial_scan_t> ToPartialSections(const SweepGrowth& growth) {
  const StampedScan scan = {growth.begin.count(), growth.end.count(), growth.num_lines, 0,
                            growth.scan};
  std::vector<partial_scan_t> partials =
      Wrap<partial_scan_t>(growth.sweep_begin.count(), ToSections(scan));
  for (partial_scan_t& partial : partials) partial.step = growth.step;
  return partials;
}

JoinedSweepGrowth SweepGrowthFrom(std::int64_t sweep_utime, int step,
                                  const std::vector<scan_t>& sections) {
  JoinedScan joined = JoinScanSections(sections);
  if (!joined.scan) return {std::nullopt, std::move(joined.error)};
  if (joined.scan->utime < sweep_utime) return {std::nullopt, "grows before its sweep begins"};
  if (step < 0) return {std::nullopt, "has a negative step"};
  SweepGrowth growth;
  growth.sweep_begin = Time(sweep_utime);
  growth.step = step;
  growth.begin = Time(joined.scan->utime);
  growth.end = Time(joined.scan->utime_end);
  growth.num_lines = joined.scan->num_lines;
  growth.scan = std::move(joined.scan->scan);
  return {std::move(growth), ""};
}

std::vector<partial_range_image_t> ToPartialSections(const RangeImage& image,
                                                     std::int64_t sweep_utime,
                                                     std::int64_t known_until) {
  return Wrap<partial_range_image_t>(sweep_utime, ToSections(image, known_until));
}

std::vector<partial_feature_set_t> ToPartialSections(const FeatureSet& features,
                                                     std::int64_t sweep_utime,
                                                     std::int64_t known_until) {
  return Wrap<partial_feature_set_t>(sweep_utime, ToSections(features, known_until));
}

}  // namespace rimod
