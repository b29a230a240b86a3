#include "tuning/tune_command.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <numeric>
#include <ostream>
#include <set>
#include <stdexcept>

#include "io/files.h"
#include "io/numbers.h"
#include "io/stoppable.h"
#include "io/thread_pool.h"
#include "tuning/detector_trials.h"
#include "tuning/tune_report.h"

namespace rimod {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kBadUsage = 2;

double SecondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

int Fail(int exit_code, const std::string& error) {
  spdlog::error("{}", error);
  return exit_code;
}

// The dimensions that were asked for, or an error text.
struct Dimensions {
  std::vector<Dimension> dimensions;
  std::string error;
};

Dimensions DimensionsFrom(const TuneOptions& options, const Configuration& configuration) {
  const std::vector<std::string> texts =
      options.vary.empty() ? DefaultVaryTexts(configuration.pipeline) : options.vary;
  Dimensions result;
  std::set<std::string> names;
  for (const std::string& text : texts) {
    DimensionResult made = DimensionFrom(text, configuration);
    if (!made.dimension) return {{}, "--vary: " + made.error};
    if (!names.insert(made.dimension->name).second)
      return {{}, "--vary: " + made.dimension->name + " is there twice"};
    result.dimensions.push_back(std::move(*made.dimension));
  }
  if (result.dimensions.size() > kMaxDimensions)
    return {{}, "--vary: at most " + std::to_string(kMaxDimensions) + " parameters"};
  return result;
}

bool NeedsRecordings(const std::vector<Dimension>& dimensions) {
  return std::any_of(dimensions.begin(), dimensions.end(), [](const Dimension& dimension) {
    return CostOfChange({dimension}, {"a"}, {"b"}) == ParameterCost::kSurface;
  });
}

// Labelled classes need models.
std::string MissingModel(const ModelSources& models, const LabelledInputs& inputs) {
  for (const LabelledInput& scan : inputs.scans)
    for (const LabelledObject& object : scan.objects)
      if (models.shapes.count(object.class_name) == 0)
        return "scan '" + scan.name + "' has a '" + object.class_name +
               "' in the labels, of which there is no model";
  return "";
}

// Scans that are alike because they are from one log must not stand on both sides of a comparison:
// the logs are the groups, where there are enough of them. Fewer are cut into pieces.
std::vector<int> GroupsOf(const std::vector<LabelledInput>& scans, int num_folds) {
  std::vector<int> groups;
  std::set<int> sources;
  for (const LabelledInput& scan : scans) {
    sources.insert(scan.source);
    groups.push_back(static_cast<int>(sources.size()) - 1);
  }
  if (static_cast<int>(sources.size()) >= num_folds) return groups;
  spdlog::warn(
      "{} logs for {} folds: they are cut into pieces, and what is found in one piece may "
      "hold in the next only because both are from one log",
      sources.size(), num_folds);
  for (std::size_t i = 0; i < scans.size(); ++i)
    groups[i] =
        static_cast<int>(i * std::min<std::size_t>(scans.size(), 4u * num_folds) / scans.size());
  return groups;
}

// Shares the time among the searches that are still to come.
class TimeBudget {
 public:
  TimeBudget(double seconds, int num_trials) : seconds_(seconds), num_trials_(num_trials) {}

  std::function<double(int)> BeginSearch(int search, int num_searches) {
    if (num_trials_ > 0) {
      return [most = num_trials_](int settings) { return static_cast<double>(settings) / most; };
    }
    const double left = std::max(0.0, seconds_ - SecondsSince(begin_));
    const double share = std::max(1e-3, left / (num_searches - search));
    return [share, begin = Clock::now()](int) { return SecondsSince(begin) / share; };
  }

