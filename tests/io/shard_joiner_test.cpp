#include "io/shard_joiner.h"

#include <gtest/gtest.h>

namespace rimod {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Names = std::vector<std::string>;

class ShardJoinerTest : public ::testing::Test {
 protected:
  static Shard ShardOf(const std::string& name, std::int64_t instance = 1) {
    Shard shard;
    shard.name = name;
    if (name.find('/') != std::string::npos) {
      shard.index = std::stoi(name);
      shard.count = std::stoi(name.substr(name.find('/') + 1));
    }
    shard.instance = instance;
    return shard;
  }
  void Announce(const Names& names) {
    for (const std::string& name : names) joiner_.Hear(ShardOf(name), now_);
  }
  // Lets time pass in which these are there.
  void Wait(milliseconds duration, const Names& present) {
    for (const Time end = now_ + duration; now_ < end; now_ += milliseconds(100)) Announce(present);
  }
  // Each scan's utime, then who answered, then after "-" who did not.
  std::string Answer(const std::string& name, std::int64_t utime, std::int64_t digest = 0,
                     std::int64_t instance = 1) {
    ShardAnswer answer;
    answer.utime = utime;
    answer.scan = digest;
    answer.shard = ShardOf(name, instance);
    joiner_.Add(std::move(answer), now_);
    return Decided();
  }
  std::string Decided() {
    std::string text;
    for (const AnsweredScan& scan : joiner_.TakeDecided(now_)) {
      text += (text.empty() ? "" : "; ") + std::to_string(scan.answers.front().utime);
      for (const ShardAnswer& answer : scan.answers) {
        EXPECT_EQ(answer.utime, scan.answers.front().utime);
        EXPECT_EQ(answer.scan, scan.answers.front().scan);
        text += " " + answer.shard.name;
      }
      for (const std::string& name : scan.without) text += " -" + name;
    }
    return text;
  }

