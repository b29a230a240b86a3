#include "rimod/growing_look.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "rimod/detector.h"
#include "rimod/model_building.h"
#include "tests/support/executions.h"
#include "tests/support/furniture.h"
#include "tests/support/matchers.h"
#include "tests/support/same_features.h"
#include "tests/support/surfel_models.h"

namespace rimod {
namespace {

PipelineParams Params() {
  PipelineParams params = DefaultParams(Method::kDefault);
  params.range_image.resolution = 0.01;
  params.model_views.azimuths = 8;
  params.model_views.elevations = 1;
  params.matching.min_correspondences = 0;
  params.ranking.refined = {10, 100, 0.001};
  params.ranking.judged = {10, 40, 0.001};
  params.choice.min_probability = 0.0;
  return params;
}

const ModelDatabase& Database() {
  static const ModelDatabase database({BuildModel(Record(Armchair()), Params(), Execution{}),
                                       BuildModel(Record(Stool()), Params(), Execution{})},
                                      Params(), Execution{});
  return database;
}

const Eigen::Isometry3d kArmchair = Placed(2.4, 0.9, -1.1, 2.0);
const Eigen::Isometry3d kStool = Placed(2.2, -0.8, -1.1, 0.7);

// What a sweep from above to below sees of both on a floor before a wall: all that is higher than
// an elevation (rad).
Scan SweptDownTo(double elevation) {
  static const Scan whole = [] {
    World world;
    world.planes = {{Eigen::Vector3d(0, 0, -1.1), Eigen::Vector3d::UnitZ()},
                    {Eigen::Vector3d(4, 0, 0), -Eigen::Vector3d::UnitX()}};
    Place(Armchair(), kArmchair, &world);
    Place(Stool(), kStool, &world);
    return ScanWorld(world, Eigen::Isometry3d::Identity(), BeamPattern{});
  }();
  Scan scan = whole;
  scan.points.clear();
  for (const Eigen::Vector3f& point : whole.points)
    if (DirectionOf(point.cast<double>()).elevation > elevation) scan.points.push_back(point);
  return scan;
}

RangeImage ImageDownTo(double elevation) {
  return MakeRangeImage(SweptDownTo(elevation), Params().range_image);
}

const std::vector<double> kLooks = {-0.05, -0.15, -0.25, -0.35, -0.45, -0.55, -0.65};  // rad
constexpr Time kSweep{1'000'000};

void ExpectSame(const DetectionResult& a, const DetectionResult& b) {
  ASSERT_EQ(a.detections.size(), b.detections.size());
  for (std::size_t i = 0; i < a.detections.size(); ++i) {
    EXPECT_EQ(a.detections[i].class_name, b.detections[i].class_name);
    EXPECT_EQ(a.detections[i].score, b.detections[i].score);
    EXPECT_EQ(a.detections[i].T_local_object.matrix(), b.detections[i].T_local_object.matrix());
  }
}

// The best of a class; score 0 when there is none.
Detection BestOf(const DetectionResult& result, const std::string& name) {
  Detection best;
  best.score = 0.0;
  for (const Detection& detection : result.detections)
    if (detection.class_name == name && detection.score > best.score) best = detection;
  return best;
}

// Counts what the loops of each stage do.
struct WorkCounter {
  Execution Watch() {
    Execution execution;
    execution.on_stage_begin = [this](const std::string& name) { stage = name; };
    execution.parallel_for = [this](std::size_t count,
                                    const std::function<void(std::size_t)>& body) {
      work[stage] += count;
      for (std::size_t i = 0; i < count; ++i) body(i);
    };
    return execution;
  }
  std::string stage;
  std::map<std::string, std::size_t> work;
};

TEST(GrowingExtractorTest, FeaturesAreThoseOfTheWholeImage) {
  for (const int threads : {1, 3}) {
    GrowingExtractor extractor(Params());
    for (const double elevation : kLooks) {
      const RangeImage image = ImageDownTo(elevation);
      ExpectEqual(extractor.Look(kSweep, image, OnThreads(threads)),
                  ExtractFeatures(image, Params(), Execution{}));
    }
  }
}

TEST(GrowingExtractorTest, OnlyChangedSurroundingsAreDescribedAnew) {
  GrowingExtractor extractor(Params());
  const RangeImage first = ImageDownTo(-0.45), second = ImageDownTo(-0.5);
  WorkCounter anew, more, nothing, other_sweep;
  const std::size_t num_features = extractor.Look(kSweep, first, anew.Watch()).features.size();
  extractor.Look(kSweep, second, more.Watch());
  extractor.Look(kSweep, second, nothing.Watch());
  extractor.Look(Time(2'000'000), second, other_sweep.Watch());
  EXPECT_GE(anew.work["descriptors"], num_features);
  EXPECT_GT(more.work["descriptors"], 0u);
  EXPECT_LT(more.work["descriptors"], anew.work["descriptors"] / 2);
  EXPECT_EQ(nothing.work["descriptors"], 0u);
  EXPECT_GE(other_sweep.work["descriptors"], num_features);
}

// Sweeps downwards and upwards, in which the image grows at its top.
TEST(GrowingDetectorTest, FindsAboutWhatAWholeLookFinds) {
  for (const bool upwards : {false, true}) {
    GrowingDetector detector(Database(), Params());
    int num_compared = 0;
    for (const double elevation : kLooks) {
      RangeImage image = ImageDownTo(elevation);
      if (upwards) {
        Scan scan = SweptDownTo(-0.7);
        const auto unseen = [&](const Eigen::Vector3f& p) {
          return DirectionOf(p.cast<double>()).elevation > -0.7 - elevation;
        };
        scan.points.erase(std::remove_if(scan.points.begin(), scan.points.end(), unseen),
                          scan.points.end());
        image = MakeRangeImage(scan, Params().range_image);
      }
      const FeatureSet features = ExtractFeatures(image, Params(), Execution{});
      const DetectionResult growing = detector.Look(kSweep, image, features, Execution{});
      const DetectionResult anew =
          DetectObjects(image, features, Database(), Params(), Execution{});
      for (const std::string& name : {Armchair().name, Stool().name}) {
        const Detection expected = BestOf(anew, name), found = BestOf(growing, name);
        if (expected.score < 0.8) continue;
        ++num_compared;
        EXPECT_NEAR(found.score, expected.score, 0.1) << name << " at " << elevation;
        EXPECT_TRUE(PosesNear(found.T_local_object, expected.T_local_object, 0.01, 0.02));
      }
    }
    EXPECT_GE(num_compared, 3) << (upwards ? "upwards" : "downwards");
  }
}

TEST(GrowingDetectorTest, TheSameImageAgainGivesTheSameAndIsNoWork) {
  GrowingDetector detector(Database(), Params());
  const RangeImage image = ImageDownTo(-0.55);
  const FeatureSet features = ExtractFeatures(image, Params(), Execution{});
  WorkCounter anew, again;
  const DetectionResult first = detector.Look(kSweep, image, features, anew.Watch());
  const DetectionResult second = detector.Look(kSweep, image, features, again.Watch());
  ASSERT_FALSE(first.detections.empty());
  ExpectSame(first, DetectObjects(image, features, Database(), Params(), Execution{}));
  ExpectSame(second, first);
  EXPECT_GT(anew.work["refinement"], 2 * Database().models().size());
  EXPECT_LE(again.work["refinement"], 2 * Database().models().size());
  EXPECT_GT(anew.work["validation"], 0u);
  EXPECT_EQ(again.work["validation"], 0u);
}

TEST(GrowingDetectorTest, AnotherSweepOrAnotherSensorPoseBeginsAnew) {
  const RangeImage image = ImageDownTo(-0.55);
  const FeatureSet features = ExtractFeatures(image, Params(), Execution{});
  GrowingDetector detector(Database(), Params());
  detector.Look(kSweep, image, features, Execution{});
  WorkCounter other;
  detector.Look(Time(2'000'000), image, features, other.Watch());
  EXPECT_GT(other.work["validation"], 0u);

  Scan moved = SweptDownTo(-0.55);
  moved.T_local_sensor.translation().x() += 0.05;
  const RangeImage moved_image = MakeRangeImage(moved, Params().range_image);
  const FeatureSet moved_features = ExtractFeatures(moved_image, Params(), Execution{});
  const DetectionResult anew =
      DetectObjects(moved_image, moved_features, Database(), Params(), Execution{});
  ASSERT_FALSE(anew.detections.empty());
  ExpectSame(detector.Look(Time(2'000'000), moved_image, moved_features, Execution{}), anew);

  detector.Forget();
  WorkCounter forgotten;
  detector.Look(Time(2'000'000), moved_image, moved_features, forgotten.Watch());
  EXPECT_GT(forgotten.work["validation"], 0u);
}

TEST(GrowingDetectorTest, ALookThatIsBrokenOffLeavesTheOneBefore) {
  struct BrokenOff : std::runtime_error {
    BrokenOff() : std::runtime_error("broken off") {}
  };
  const RangeImage first = ImageDownTo(-0.45), second = ImageDownTo(-0.55);
  const FeatureSet first_features = ExtractFeatures(first, Params(), Execution{});
  const FeatureSet second_features = ExtractFeatures(second, Params(), Execution{});
  GrowingDetector undisturbed(Database(), Params()), disturbed(Database(), Params());
  undisturbed.Look(kSweep, first, first_features, Execution{});
  disturbed.Look(kSweep, first, first_features, Execution{});
  for (const std::string stage : {"scene_normals", "matching", "scoring", "validation"}) {
    Execution execution;
    execution.on_stage_begin = [&](const std::string& name) {
      if (name == stage) throw BrokenOff();
    };
    EXPECT_THROW(disturbed.Look(kSweep, second, second_features, execution), BrokenOff);
    EXPECT_THROW(disturbed.Look(Time(2'000'000), first, first_features, execution), BrokenOff);
  }
  ExpectSame(disturbed.Look(kSweep, second, second_features, Execution{}),
             undisturbed.Look(kSweep, second, second_features, Execution{}));
}

TEST(GrowingDetectorTest, ThreadsDoNotMatter) {
  GrowingDetector alone(Database(), Params()), many(Database(), Params());
  std::size_t num_found = 0;
  for (const double elevation : kLooks) {
    const RangeImage image = ImageDownTo(elevation);
    const FeatureSet features = ExtractFeatures(image, Params(), Execution{});
    const DetectionResult found = alone.Look(kSweep, image, features, Execution{});
    ExpectSame(found, many.Look(kSweep, image, features, OnThreads(4)));
    num_found = found.detections.size();
  }
  EXPECT_GE(num_found, 2u);
}

// However many looks there are, no more is judged of a model than the quota says, and nothing that
// explains pixels outside of the image.
TEST(FindByEvidenceTest, CandidatesOfManyLooksKeepToTheQuota) {
  std::optional<EarlierLook> earlier;
  for (double elevation = -0.05; elevation > -0.6; elevation -= 0.02) {
    const RangeImage image = ImageDownTo(elevation);
    const FeatureSet features = ExtractFeatures(image, Params(), Execution{});
    const JudgedScan found =
        FindByEvidence(image, features, Database(), Params(), Execution{}, &earlier);
    std::map<int, int> of_model;
    for (std::size_t i = 0; i < found.candidates.size(); ++i) {
      const ExplainingCandidate& candidate = found.candidates[i];
      ++of_model[candidate.candidate.model];
      if (i > 0) {
        EXPECT_GE(found.candidates[i - 1].candidate.score, candidate.candidate.score);
      }
      for (const PixelRun& run : candidate.explained) {
        EXPECT_GE(run.first, 0);
        EXPECT_LE(run.first + run.count, image.grid().size());
      }
    }
    for (const auto& [model, count] : of_model) EXPECT_LE(count, Params().ranking.judged.most);
    std::size_t num_ranked = 0, num_judged = 0;
    for (const HypothesisHistory& history : earlier->histories) {
      num_ranked += history.ranked.has_value();
      num_judged += history.judged.has_value();
    }
    EXPECT_EQ(num_ranked, num_judged);
    EXPECT_EQ(num_judged, found.candidates.size());
    EXPECT_LE(earlier->histories.size(), 2u * Params().ranking.refined.most);
  }
}

// Known correspondences and new ones together are those of all features.
TEST(MatchToModelsTest, KnownFeaturesKeepTheirCorrespondences) {
  const FeatureSet features = ExtractFeatures(ImageDownTo(-0.55), Params(), Execution{});
  const ModelMatches all = MatchToModels(features, Database(), Params(), Execution{});
  KnownMatches known;
  known.features.descriptor_kind = features.descriptor_kind;
  known.features.descriptor_size = features.descriptor_size;
  for (std::size_t i = features.features.size(); i-- > 0;)
    if (i % 3 != 0) known.features.features.push_back(features.features[i]);
  known.matches = MatchToModels(known.features, Database(), Params(), Execution{});
  known.features.features[5].descriptor[0] ^= 1;  // not the same any more: matched anew
  const ModelMatches mixed = MatchToModels(features, Database(), Params(), OnThreads(2), &known);
  ASSERT_EQ(mixed.size(), all.size());
  for (std::size_t m = 0; m < all.size(); ++m) {
    ASSERT_EQ(mixed[m].size(), all[m].size());
    ASSERT_GT(all[m].size(), 10u);
    for (std::size_t i = 0; i < all[m].size(); ++i) {
      EXPECT_EQ(mixed[m][i].scene_feature, all[m][i].scene_feature);
      EXPECT_EQ(mixed[m][i].model_feature, all[m][i].model_feature);
      EXPECT_EQ(mixed[m][i].distance, all[m][i].distance);
    }
  }
}

}  // namespace
}  // namespace rimod
