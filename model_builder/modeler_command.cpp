#include "model_builder/modeler_command.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <lcm/lcm-cpp.hpp>
#include <optional>

#include "io/mesh_file.h"
#include "io/model_file.h"
#include "io/model_messages.h"
#include "io/paced_publisher.h"
#include "io/point_cloud_file.h"
#include "io/progress_bar.h"
#include "io/recording.h"
#include "io/thread_pool.h"
#include "model_builder/inspect_command.h"
#include "model_builder/live_recording.h"
#include "rimod/model_building.h"

namespace rimod {
namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kBadUsage = 2;

// A model that was built, or the exit code of why there is none.
struct Built {
  std::optional<ObjectModel> model;
  int exit_code = kDone;
};

Built Fail(int exit_code, const std::string& error) {
  spdlog::error("{}", error);
  return {std::nullopt, exit_code};
}

// Calls build(), which may find the input unusable.
template <typename Build>
Built TryToBuild(const std::string& source, const Build& build) {
  try {
    return {build(), kDone};
  } catch (const std::invalid_argument& unusable) {
    return Fail(kFailed, source + ": no model: " + unusable.what());
  }
}

// The class of a file's object: as given, else as a model.json beside the file says.
std::string ClassOf(const ModelerOptions& options, const std::string& file) {
  if (!options.class_name.empty()) return options.class_name;
  const std::string folder = std::filesystem::path(file).parent_path().string();
  return ReadClassName(folder.empty() ? "." : folder).value_or("");
}

Built BadClass(const std::string& name) {
  return Fail(kBadUsage,
              name.empty()
                  ? "--class NAME is needed: no model.json beside the file names it"
                  : "--class: '" + name + "' is not 1 .. 64 letters, digits, '_', '-' or '.'");
}

Built FromRecording(const ModelerOptions& options, const PipelineParams& params,
                    const Execution& execution) {
  RecordingResult read = ReadRecording(options.recording);
  for (const std::string& warning : read.warnings) spdlog::warn("{}", warning);
  if (!read.recording) return Fail(kFailed, read.error);
  if (!options.class_name.empty()) read.recording->class_name = options.class_name;
  if (!IsValidModelName(read.recording->class_name)) return BadClass(options.class_name);
  return TryToBuild(options.recording,
                    [&] { return BuildModel(*read.recording, params, execution); });
}

Built FromCloud(const ModelerOptions& options, const PipelineParams& params,
                const Execution& execution) {
  const std::string name = ClassOf(options, options.cloud);
  if (!IsValidModelName(name)) return BadClass(name);
  const PointCloudResult cloud = ReadPointCloud(options.cloud);
  if (!cloud.warning.empty()) spdlog::warn("{}", cloud.warning);
  if (!cloud.scan) return Fail(kFailed, cloud.error);
  return TryToBuild(options.cloud, [&] {
    return BuildModelFromPoints(name, cloud.scan->points, params, execution);
  });
}

Built FromMesh(const ModelerOptions& options, const PipelineParams& params,
               const Execution& execution) {
  const std::string name = ClassOf(options, options.mesh);
  if (!IsValidModelName(name)) return BadClass(name);
  const MeshResult mesh = ReadMesh(options.mesh);
  if (!mesh.mesh) return Fail(kFailed, mesh.error);
  if (mesh.dropped_triangles > 0) {
    spdlog::warn("{}: left out {} triangles: no area or not finite", options.mesh,
                 mesh.dropped_triangles);
  }
  return TryToBuild(options.mesh,
                    [&] { return BuildModelFromMesh(name, *mesh.mesh, params, execution); });
}

Built Build(const ModelerOptions& options, const PipelineParams& params) {
  ThreadPool pool(options.num_threads);
  Execution execution = pool.MakeExecution();
  ProgressBar bar("building");
  bar.Watch(&execution);
  if (!options.recording.empty()) return FromRecording(options, params, execution);
  if (!options.cloud.empty()) return FromCloud(options, params, execution);
  return FromMesh(options, params, execution);
}

void PrintSummary(const ObjectModel& model, const std::string& path) {
  std::size_t total = 0, most = 0;
  std::size_t fewest = model.views.empty() ? 0 : model.views.front().features.size();
  for (const ModelView& view : model.views) {
    fewest = std::min(fewest, view.features.size());
    most = std::max(most, view.features.size());
    total += view.features.size();
  }
  const Eigen::Vector3d size = model.box_max - model.box_min;
  std::error_code ignored;
  const auto file_bytes = static_cast<double>(std::filesystem::file_size(path, ignored));
  const auto num_views = static_cast<double>(std::max<std::size_t>(1, model.views.size()));
  const double mean = static_cast<double>(total) / num_views;
  std::cout << fmt::format(
      "{}: {}\n"
      "  source             {}\n"
      "  box                {:.3f} x {:.3f} x {:.3f} m\n"
      "  points             {}, {:.3f} m apart\n"
      "  views              {}\n"
      "  features a view    {:.1f} ({} .. {})\n"
      "  file               {:.1f} kB\n",
      path, model.name, model.source, size.x(), size.y(), size.z(), model.points.size(),
      model.point_spacing, model.views.size(), mean, fewest, most, file_bytes / 1000.0);
}

// Sends the model on the bus; false when that is not possible.
bool Publish(const ObjectModel& model, const ModelerOptions& options, const std::string& channel,
             const BusParams& params) {
  const std::unique_ptr<lcm::LCM> lcm = OpenLcm(LcmUrl(options.bus));
  if (!lcm) return false;
  const std::chrono::microseconds now = std::chrono::duration_cast<std::chrono::microseconds>(
      std::chrono::system_clock::now().time_since_epoch());
  PacedPublisher publisher(lcm.get(), params);
  const std::vector<object_model_t> sections = ToSections(model, now.count());
  publisher.PublishAll(channel, sections);
  publisher.Flush();
  if (publisher.num_failed() > 0) {
    spdlog::error("{} of {} messages could not be sent", publisher.num_failed(), sections.size());
    return false;
  }
  spdlog::info("sent on {} in {} messages", channel, sections.size());
  return true;
}

}  // namespace

int RunModeler(const ModelerOptions& given, const Configuration& configuration) {
  if (!given.inspect.empty()) return RunInspect(given.inspect, given.output, configuration);
  ModelerOptions options = given;
  if (!options.live.empty()) {
    const int exit_code =
        RecordLive(options.live, options.num_live_scans, options.bus, configuration.bus);
    if (exit_code != kDone) return exit_code;
    options.recording = options.live;
  }
  const ChannelsResult channels = ChannelsFrom(options.bus);
  if (!channels.channels) {
    spdlog::error("{}", channels.error);
    return kBadUsage;
  }
  const Built built = Build(options, configuration.pipeline);
  if (!built.model) return built.exit_code;
  const std::string error = WriteModelFile(options.out, *built.model);
  if (!error.empty()) {
    spdlog::error("{}", error);
    return kFailed;
  }
  if (std::filesystem::path(options.out).extension() != ".rimod") {
    spdlog::warn("{}: does not end in .rimod: no folder of models will show it", options.out);
  }
  PrintSummary(*built.model, options.out);
  const bool sent = !options.publish ||
                    Publish(*built.model, options, channels.channels->model, configuration.bus);
  return sent ? kDone : kFailed;
}

}  // namespace rimod
