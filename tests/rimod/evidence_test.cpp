#include "rimod/evidence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/io/random_values.h"
#include "tests/support/ray_caster.h"
#include "tests/support/surfel_models.h"

namespace rimod {
namespace {

EvidenceParams Params() {
  EvidenceParams params;
  params.depth_tolerance = 0.03;
  params.slope_tolerance = 0.25;
  params.max_tolerance = 0.1;
  params.silhouette_gap = 0.03;
  params.continue_tolerance = 0.06;
  params.support_height = 0.04;
  return params;
}

const Eigen::Isometry3d kPose = Placed(2.2, 0.1, -0.8, 0.5);
const Eigen::Vector3d kSize(0.5, 0.4, 0.6);

const ObjectModel& Crate() {
  static const ObjectModel crate = BoxModel("crate", kSize, 0.01);
  return crate;
}

const JudgedModel& JudgedCrate() {
  static const JudgedModel judged(Crate());
  return judged;
}

// A floor and a wall, a crate at the pose or none, and what else is given.
Scene Room(bool with_crate, bool with_floor = true, const std::vector<BoxShape>& others = {},
           double wall = 4.0) {
  World world;
  world.planes = {{Eigen::Vector3d(wall, 0, 0), -Eigen::Vector3d::UnitX()}};
  if (with_floor) world.planes.push_back({Eigen::Vector3d(0, 0, -0.8), Eigen::Vector3d::UnitZ()});
  world.boxes = others;
  if (with_crate) {
    BoxShape box;
    box.T_local_box = kPose * Eigen::Translation3d(0, 0, 0.3);
    box.half_size = 0.5 * kSize;
    world.boxes.push_back(box);
  }
  RangeImageParams params;
  params.resolution = 0.0069;
  return Scene(
      MakeRangeImage(ScanWorld(world, Eigen::Isometry3d::Identity(), BeamPattern{}), params), 0.05,
      Execution{});
}

BoxShape Screen() {
  BoxShape screen;
  screen.T_local_box = Placed(1.2, 0, 0, 0);
  screen.half_size = Eigen::Vector3d(0.02, 1.0, 1.0);
  return screen;
}

void ExpectSharesAreSound(const Evidence& evidence) {
  for (const double value : evidence.values) EXPECT_TRUE(std::isfinite(value));
  const auto& v = evidence.values;
  const double kinds =
      v[kMatched] + v[kNearlyMatched] + v[kSeenThrough] + v[kOccluded] + v[kNoReturnShare];
  EXPECT_TRUE(std::abs(kinds - 1.0) < 1e-9 || kinds == 0.0) << kinds;
  for (const EvidenceIndex share :
       {kMatched, kNearlyMatched, kSeenThrough, kOccluded, kNoReturnShare, kMatchedOfKnown,
        kResidual, kSilhouetteJump, kSilhouetteContinues, kSilhouetteOccluded, kSilhouetteKnown,
        kUnexplained, kSupported, kRelief, kRimWorst, kRimSecondWorst, kRimMean, kThroughRegion}) {
    EXPECT_GE(v[share], 0.0) << share;
    EXPECT_LE(v[share], 1.0) << share;
  }
  EXPECT_TRUE(std::is_sorted(evidence.explained.begin(), evidence.explained.end()));
}

TEST(EvidenceTest, SpeaksForAnObjectAtItsPlace) {
  const Evidence evidence = GatherEvidence(Room(true), JudgedCrate(), kPose, Params());
  ExpectSharesAreSound(evidence);
  const auto& v = evidence.values;
  EXPECT_GT(v[kMatched], 0.9);
  EXPECT_GT(v[kMatchedOfKnown], 0.95);
  EXPECT_LT(v[kSeenThrough], 0.05);
  EXPECT_LT(v[kResidual], 0.4);
  EXPECT_GT(v[kNormalAgreement], 0.9);
  EXPECT_GT(v[kSilhouetteKnown], 0.9);
  EXPECT_LT(v[kUnexplained], 0.05);
  EXPECT_EQ(v[kSupported], 1.0);
  EXPECT_NEAR(v[kDistance], (kPose * Eigen::Vector3d(0, 0, 0.3)).norm(), 1e-6);
  EXPECT_NEAR(v[kTilt], 0.0, 1e-3);
  EXPECT_NEAR(std::exp(v[kLogMatchedPixels]) - 1.0,
              v[kMatched] * (std::exp(v[kLogRenderedPixels]) - 1.0), 1.0);
}

TEST(EvidenceTest, ExplainedPixelsAreTheObjects) {
  const Scene scene = Room(true);
  const Evidence evidence = GatherEvidence(scene, JudgedCrate(), kPose, Params());
  EXPECT_GT(evidence.explained.size(), 1000u);
  for (const int pixel : evidence.explained) {
    const Eigen::Vector3d p = kPose.inverse() * scene.point(pixel).cast<double>();
    EXPECT_LT(((p - Eigen::Vector3d(0, 0, 0.3)).cwiseAbs() - 0.5 * kSize).maxCoeff(), 0.11);
  }
}

TEST(EvidenceTest, SpeaksAgainstAnObjectThatIsNotThere) {
  const Evidence evidence = GatherEvidence(Room(false), JudgedCrate(), kPose, Params());
  ExpectSharesAreSound(evidence);
  EXPECT_LT(evidence.values[kMatched], 0.1);
  EXPECT_GT(evidence.values[kSeenThrough], 0.8);
}

TEST(EvidenceTest, SeesThroughTheRimOfAModelThatIsTooTall) {
  BoxShape lower;
  constexpr double kHeight = 0.5;  // m, the crate is taller by a tenth of a metre
  lower.T_local_box = kPose * Eigen::Translation3d(0, 0, 0.5 * kHeight);
  lower.half_size = 0.5 * Eigen::Vector3d(kSize.x(), kSize.y(), kHeight);
  const auto too_tall =
      GatherEvidence(Room(false, true, {lower}), JudgedCrate(), kPose, Params()).values;
  const auto fitting = GatherEvidence(Room(true), JudgedCrate(), kPose, Params()).values;
  EXPECT_LT(fitting[kRimWorst], 0.3);
  EXPECT_GT(too_tall[kRimWorst], 0.8);
  EXPECT_GT(too_tall[kRimMean], fitting[kRimMean] + 0.15);
  EXPECT_LT(fitting[kThroughRegion], 0.02);
  EXPECT_GT(too_tall[kThroughRegion], 0.05);
  EXPECT_LE(too_tall[kThroughRegion], too_tall[kSeenThrough] + 0.1);
}

TEST(EvidenceTest, KnowsWhatIsHidden) {
  const Evidence evidence =
      GatherEvidence(Room(true, true, {Screen()}), JudgedCrate(), kPose, Params());
  ExpectSharesAreSound(evidence);
  EXPECT_GT(evidence.values[kOccluded], 0.95);
  EXPECT_TRUE(evidence.explained.empty());
}

TEST(EvidenceTest, NoticesTheSurfaceThatGoesOn) {
  const ObjectModel plate = PlateModel("plate", 0.6, 0.01);
  const JudgedModel judged(plate);
  const Evidence in_wall =
      GatherEvidence(Room(false), judged, Placed(4.0, -0.5, -0.3, M_PI), Params());
  ExpectSharesAreSound(in_wall);
  EXPECT_GT(in_wall.values[kMatched], 0.9);
  EXPECT_LT(in_wall.values[kSilhouetteKnown], 0.1);
  EXPECT_GT(in_wall.values[kSilhouetteContinues], 0.9);
  EXPECT_LT(in_wall.values[kRelief], 0.05);  // flat
  const Evidence crate = GatherEvidence(Room(true), JudgedCrate(), kPose, Params());
  EXPECT_GT(crate.values[kRelief], in_wall.values[kRelief]);
}

TEST(EvidenceTest, EndsWhereOnlyTheFloorIsSeenFarBehind) {
  // No wall near: past the crate's rim there is nothing but the floor that it stands on.
  const auto v = GatherEvidence(Room(true, true, {}, 30.0), JudgedCrate(), kPose, Params()).values;
  EXPECT_GT(v[kSilhouetteJump], 0.9);
  EXPECT_GT(v[kSilhouetteKnown], 0.9);
  EXPECT_LT(v[kSilhouetteContinues], 0.1);
}

TEST(EvidenceTest, NoticesWhatStandsInTheObjectsPlace) {
  // A larger thing fills half of the crate's box: its surface is not the crate's.
  BoxShape intruder;
  intruder.T_local_box = kPose * Eigen::Translation3d(0.0, 0.0, 0.15);
  intruder.half_size = Eigen::Vector3d(0.1, 0.1, 0.3);
  const Evidence evidence =
      GatherEvidence(Room(false, true, {intruder}), JudgedCrate(), kPose, Params());
  EXPECT_GT(evidence.values[kUnexplained], 0.5);
}

TEST(EvidenceTest, KnowsWhetherItStandsOnSomething) {
  EXPECT_EQ(GatherEvidence(Room(true, false), JudgedCrate(), kPose, Params()).values[kSupported],
            0.0);
}

TEST(EvidenceTest, MeasuresTheTilt) {
  Eigen::Isometry3d tilted = kPose;
  tilted.rotate(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()));
  EXPECT_NEAR(GatherEvidence(Room(true), JudgedCrate(), tilted, Params()).values[kTilt], 0.3, 1e-3);
}

TEST(EvidenceTest, NothingRenderedIsNoEvidence) {
  const Scene empty(RangeImage(), 0.05, Execution{});
  for (const Evidence& evidence :
       {GatherEvidence(Room(true), JudgedCrate(), Placed(-3, 0, 0, 0), Params()),
        GatherEvidence(empty, JudgedCrate(), kPose, Params())}) {
    EXPECT_TRUE(evidence.explained.empty());
    for (const double value : evidence.values) EXPECT_EQ(value, 0.0);
  }
}

TEST(EvidenceTest, IsSoundForAnyPoseInAnyScene) {
  RandomValues random(1);
  const Scene room = Room(true);
  const Scene noise(random.AnImage(100, 80), 0.1, Execution{});
  for (int i = 0; i < 60; ++i) {
    Eigen::Isometry3d T = random.Pose();
    T.translation() =
        Eigen::Vector3d(random.Between(0, 4), random.Between(-2, 2), random.Between(-1, 1));
    ExpectSharesAreSound(GatherEvidence(i % 2 ? room : noise, JudgedCrate(), T, Params()));
  }
}

TEST(JudgedModelTest, KnowsItsSurface) {
  RandomValues random(2);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d p =
        Eigen::Vector3d(0, 0, 0.3) + random.Vector(1.0).cwiseProduct(0.6 * kSize);
    const double depth =
        -((p - Eigen::Vector3d(0, 0, 0.3)).cwiseAbs() - 0.5 * kSize).maxCoeff();  // inside > 0
    if (std::abs(depth) < 0.01 && depth > 0.0) {
      EXPECT_TRUE(JudgedCrate().OnSurface(p.cast<float>())) << p.transpose();
    }
    if (depth > 0.08) {
      EXPECT_FALSE(JudgedCrate().OnSurface(p.cast<float>())) << p.transpose();
    }
  }
  EXPECT_FALSE(JudgedCrate().OnSurface({5.0f, 0.0f, 0.0f}));
  EXPECT_FALSE(JudgedCrate().OnSurface({-5.0f, -5.0f, -5.0f}));
}

