#include "io/shard_messages.h"

#include <gtest/gtest.h>

#include <limits>

#include "io/message_codec.h"
#include "tests/io/random_answers.h"

namespace rimod {
namespace {

using Sections = std::vector<shard_candidates_t>;

Sections ThroughBytes(const Sections& sections) {
  Sections received;
  for (const shard_candidates_t& section : sections) {
    const std::vector<std::uint8_t> bytes = EncodeMessage(section);
    EXPECT_LE(bytes.size(), static_cast<std::size_t>(kSectionBytes) + 100);
    received.push_back(
        DecodeMessage<shard_candidates_t>(bytes.data(), bytes.size()).message.value());
  }
  return received;
}

void ExpectSame(const JudgedScan& a, const JudgedScan& b) {
  EXPECT_EQ(a.num_pixels, b.num_pixels);
  EXPECT_EQ(a.T_local_sensor.matrix(), b.T_local_sensor.matrix());
  EXPECT_EQ(a.num_found, b.num_found);
  ASSERT_EQ(a.models.size(), b.models.size());
  for (std::size_t i = 0; i < a.models.size(); ++i) {
    EXPECT_EQ(a.models[i].name, b.models[i].name);
    EXPECT_EQ(a.models[i].box_min, b.models[i].box_min);
    EXPECT_EQ(a.models[i].box_max, b.models[i].box_max);
  }
  ASSERT_EQ(a.candidates.size(), b.candidates.size());
  for (std::size_t i = 0; i < a.candidates.size(); ++i) {
    const ExplainingCandidate &x = a.candidates[i], &y = b.candidates[i];
    EXPECT_EQ(x.candidate.model, y.candidate.model);
    EXPECT_EQ(x.candidate.T_sensor_object.matrix(), y.candidate.T_sensor_object.matrix());
    EXPECT_EQ(x.candidate.score, y.candidate.score);
    EXPECT_EQ(x.rank_score, y.rank_score);
    ASSERT_EQ(x.explained.size(), y.explained.size());
    for (std::size_t k = 0; k < x.explained.size(); ++k) {
      EXPECT_EQ(x.explained[k].first, y.explained[k].first);
      EXPECT_EQ(x.explained[k].count, y.explained[k].count);
    }
  }
}

TEST(ShardMessagesTest, AnswersComeBackBitForBit) {
  RandomValues random(1);
  std::size_t most_sections = 0;
  for (const int num_candidates : {0, 1, 50, 600}) {
    const ShardAnswer sent = RandomAnswer(&random, "2/4", 9, num_candidates);
    const Sections sections = ThroughBytes(ToSections(sent));
    most_sections = std::max(most_sections, sections.size());
    const JoinedShardAnswer received = JoinShardSections(sections);
    ASSERT_TRUE(received.answer) << received.error;
    EXPECT_EQ(received.answer->utime, sent.utime);
    EXPECT_EQ(received.answer->scan, sent.scan);
    EXPECT_EQ(received.answer->shard.name, "2/4");
    EXPECT_EQ(received.answer->shard.index, 2);
    EXPECT_EQ(received.answer->shard.count, 4);
    EXPECT_EQ(received.answer->shard.instance, sent.shard.instance);
    EXPECT_EQ(received.answer->shard.params, sent.shard.params);
    EXPECT_EQ(received.answer->stage_times, sent.stage_times);
    ExpectSame(received.answer->judged, sent.judged);
  }
  EXPECT_GT(most_sections, 2u);
}

TEST(ShardMessagesTest, ManyRunsOfOneCandidateAreCutAnywhere) {
  RandomValues random(2);
  ShardAnswer sent = RandomAnswer(&random, "fan", 1, 1);
  sent.judged.num_pixels = 1'000'000;
  sent.judged.candidates[0].explained.clear();
  for (int i = 0; i < 30'000; ++i) sent.judged.candidates[0].explained.push_back({3 * i, 2});
  const Sections sections = ThroughBytes(ToSections(sent));
  EXPECT_GT(sections.size(), 3u);
  const JoinedShardAnswer received = JoinShardSections(sections);
  ASSERT_TRUE(received.answer) << received.error;
  ExpectSame(received.answer->judged, sent.judged);
}

TEST(ShardMessagesTest, ShardsComeBack) {
  for (const Shard& sent : {Shard{"2/4", 2, 4, 77, -5, 3}, Shard{"fan,table", 0, 0, -1, 1, 0}}) {
    const shard_t message = ToMessage(sent, 12);
    EXPECT_EQ(message.utime, 12);
    const ShardFromMessage received = FromMessage(message);
    ASSERT_TRUE(received.shard) << received.error;
    EXPECT_EQ(received.shard->name, sent.name);
    EXPECT_EQ(received.shard->index, sent.index);
    EXPECT_EQ(received.shard->count, sent.count);
    EXPECT_EQ(received.shard->instance, sent.instance);
    EXPECT_EQ(received.shard->params, sent.params);
    EXPECT_EQ(received.shard->num_models, sent.num_models);
  }
}

TEST(ShardMessagesTest, BadShardsAreRejected) {
  const auto error = [](Shard shard) { return FromMessage(ToMessage(shard, 0)).error; };
  EXPECT_NE(error({"", 0, 0, 0, 0, 0}), "");
  EXPECT_NE(error({std::string(201, 'a'), 0, 0, 0, 0, 0}), "");
  EXPECT_NE(error({"a b", 0, 0, 0, 0, 0}), "");
  EXPECT_NE(error({"2/4", 0, 4, 0, 0, 0}), "");
  EXPECT_NE(error({"5/4", 5, 4, 0, 0, 0}), "");
  EXPECT_NE(error({"3/4", 2, 4, 0, 0, 0}), "") << "a name that says another number";
  EXPECT_NE(error({"1/2000000000", 1, 2'000'000'000, 0, 0, 0}), "");
  EXPECT_NE(error({"fan", 0, 0, 0, 0, -1}), "");
}

class HostileAnswerTest : public ::testing::Test {
 protected:
  HostileAnswerTest() {
    RandomValues random(3);
    answer_ = RandomAnswer(&random, "1/2", 3, 200);
    answer_.judged.candidates[0].explained = {{1, 2}, {7, 3}};
    sections_ = ToSections(answer_);
    EXPECT_EQ(sections_.size(), 2u);
  }
  std::string Error() const {
    const JoinedShardAnswer joined = JoinShardSections(sections_);
    EXPECT_NE(joined.answer.has_value(), !joined.error.empty());
    return joined.error;
  }

  ShardAnswer answer_;
  Sections sections_;
};

TEST_F(HostileAnswerTest, AsItIsItIsGood) { EXPECT_EQ(Error(), ""); }

TEST_F(HostileAnswerTest, MissingAndForeignSections) {
  Sections all = sections_;
  sections_.pop_back();
  EXPECT_NE(Error(), "");
  sections_ = {all[1], all[0]};
  EXPECT_NE(Error(), "");
  sections_ = all;
  sections_[1].scan += 1;
  EXPECT_NE(Error(), "");
  sections_ = all;
  sections_[1].shard.instance += 1;
  EXPECT_NE(Error(), "");
  EXPECT_NE(JoinShardSections({}).error, "");
}

TEST_F(HostileAnswerTest, BadNumbers) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const Sections good = sections_;
  const std::vector<std::function<void(shard_candidates_t*)>> faults = {
      [](auto* s) { s->candidates[0].score = 1.5; },
      [](auto* s) { s->candidates[0].score = kNan; },
      [](auto* s) { s->candidates[0].rank_score = kNan; },
      [](auto* s) { s->candidates[0].model = 3; },
      [](auto* s) { s->candidates[0].model = -1; },
      [](auto* s) { s->candidates[0].position[1] = kNan; },
      [](auto* s) { s->candidates[0].rotation[4] += 1.0; },
      [](auto* s) {
        for (double& value : s->candidates[0].rotation) value = -value;  // a mirror
      },
      [](auto* s) { s->candidates[0].num_runs = -1; },
      [](auto* s) { s->candidates[0].num_runs += 1; },
      [](auto* s) { s->candidates[0].num_runs = 2'000'000'000; },
      [](auto* s) { s->models[1].name = s->models[0].name; },
      [](auto* s) { s->models[1].name = "../x"; },
      [](auto* s) { s->models[1].box_min[0] = kNan; },
      [](auto* s) { s->models[1].box_max[0] = 1e9; },
      [](auto* s) { s->num_models += 1; },
      [](auto* s) { s->num_candidates -= 1; },
      [](auto* s) { s->num_stage_times = -1; },
      [](auto* s) { s->stage_times[0].stage = std::string(1000, 'x'); },
  };
  for (std::size_t i = 0; i < faults.size(); ++i) {
    sections_ = good;
    faults[i](&sections_[0]);
    EXPECT_NE(Error(), "") << "fault " << i;
  }
}

TEST_F(HostileAnswerTest, BadHeaders) {
  const Sections good = sections_;
  const std::vector<std::function<void(shard_candidates_t*)>> faults = {
      [](auto* s) { s->num_pixels = -1; },
      [](auto* s) { s->num_pixels = 2'000'000'000; },
      [](auto* s) { s->num_pixels = 5; },  // runs leave it
      [](auto* s) { s->num_found = -1; },
      [](auto* s) { s->num_found = 2'000'000'000; },
      [](auto* s) { s->sensor_orientation[0] = 7.0; },
      [](auto* s) { s->shard.num_models = 4; },
      [](auto* s) { s->shard.name = ""; },
  };
  for (std::size_t i = 0; i < faults.size(); ++i) {
    sections_ = good;
    for (shard_candidates_t& section : sections_) faults[i](&section);
    EXPECT_NE(Error(), "") << "fault " << i;
  }
}

TEST_F(HostileAnswerTest, BadRuns) {
  const auto with_runs = [&](std::vector<PixelRun> runs) {
    answer_.judged.candidates[0].explained = std::move(runs);
    sections_ = ToSections(answer_);
    return Error();
  };
  const int end = answer_.judged.num_pixels;
  EXPECT_EQ(with_runs({{0, 1}, {1, 1}, {end - 1, 1}}), "");
  EXPECT_NE(with_runs({{5, 2}, {6, 1}}), "") << "overlap";
  EXPECT_NE(with_runs({{5, 1}, {2, 1}}), "") << "falling";
  EXPECT_NE(with_runs({{-1, 1}}), "");
  EXPECT_NE(with_runs({{5, 0}}), "");
  EXPECT_NE(with_runs({{5, -3}}), "");
  EXPECT_NE(with_runs({{end - 1, 2}}), "");
  EXPECT_NE(with_runs({{2'147'483'647, 2'147'483'647}}), "");
}

TEST_F(HostileAnswerTest, AbsurdlyManyPixels) {
  answer_.judged.num_pixels = 16'000'000;
  for (int i = 0; i < 10; ++i) answer_.judged.candidates[i].explained = {{0, 16'000'000}};
  sections_ = ToSections(answer_);
  EXPECT_NE(Error(), "");
}

TEST(DigestTest, TellsScansAndParametersApart) {
  RandomValues random(4);
  DescribedScan scan{5, random.AnImage(20, 10), random.Features(7, 5)};
  const std::int64_t digest = DigestOf(scan);
  EXPECT_EQ(DigestOf(scan), digest);
  DescribedScan other = scan;
  other.features.features[6].descriptor[4] ^= 1;
  EXPECT_NE(DigestOf(other), digest);
  other = scan;
  other.image.SetNoReturn(0, 0);
  scan.image.SetMeasured(0, 0, {17, 0, 0});
  EXPECT_NE(DigestOf(other), DigestOf(scan));

  PipelineParams params = DefaultParams(Method::kDefault);
  const std::int64_t params_digest = DigestOf(params);
  EXPECT_EQ(DigestOf(DefaultParams(Method::kDefault)), params_digest);
  params.choice.min_probability = std::nextafter(params.choice.min_probability, 1.0);
  EXPECT_NE(DigestOf(params), params_digest);
}

}  // namespace
}  // namespace rimod
