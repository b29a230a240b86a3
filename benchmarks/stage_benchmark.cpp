// Every stage of the default method on the recorded office, alone, with one thread and with two.
// benchmarks/run makes docs/benchmarks.md of the results.

#include <benchmark/benchmark.h>

#include "benchmarks/recorded_input.h"
#include "io/recording.h"
#include "rimod/feature_extraction.h"
#include "rimod/interest_points.h"
#include "rimod/model_building.h"
#include "rimod/range_patch.h"

namespace rimod {
namespace {

// Runs stage(input, execution) with as many threads as the benchmark's argument says.
template <typename Stage>
void Measure(benchmark::State& state, const Stage& stage) {
  const RecordedInput& input = Input();
  ThreadPool pool(static_cast<int>(state.range(0)));
  const Execution execution = pool.MakeExecution();
  for (auto _ : state) benchmark::DoNotOptimize(stage(input, execution));
}

void RangeImageStage(benchmark::State& state) {
  Measure(state, [](const RecordedInput& in, const Execution& execution) {
    return ComputeRangeImage(in.scan, in.params, execution);
  });
}

void InterestPointsStage(benchmark::State& state) {
  Measure(state, [](const RecordedInput& in, const Execution& execution) {
    return FindInterestPoints(in.image, in.params.interest_points, execution);
  });
}

void DescriptorsStage(benchmark::State& state) {
  Measure(state, [](const RecordedInput& in, const Execution& execution) {
    std::vector<std::optional<Feature>> described(in.interest_points.size());
    execution.parallel_for(described.size(), [&](std::size_t i) {
      described[i] = DescribePatch(in.image, in.interest_points[i], in.params.range_patch);
    });
    return described;
  });
}

void SceneNormalsStage(benchmark::State& state) {
  Measure(state, [](const RecordedInput& in, const Execution& execution) {
    return Scene(in.image, in.params.evidence.normal_radius, execution);
  });
}

void MatchingStage(benchmark::State& state) {
  Measure(state, [](const RecordedInput& in, const Execution& execution) {
    return MatchToModels(in.features, in.database, in.params, execution);
  });
}

void ProposalsStage(benchmark::State& state) {
  Measure(state, [](const RecordedInput& in, const Execution& execution) {
    int num_found = 0;
    return ProposeHypotheses(in.scene, in.features, in.matches, in.database, in.params, execution,
                             &num_found);
  });
}

void RankingStage(benchmark::State& state) {
  Measure(state, [](const RecordedInput& in, const Execution& execution) {
    return RankHypotheses(in.scene, in.proposed, in.database, in.params, execution);
  });
}

void JudgementStage(benchmark::State& state) {
  Measure(state, [](const RecordedInput& in, const Execution& execution) {
    return JudgeCandidates(in.scene, in.features, in.matches, in.ranked, in.database, in.params,
                           execution);
  });
}

void ChoiceStage(benchmark::State& state) {
  Measure(state, [](const RecordedInput& in, const Execution& execution) {
    return ChooseCandidates(in.scene, in.judged, in.database, in.params, execution);
  });
}

void WholeDetection(benchmark::State& state) {
  Measure(state, [](const RecordedInput& in, const Execution& execution) {
    const RangeImage image = ComputeRangeImage(in.scan, in.params, execution);
    const FeatureSet features = ExtractFeatures(image, in.params, execution);
    return DetectObjects(image, features, in.database, in.params, execution);
  });
}

void ModelFromEightScans(benchmark::State& state) {
  const PipelineParams params = DefaultParams(Method::kDefault);
  const RecordingResult read = ReadRecording(RIMOD_SOURCE_DIR "/logs/recordings/office_chair");
  ThreadPool pool(static_cast<int>(state.range(0)));
  const Execution execution = pool.MakeExecution();
  if (!read.recording) {
    state.SkipWithError(read.error.c_str());
    return;
  }
  for (auto _ : state) benchmark::DoNotOptimize(BuildModel(*read.recording, params, execution));
}

void OneAndTwoThreads(benchmark::internal::Benchmark* stage) {
  stage->Arg(1)->Arg(2)->ArgName("threads")->UseRealTime()->Unit(benchmark::kMillisecond);
}

BENCHMARK(RangeImageStage)->Apply(OneAndTwoThreads);
BENCHMARK(InterestPointsStage)->Apply(OneAndTwoThreads);
BENCHMARK(DescriptorsStage)->Apply(OneAndTwoThreads);
BENCHMARK(SceneNormalsStage)->Apply(OneAndTwoThreads);
BENCHMARK(MatchingStage)->Apply(OneAndTwoThreads);
BENCHMARK(ProposalsStage)->Apply(OneAndTwoThreads);
BENCHMARK(RankingStage)->Apply(OneAndTwoThreads);
BENCHMARK(JudgementStage)->Apply(OneAndTwoThreads);
BENCHMARK(ChoiceStage)->Apply(OneAndTwoThreads);
BENCHMARK(WholeDetection)->Apply(OneAndTwoThreads);
BENCHMARK(ModelFromEightScans)->Apply(OneAndTwoThreads);

}  // namespace
}  // namespace rimod

BENCHMARK_MAIN();
