#include "rimod/candidate_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

namespace rimod {
namespace {

constexpr int kPixels = 400;

double Uniform(std::mt19937* random, double low, double high) {
  return low + (high - low) * static_cast<double>((*random)() % 10000) / 10000.0;
}

Eigen::Isometry3d RandomPose(std::mt19937* random) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(Uniform(random, -3, 3), Eigen::Vector3d(1, 2, 3).normalized())
                   .toRotationMatrix();
  T.translation() << Uniform(random, -2, 2), Uniform(random, -2, 2), Uniform(random, -1, 1);
  return T;
}

std::vector<PixelRun> RandomRuns(std::mt19937* random) {
  std::vector<int> pixels;
  int pixel = static_cast<int>((*random)() % 300);
  const int count = static_cast<int>((*random)() % 40);
  for (int i = 0; i < count && pixel < kPixels; ++i) {
    pixels.push_back(pixel);
    pixel += (*random)() % 4 == 0 ? 3 : 1;
  }
  return RunsOf(pixels);
}

// Many candidates with few different scores, so that there are ties, and some poses twice.
JudgedScan RandomScan(int num_models, std::mt19937* random) {
  JudgedScan scan;
  scan.num_pixels = kPixels;
  scan.T_local_sensor = RandomPose(random);
  for (int m = 0; m < num_models; ++m) {
    const double size = Uniform(random, 0.3, 1.5);
    scan.models.push_back({"model" + std::to_string(m),
                           {-size, -size, 0.0},
                           Eigen::Vector3d(size, size, 2.0 * size)});
  }
  for (int i = 0; i < 120; ++i) {
    ExplainingCandidate item;
    item.candidate.model = static_cast<int>((*random)() % static_cast<unsigned>(num_models));
    item.candidate.T_sensor_object = RandomPose(random);
    item.candidate.score = static_cast<double>((*random)() % 11) / 10.0;
    item.rank_score = static_cast<double>((*random)() % 3) / 3.0;
    item.explained = RandomRuns(random);
    scan.candidates.push_back(item);
    if (i % 10 == 0) scan.candidates.push_back(item);
  }
  scan.num_found = 1000;
  return scan;
}

// The scan as matchers see it that have these models each; part_of[m]: whose model m is.
std::vector<JudgedScan> Split(const JudgedScan& scan, const std::vector<int>& part_of, int parts) {
  std::vector<JudgedScan> list(static_cast<std::size_t>(parts));
  std::vector<int> place(scan.models.size());
  for (std::size_t m = 0; m < scan.models.size(); ++m) {
    place[m] = static_cast<int>(list[part_of[m]].models.size());
    list[part_of[m]].models.push_back(scan.models[m]);
  }
  for (const ExplainingCandidate& item : scan.candidates) {
    list[part_of[item.candidate.model]].candidates.push_back(item);
    list[part_of[item.candidate.model]].candidates.back().candidate.model =
        place[item.candidate.model];
  }
  for (JudgedScan& part : list) {
    part.num_pixels = scan.num_pixels;
    part.T_local_sensor = scan.T_local_sensor;
    part.num_found = scan.num_found / parts;
  }
  list.front().num_found += scan.num_found % parts;
  return list;
}

PipelineParams Params(std::mt19937* random) {
  PipelineParams params = DefaultParams(Method::kDefault);
  params.choice.min_probability = Uniform(random, 0.0, 1.0);
  params.choice.max_explained_share = Uniform(random, 0.0, 1.0);
  params.choice.same_class_distance = (*random)() % 4 == 0 ? 0.0 : Uniform(random, 0.0, 1.0);
  params.choice.other_class_distance = Uniform(random, 0.0, 0.5);
  params.max_reported_hypotheses = 1 + static_cast<int>((*random)() % 150);
  return params;
}

void ExpectSame(const DetectionResult& a, const DetectionResult& b) {
  EXPECT_EQ(a.num_hypotheses_found, b.num_hypotheses_found);
  ASSERT_EQ(a.detections.size(), b.detections.size());
  for (std::size_t i = 0; i < a.detections.size(); ++i) {
    EXPECT_EQ(a.detections[i].class_name, b.detections[i].class_name);
    EXPECT_EQ(a.detections[i].T_local_object.matrix(), b.detections[i].T_local_object.matrix());
    EXPECT_EQ(a.detections[i].box_min, b.detections[i].box_min);
    EXPECT_EQ(a.detections[i].box_max, b.detections[i].box_max);
    EXPECT_EQ(a.detections[i].score, b.detections[i].score);
  }
  ASSERT_EQ(a.hypotheses.size(), b.hypotheses.size());
  for (std::size_t i = 0; i < a.hypotheses.size(); ++i) {
    EXPECT_EQ(a.hypotheses[i].class_name, b.hypotheses[i].class_name);
    EXPECT_EQ(a.hypotheses[i].T_local_object.matrix(), b.hypotheses[i].T_local_object.matrix());
    EXPECT_EQ(a.hypotheses[i].score, b.hypotheses[i].score);
    EXPECT_EQ(a.hypotheses[i].stage, b.hypotheses[i].stage);
  }
}

TEST(CandidateChoiceTest, WhoJudgedWhichModelsDoesNotMatter) {
  std::size_t num_detections = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    std::mt19937 random(seed);
    const int num_models = 1 + static_cast<int>(random() % 9);
    const JudgedScan scan = RandomScan(num_models, &random);
    const PipelineParams params = Params(&random);
    const int parts = 1 + static_cast<int>(random() % 4);
    std::vector<int> part_of(scan.models.size());
    for (int& part : part_of) part = static_cast<int>(random() % static_cast<unsigned>(parts));
    std::vector<JudgedScan> split = Split(scan, part_of, parts);
    std::shuffle(split.begin(), split.end(), random);
    for (JudgedScan& part : split) part = WorthJoining(std::move(part), params);
    SCOPED_TRACE(seed);
    const DetectionResult whole = ChooseDetections(scan, params);
    ExpectSame(whole, ChooseDetections(Joined(split), params));
    num_detections += whole.detections.size();
  }
  EXPECT_GT(num_detections, 300u);
}