 private:
  double seconds_;
  int num_trials_;
  Clock::time_point begin_ = Clock::now();
};

// Everything that tuning works on, read and checked.
struct Prepared {
  std::vector<Dimension> dimensions;
  ModelSources models;
  LabelledInputs inputs;
};

// Returns an error text.
std::string ReadInputs(const TuneOptions& options, const Configuration& configuration,
                       ThreadPool* pool, const std::atomic<bool>& stop, Prepared* prepared) {
  prepared->models = ReadModelSources(options.recordings, options.models, pool->MakeExecution());
  for (const std::string& warning : prepared->models.warnings) spdlog::warn("{}", warning);
  if (!prepared->models.error.empty()) return prepared->models.error;
  ScanSourceParams source;
  source.sweep = configuration.pipeline.sweep;
  source.cloud = configuration.pipeline.cloud;
  source.cloud_channels = options.clouds;
  prepared->inputs = ReadLabelledInputs(options.scans, options.labels, source, stop);
  const LabelledInputs& inputs = prepared->inputs;
  for (const std::string& warning : inputs.warnings) spdlog::warn("{}", warning);
  if (!inputs.error.empty()) return inputs.error;
  if (inputs.num_unlabelled > 0)
    spdlog::warn("{} scans left out: no label names them", inputs.num_unlabelled);
  if (inputs.num_absent > 0)
    spdlog::info("{} labelled scans are not among those given", inputs.num_absent);
  return MissingModel(prepared->models, inputs);
}

// Tells from time to time how far it is.
TrialRunner Watched(DetectorTrials* trials) {
  return [trials, count = 0, last = Clock::now()](const Setting& setting,
                                                  const std::vector<int>& scans) mutable {
    constexpr double kPeriod = 10.0;  // s
    ++count;
    if (SecondsSince(last) > kPeriod) {
      last = Clock::now();
      spdlog::info("{} runs of the detector over scans so far", count);
    }
    return trials->Run(setting, scans);
  };
}

std::vector<std::string> FileHead(const std::vector<std::string>& summary,
                                  const std::string& advice) {
  std::vector<std::string> head = {"Written by rimod-tune: what differs from the method's values.",
                                   advice};
  head.insert(head.end(), summary.begin(), summary.end());
  return head;
}

std::string AdviceFor(ParameterCost cost) {
  switch (cost) {
    case ParameterCost::kSurface:
      return "Models must be built anew: rimod-modeler --config THIS_FILE for each.";
    case ParameterCost::kViews:
      return "Build models anew with rimod-modeler --config THIS_FILE; else their features are "
             "computed anew at every start.";
    case ParameterCost::kSearch:
      break;
  }
  return "Models stay as they are.";
}

// Prints and writes what was found.
int Finish(const TuneOptions& options, const Configuration& base, const TuningReport& report,
           std::ostream& out) {
  const TuningResult& result = report.result;
  const std::vector<std::string> summary = SummaryLines(report);
  for (const std::string& line : summary) out << line << '\n';
  std::string error;
  if (!options.csv.empty()) error = WriteFileAtomically(options.csv, TrialsCsv(report));
  if (!error.empty()) return Fail(kFailed, error);
  if (result.best < 0) return Fail(kFailed, "interrupted before the given parameters were tried");

  const bool keep = result.complete && !result.gain.clear() && !options.even_if_unclear;
  const Setting& chosen = keep ? report.start : report.store.trials()[result.best].setting;
  if (keep) {
    out << "The parameters stay as they are: what was found may be chance "
           "(--even-if-unclear takes it).\n";
  }
  const std::string advice = AdviceFor(CostOfChange(report.dimensions, report.start, chosen));
  out << advice << '\n';
  if (!options.out.empty()) {
    const AppliedSetting applied = ApplySetting(report.dimensions, chosen, base);
    error = WriteFileAtomically(
        options.out, ShortConfigurationText(*applied.configuration, FileHead(summary, advice)));
    if (!error.empty()) return Fail(kFailed, error);
    out << "written: " << options.out << '\n';
  }
  out.flush();
  return out.good() ? kDone : Fail(kFailed, "the result could not be printed");
}

int Tune(const TuneOptions& options, const Configuration& configuration, const Objective& objective,
         Prepared prepared, ThreadPool* pool, const std::atomic<bool>& stop, std::ostream& out) {
  TimeBudget budget(options.budget, options.num_trials);
  TuningPlan plan;
  plan.dimensions = prepared.dimensions;
  plan.start = SettingOf(prepared.dimensions, configuration);
  plan.groups = GroupsOf(prepared.inputs.scans, options.num_folds);
  plan.folds = AssignFolds(plan.groups, options.num_folds, options.seed);
  plan.score = [objective](const ScanCounts& counts) { return objective.Score(counts); };
  plan.seed = options.seed;
  plan.begin_search = [&budget](int search, int num_searches) {
    spdlog::info("search {} of {}{}", search + 1, num_searches,
                 search == 0 ? ", in all scans" : ", without one fold");
    return budget.BeginSearch(search, num_searches);
  };
  std::vector<int> all_scans(plan.groups.size());
  std::iota(all_scans.begin(), all_scans.end(), 0);
  spdlog::info("{} scans, {} models, {} parameters", all_scans.size(),
               prepared.models.shapes.size(), plan.dimensions.size());

  DetectorTrials trials(prepared.dimensions, configuration, std::move(prepared.models),
                        std::move(prepared.inputs.scans), pool, &stop);
  TrialStore store(static_cast<int>(all_scans.size()), Watched(&trials));
  const Setting start = plan.start;
  Tuner tuner(std::move(plan), &store);
  try {
    tuner.Run();
  } catch (const Stopped&) {
    spdlog::warn("interrupted: the best so far is written");
  }
  const auto score = [&objective](const ScanCounts& counts) { return objective.Score(counts); };
  return Finish(
      options, configuration,
      {tuner.result(), store, prepared.dimensions, start, options.objective, score, all_scans},
      out);
}

}  // namespace

