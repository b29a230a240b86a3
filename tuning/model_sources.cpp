#include "tuning/model_sources.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "io/label_file.h"
#include "io/model_file.h"
#include "io/recording.h"
#include "rimod/feature_extraction.h"
#include "rimod/model_building.h"

namespace rimod {
namespace {

namespace fs = std::filesystem;

// The folders with a model.json, sorted.
std::vector<std::string> RecordingFolders(const std::string& folder) {
  std::error_code error;
  const fs::path inner = fs::path(folder) / "models";
  const fs::path place = fs::is_directory(inner, error) ? inner : fs::path(folder);
  std::vector<std::string> folders;
  for (fs::directory_iterator entry(place, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code ignored;
    if (fs::exists(entry->path() / "model.json", ignored))
      folders.push_back(entry->path().string());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

// Returns an error text.
std::string AddRecording(const std::string& folder, ModelSources* sources) {
  RecordingResult read = ReadRecording(folder);
  if (!read.recording) return read.error;
  const Recording& recording = *read.recording;
  if (!IsValidModelName(recording.class_name))
    return folder + ": its model.json names no valid class";
  const std::optional<Symmetry> symmetry = ReadSymmetry(folder);
  if (!symmetry) return folder + ": its model.json names an unknown symmetry";
  const ObjectShape shape{recording.box_min, recording.box_max, *symmetry};
  if (!sources->shapes.emplace(recording.class_name, shape).second)
    return folder + ": a second recording of class '" + recording.class_name + "'";
  sources->warnings.insert(sources->warnings.end(), read.warnings.begin(), read.warnings.end());
  sources->recordings.push_back(std::move(*read.recording));
  return "";
}

}  // namespace

ModelSources ReadModelSources(const std::string& recordings, const std::string& models,
                              const Execution& execution) {
  ModelSources sources;
  if (!recordings.empty()) {
    for (const std::string& folder : RecordingFolders(recordings))
      if (sources.error.empty()) sources.error = AddRecording(folder, &sources);
    if (sources.error.empty() && sources.recordings.empty())
      sources.error = recordings + ": no folder with a model.json in it";
    return sources;
  }
  ModelFolder folder = LoadModelFolder(models, execution);
  sources.error = !folder.error.empty()       ? folder.error
                  : !folder.bad_files.empty() ? folder.bad_files.front()
                  : folder.models.empty()     ? models + ": no model (*.rimod) in it"
                                              : "";
  sources.models = std::move(folder.models);
  for (const ObjectModel& model : sources.models)
    sources.shapes[model.name] = {model.box_min, model.box_max, Symmetry::kNone};
  return sources;
}

std::vector<ObjectModel> BuildModels(const ModelSources& sources, const PipelineParams& params,
                                     const Execution& execution) {
  std::vector<ObjectModel> models = sources.models;
  for (const Recording& recording : sources.recordings)
    models.push_back(BuildModel(recording, params, execution));
  for (ObjectModel& model : models)
    if (!ModelMatchesParams(model, params)) ComputeModelViews(params, execution, &model);
  return models;
}

}  // namespace rimod