TEST(CandidateChoiceTest, AModelThatTwoLookedForCountsOnce) {
  std::mt19937 random(5);
  const JudgedScan scan = RandomScan(4, &random);
  const PipelineParams params = DefaultParams(Method::kDefault);
  std::vector<JudgedScan> parts = Split(scan, {0, 1, 1, 0}, 2);
  JudgedScan twice = Split(scan, {0, 1, 0, 1}, 2)[0];  // models 0 and 2, once more
  twice.num_found = 0;
  parts.push_back(twice);
  ExpectSame(ChooseDetections(scan, params), ChooseDetections(Joined(parts), params));
}

TEST(CandidateChoiceTest, WhatIsNotWorthJoiningIsLeftOut) {
  std::mt19937 random(1);
  const JudgedScan scan = RandomScan(3, &random);
  PipelineParams params = DefaultParams(Method::kDefault);
  params.choice.min_probability = 0.8;
  params.max_reported_hypotheses = 60;
  const JudgedScan worth = WorthJoining(scan, params);
  EXPECT_LT(worth.candidates.size(), scan.candidates.size());
  for (const ExplainingCandidate& item : worth.candidates) {
    const bool is_probable = item.candidate.score >= 0.8;
    EXPECT_TRUE(is_probable || item.explained.empty());
  }
}

TEST(CandidateChoiceTest, AllCandidatesAreListedBestFirst) {
  std::mt19937 random(2);
  const JudgedScan scan = RandomScan(4, &random);
  const StagedCandidates found = ChooseCandidates(scan, Params(&random).choice);
  EXPECT_EQ(found.scored.size(), scan.candidates.size());
  for (std::size_t i = 1; i < found.scored.size(); ++i)
    EXPECT_GE(found.scored[i - 1].score, found.scored[i].score);
}

TEST(CandidateChoiceTest, EqualScoresAreDecidedByRankThenName) {
  JudgedScan scan;
  scan.num_pixels = 10;
  const Eigen::Vector3d half(0.5, 0.5, 0.5);
  scan.models = {{"b", -half, half}, {"a", -half, half}};
  const auto add = [&](int model, double rank_score) {
    scan.candidates.push_back({{model, Eigen::Isometry3d::Identity(), 0.9}, rank_score, {{0, 10}}});
  };
  add(0, 0.2);
  add(1, 0.2);
  EXPECT_EQ(ChooseDetections(scan, DefaultParams(Method::kDefault)).detections[0].class_name, "a");
  add(0, 0.3);
  EXPECT_EQ(ChooseDetections(scan, DefaultParams(Method::kDefault)).detections[0].class_name, "b");
}

// As answers of strangers may be.
TEST(CandidateChoiceTest, PartsThatDisagreeOnTheImageAreSafe) {
  std::mt19937 random(6);
  std::vector<JudgedScan> parts = Split(RandomScan(4, &random), {0, 0, 1, 1}, 2);
  parts[0].num_pixels = 0;
  for (ExplainingCandidate& item : parts[0].candidates) item.explained.clear();
  EXPECT_EQ(Joined(parts).num_pixels, kPixels);
  ChooseDetections(Joined(parts), DefaultParams(Method::kDefault));
}

TEST(CandidateChoiceTest, NothingGivesNothing) {
  const DetectionResult result = ChooseDetections(Joined({}), DefaultParams(Method::kDefault));
  EXPECT_TRUE(result.detections.empty());
  EXPECT_TRUE(result.hypotheses.empty());
}

TEST(RunsOfTest, HoldThePixels) {
  std::mt19937 random(3);
  for (int round = 0; round < 100; ++round) {
    std::vector<int> pixels;
    for (int i = 0; i < 50; ++i) pixels.push_back(static_cast<int>(random() % 80));
    std::sort(pixels.begin(), pixels.end());
    pixels.erase(std::unique(pixels.begin(), pixels.end()), pixels.end());
    std::vector<int> back;
    int end = -1;
    for (const PixelRun& run : RunsOf(pixels)) {
      EXPECT_GT(run.first, end);  // runs are apart
      end = run.first + run.count;
      for (int i = 0; i < run.count; ++i) back.push_back(run.first + i);
    }
    EXPECT_EQ(back, pixels);
  }
  EXPECT_TRUE(RunsOf({}).empty());
}

}  // namespace
}  // namespace rimod