std::optional<double> SecondsFrom(const std::string& text) {
  constexpr double kMost = 30.0 * 86400.0;
  const std::size_t unit_begin = text.find_first_not_of("0123456789.");
  if (unit_begin == std::string::npos) return std::nullopt;
  const std::optional<double> number = ParseNumber(text.substr(0, unit_begin));
  const std::string unit = text.substr(unit_begin);
  const double seconds = unit == "s" ? 1.0 : unit == "min" ? 60.0 : unit == "h" ? 3600.0 : 0.0;
  if (!number || !(*number * seconds > 0.0) || *number * seconds > kMost) return std::nullopt;
  return *number * seconds;
}

int RunTune(const TuneOptions& options, const Configuration& configuration,
            const std::atomic<bool>& stop, std::ostream& out) {
  if (options.list) {
    out << TunableParametersText(configuration);
    return out.good() ? kDone : kFailed;
  }
  std::optional<Objective> objective = ObjectiveFrom(options.objective);
  if (!objective)
    return Fail(kBadUsage, "--objective: '" + options.objective.substr(0, 60) +
                               "' is not f1, f0.5, f2, pose-f1, zeta or recall@PRECISION");
  objective->max_ms = options.max_ms;
  Dimensions dimensions = DimensionsFrom(options, configuration);
  if (!dimensions.error.empty()) return Fail(kBadUsage, dimensions.error);
  if (options.recordings.empty() && NeedsRecordings(dimensions.dimensions))
    return Fail(kBadUsage,
                "model_surface parameters need --recordings: finished models keep theirs");

  ThreadPool pool(options.num_threads);
  Prepared prepared;
  prepared.dimensions = std::move(dimensions.dimensions);
  try {
    const std::string error = ReadInputs(options, configuration, &pool, stop, &prepared);
    if (!error.empty()) return Fail(kFailed, error);
    return Tune(options, configuration, *objective, std::move(prepared), &pool, stop, out);
  } catch (const Stopped&) {
    return Fail(kFailed, "interrupted before the scans were read");
  } catch (const std::invalid_argument& unusable) {
    return Fail(kFailed, unusable.what());
  }
}

}  // namespace rimod
