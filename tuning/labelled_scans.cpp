#include "tuning/labelled_scans.h"

#include <algorithm>
#include <set>
#include <utility>

#include "io/label_file.h"
#include "io/stoppable.h"

namespace rimod {
namespace {

constexpr std::size_t kMaxScans = 5000;  // a range image of each is kept

using Labels = std::map<std::string, std::vector<LabelledObject>>;

// Adds the scans of one source; returns an error text.
std::string AddSource(const std::string& path, int source, const ScanSourceParams& params,
                      const Labels& labels, const std::atomic<bool>& stop, LabelledInputs* inputs) {
  std::string error;
  const auto on_scan = [&](NamedScan scan) {
    if (stop) throw Stopped();
    const auto label = labels.find(scan.name);
    if (label == labels.end()) {
      ++inputs->num_unlabelled;
    } else if (inputs->scans.size() >= kMaxScans) {
      error = path + ": more than " + std::to_string(kMaxScans) + " labelled scans";
    } else {
      inputs->scans.push_back({scan.name, source, std::move(scan.scan), label->second});
    }
  };
  const ScanSourceReport report = ReadScans(path, params, on_scan);
  inputs->warnings.insert(inputs->warnings.end(), report.warnings.begin(), report.warnings.end());
  return report.errors.empty() ? error : report.errors.front();
}

bool Counts(const LabelledObject& object, const HitParams& hits) {
  return object.visible >= hits.min_visible && object.num_points >= hits.min_points;
}

// What is wrong with the scans as a whole.
std::string ErrorOf(const LabelledInputs& inputs, const std::string& labels) {
  if (inputs.scans.empty())
    return labels + ": names none of the scans that were given" +
           (inputs.num_unlabelled > 0 ? " (rimod-detect tells their names)" : "");
  std::set<std::string> names;
  int num_counting = 0;
  for (const LabelledInput& scan : inputs.scans) {
    if (!names.insert(scan.name).second) return "two scans are called '" + scan.name + "'";
    for (const LabelledObject& object : scan.objects)
      num_counting += Counts(object, HitParams()) ? 1 : 0;
  }
  return num_counting > 0 ? "" : labels + ": nothing to be found in these scans";
}

}  // namespace

LabelledInputs ReadLabelledInputs(const std::vector<std::string>& sources,
                                  const std::string& labels_path, const ScanSourceParams& params,
                                  const std::atomic<bool>& stop) {
  LabelledInputs inputs;
  LabelFile file = ReadLabelFile(labels_path);
  inputs.error = file.error;
  Labels labels;
  for (LabelledScan& scan : file.scans) {
    if (!labels.emplace(scan.scan, std::move(scan.objects)).second)
      inputs.error = labels_path + ": scan '" + scan.scan + "' is there twice";
  }
  for (std::size_t i = 0; i < sources.size() && inputs.error.empty(); ++i)
    inputs.error = AddSource(sources[i], static_cast<int>(i), params, labels, stop, &inputs);
  if (inputs.error.empty()) inputs.error = ErrorOf(inputs, labels_path);
  inputs.num_absent =
      static_cast<int>(labels.size() - std::min(labels.size(), inputs.scans.size()));
  return inputs;
}

}  // namespace rimod