TEST(JudgedModelTest, ThinnedModelsAreCoarserForLargerPixels) {
  std::size_t before = Crate().points.size() + 1;
  for (const double pixel_size : {0.001, 0.017, 0.03, 0.1}) {
    const ObjectModel& thinned = JudgedCrate().Thinned(pixel_size);
    EXPECT_LT(thinned.points.size(), before);
    EXPECT_EQ(thinned.points.size(), thinned.normals.size());
    EXPECT_GT(thinned.points.size(), 200u);
    before = thinned.points.size();
  }
  EXPECT_LT(JudgedCrate().sample().points.size(), Crate().points.size());
  EXPECT_EQ(JudgedCrate().sample().points.size(), JudgedCrate().sample().normals.size());
}

// Every other row and column tells about the same of what is there, of what is not, and of what is
// hidden.
TEST(GatherCoarseEvidenceTest, IsAboutThatOfAllPixels) {
  for (const Scene& room : {Room(true), Room(false), Room(true, true, {Screen()})}) {
    const Evidence all = GatherEvidence(room, JudgedCrate(), kPose, Params());
    const Evidence coarse = GatherCoarseEvidence(room, JudgedCrate(), kPose, Params());
    ExpectSharesAreSound(coarse);
    EXPECT_TRUE(coarse.explained.empty());
    for (const int value : {kMatched, kSeenThrough, kOccluded, kMatchedOfKnown, kNormalAgreement,
                            kUnexplained, kThroughRegion, kRimMean})
      EXPECT_NEAR(coarse.values[value], all.values[value], 0.1) << value;
    for (const int value : {kLogMatchedPixels, kLogRenderedPixels})
      EXPECT_NEAR(coarse.values[value], all.values[value], 0.3) << value;
    EXPECT_EQ(coarse.values[kSupported], all.values[kSupported]);
    EXPECT_EQ(coarse.values[kDistance], all.values[kDistance]);
  }
}

}  // namespace
}  // namespace rimod