  using Time = ShardJoiner::Time;
  Time now_ = Time() + seconds(1000);
  ShardJoiner joiner_{ShardJoinerParams(), now_};
};

TEST_F(ShardJoinerTest, AScanIsJoinedWhenAllHaveAnswered) {
  Wait(seconds(5), {"a", "b", "c"});
  EXPECT_EQ(Answer("b", 1), "");
  EXPECT_EQ(Answer("a", 1), "");
  EXPECT_EQ(Answer("c", 1), "1 a b c");
  EXPECT_EQ(joiner_.num_open(), 0u);
}

TEST_F(ShardJoinerTest, AtFirstItListensWhoIsThere) {
  EXPECT_EQ(Answer("a", 1), "");
  Wait(milliseconds(500), {"a", "b"});
  EXPECT_EQ(Answer("b", 1), "");
  Wait(milliseconds(2000), {"a", "b"});
  EXPECT_EQ(Decided(), "1 a b");
}

TEST_F(ShardJoinerTest, OfShardsByNumberAllAreExpectedAndNamedWhenMissing) {
  Wait(milliseconds(2500), {"1/3"});
  EXPECT_EQ(Answer("1/3", 1), "");
  EXPECT_EQ(Answer("3/3", 1), "");
  Wait(milliseconds(1000), {"1/3", "3/3"});
  EXPECT_EQ(Decided(), "1 1/3 3/3 -2/3") << "it never spoke";
  EXPECT_EQ(joiner_.Missing(now_), Names{"2/3"});
  EXPECT_EQ(joiner_.Present(now_), (Names{"1/3", "3/3"}));
  EXPECT_EQ(Answer("1/3", 2), "");
  EXPECT_EQ(Answer("3/3", 2), "2 1/3 3/3 -2/3") << "the missing one is not waited for any more";
}

TEST_F(ShardJoinerTest, OneThatDiesCostsItsModelsAndOneWait) {
  Wait(seconds(5), {"a", "b"});
  EXPECT_EQ(Answer("a", 1), "");
  EXPECT_EQ(Answer("b", 1), "1 a b");
  EXPECT_EQ(Answer("a", 2), "");
  Wait(milliseconds(3100), {"a"});
  EXPECT_EQ(Decided(), "2 a -b");
  EXPECT_EQ(Answer("a", 3), "3 a -b");
  EXPECT_EQ(joiner_.Missing(now_), Names{"b"});
  Announce({"b"});
  EXPECT_EQ(joiner_.Missing(now_), Names{});
  EXPECT_EQ(Answer("a", 4), "") << "b is back";
  EXPECT_EQ(Answer("b", 4), "4 a b");
}

TEST_F(ShardJoinerTest, OneThatIsThereButSilentAboutAScanIsWaitedForWithPatience) {
  Wait(seconds(5), {"a", "b"});
  EXPECT_EQ(Answer("a", 1), "");
  Wait(milliseconds(4900), {"a", "b"});
  EXPECT_EQ(Decided(), "");
  Wait(milliseconds(200), {"a", "b"});
  EXPECT_EQ(Decided(), "1 a -b");
  EXPECT_EQ(Answer("b", 1), "");
  EXPECT_EQ(joiner_.counters().late, 1);
}

TEST_F(ShardJoinerTest, OneThatWentOnToALaterScanIsNotWaitedFor) {
  Wait(seconds(5), {"a", "b"});
  EXPECT_EQ(Answer("a", 1), "");
  EXPECT_EQ(Answer("b", 2), "1 a -b");
  EXPECT_EQ(Answer("a", 2), "2 a b");
  EXPECT_EQ(Answer("a", 4), "");
  EXPECT_EQ(Answer("b", 3), "3 b -a") << "the order of time where nothing else is known";
  EXPECT_EQ(Answer("b", 4), "4 a b");
}

TEST_F(ShardJoinerTest, AClockThatStepsBackMixesNothingUp) {
  Wait(seconds(5), {"a", "b"});
  EXPECT_EQ(Answer("a", 1000), "");
  EXPECT_EQ(Answer("b", 1000), "1000 a b");
  EXPECT_EQ(Answer("a", 10), "") << "b answered 1000, but before";
  EXPECT_EQ(Answer("b", 10), "10 a b");
}

TEST_F(ShardJoinerTest, ScansOfOneTimeAreToldApart) {
  Wait(seconds(5), {"a", "b"});
  EXPECT_EQ(Answer("a", 1, 100), "");
  EXPECT_EQ(Answer("b", 1, 200), "");
  EXPECT_EQ(Answer("a", 1, 200), "1 a -b; 1 a b") << "b answered the second without the first";
}

TEST_F(ShardJoinerTest, RepeatedAnswersAndTwinsCountOnce) {
  Wait(seconds(5), {"a", "b"});
  EXPECT_EQ(Answer("a", 1), "");
  EXPECT_EQ(Answer("a", 1), "");
  EXPECT_EQ(Answer("a", 1, 0, /*instance=*/2), "");
  EXPECT_EQ(Answer("b", 1), "1 a b");
  EXPECT_EQ(Answer("b", 1, 0, /*instance=*/2), "");
  EXPECT_EQ(joiner_.num_open(), 0u);
  EXPECT_EQ(joiner_.counters().repeated, 1);
  EXPECT_EQ(joiner_.counters().twins, 2);
}

TEST_F(ShardJoinerTest, AReplayIsJoinedAgain) {
  Wait(seconds(5), {"a", "b"});
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(Answer("a", 1), "");
    EXPECT_EQ(Answer("b", 1), "1 a b");
  }
}

TEST_F(ShardJoinerTest, AShardThatJoinsIsExpectedFromTheNextScanOn) {
  Wait(seconds(5), {"a"});
  EXPECT_EQ(Answer("a", 1), "1 a");
  EXPECT_EQ(Answer("b", 1), "") << "late";
  now_ += milliseconds(1);
  EXPECT_EQ(Answer("a", 2), "");
  EXPECT_EQ(Answer("b", 2), "2 a b");
}

TEST_F(ShardJoinerTest, WhoIsGoneForLongIsForgotten) {
  Wait(seconds(5), {"a", "b", "1/2", "2/2"});
  Wait(std::chrono::minutes(11), {"a", "1/2"});
  EXPECT_EQ(joiner_.Missing(now_), Names{"2/2"}) << "its sibling is there";
  EXPECT_EQ(joiner_.Present(now_), (Names{"1/2", "a"}));
}

TEST_F(ShardJoinerTest, NeitherScansNorShardsPileUp) {
  Wait(seconds(3), {"a", "b"});
  for (std::int64_t scan = 1; scan <= 1000; ++scan) {
    Answer("a", scan % 2 == 0 ? scan : -scan, scan);  // never what b answers
    EXPECT_LE(joiner_.num_open(), 17u);
  }
  for (int i = 0; i < 1000; ++i) Announce({"shard" + std::to_string(i)});
  EXPECT_LE(joiner_.Present(now_).size(), 64u);
  EXPECT_GT(joiner_.counters().too_many, 0);
}

}  // namespace
}  // namespace rimod
