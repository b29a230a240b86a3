#include "io/shard_conductor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "io/turn_taker.h"
#include "tests/io/random_values.h"

namespace rimod {
namespace {

using std::chrono::milliseconds;
using Names = std::vector<std::string>;
using Time = ShardConductor::Time;

Shard ShardOf(const std::string& name, std::int64_t instance = 1) {
  Shard shard;
  shard.name = name;
  shard.instance = instance;
  return shard;
}

class ShardConductorTest : public ::testing::Test {
 protected:
  void Tell(const std::string& name, std::int64_t utime, bool held = true,
            std::int64_t instance = 1) {
    conductor_.Hear({ShardOf(name, instance), utime, 10 * utime, held}, now_);
  }
  void Answer(const std::string& name, std::int64_t utime) {
    conductor_.Answered(ShardOf(name), utime, 10 * utime);
  }
  // The utime of the turn that begins now; 0: none does.
  std::int64_t Next() {
    if (!conductor_.Advance(present_, now_)) return 0;
    EXPECT_EQ(conductor_.turn().scan, 10 * conductor_.turn().utime);
    return conductor_.turn().utime;
  }

  Names present_ = {"a", "b"};
  Time now_ = Time() + milliseconds(1000);
  ShardConductor conductor_;
};

TEST_F(ShardConductorTest, AScanThatAllHaveGetsItsTurnAtOnce) {
  EXPECT_EQ(Next(), 0);
  Tell("a", 1);
  EXPECT_EQ(Next(), 0);
  Tell("b", 1);
  EXPECT_EQ(Next(), 1);
  EXPECT_EQ(conductor_.turn().number, 1);
}

TEST_F(ShardConductorTest, AfterAllAnswersTheNewestThatAllHaveFollows) {
  for (const char* const name : {"a", "b"}) Tell(name, 1);
  EXPECT_EQ(Next(), 1);
  for (const std::int64_t utime : {2, 3}) {
    Tell("a", utime);
    Tell("b", utime);
  }
  Tell("a", 4);
  Answer("a", 1);
  EXPECT_EQ(Next(), 0);
  Answer("b", 1);
  EXPECT_EQ(Next(), 3);
  Answer("a", 3);
  Answer("b", 3);
  EXPECT_EQ(Next(), 0) << "2 was overtaken, b may still get 4";
  Tell("b", 4);
  EXPECT_EQ(Next(), 4);
}

TEST_F(ShardConductorTest, AScanThatOneHasLostGetsItsTurnAfterTheGrace) {
  Tell("a", 1);
  now_ += milliseconds(149);
  EXPECT_EQ(Next(), 0);
  now_ += milliseconds(1);
  EXPECT_EQ(Next(), 1);
  Tell("b", 2);
  Tell("a", 2);
  Answer("a", 1);
  EXPECT_EQ(Next(), 2) << "b is not waited for: it has not got the first";
}

TEST_F(ShardConductorTest, WhoHasTheScanNoMoreOrIsGoneOrAnewIsNotWaitedFor) {
  const auto begin = [this](std::int64_t utime) {
    for (const char* const name : {"a", "b"}) Tell(name, utime);
    EXPECT_EQ(Next(), utime);
    Answer("a", utime);
    for (const char* const name : {"a", "b"}) Tell(name, utime + 1);
    EXPECT_EQ(Next(), 0);
  };
  begin(1);
  const auto end = [this](std::int64_t utime) {
    for (const char* const name : {"a", "b"}) Answer(name, utime);
  };
  Tell("b", 1, /*held=*/false);
  EXPECT_EQ(Next(), 2);
  end(2);
  begin(11);
  present_ = {"a"};
  EXPECT_EQ(Next(), 12);
  end(12);
  present_ = {"a", "b"};
  begin(21);
  Tell("b", 22, true, /*instance=*/2);
  EXPECT_EQ(Next(), 22);
}

TEST_F(ShardConductorTest, WhereScansMayWaitTheyGetTheirTurnsInOrder) {
  ShardConductorParams params;
  params.max_waiting = 3;
  conductor_ = ShardConductor(params);
  for (std::int64_t utime = 1; utime <= 5; ++utime)
    for (const char* const name : {"a", "b"}) Tell(name, utime);
  for (const std::int64_t utime : {3, 4, 5}) {
    EXPECT_EQ(Next(), utime);
    for (const char* const name : {"a", "b"}) Answer(name, utime);
  }
  EXPECT_EQ(Next(), 0);
}

TEST_F(ShardConductorTest, ATurnEndsWhenPatienceDoes) {
  for (const char* const name : {"a", "b"}) Tell(name, 1);
  EXPECT_EQ(Next(), 1);
  for (const char* const name : {"a", "b"}) Tell(name, 2);
  now_ += milliseconds(4999);
  EXPECT_EQ(Next(), 0);
  now_ += milliseconds(1);
  EXPECT_EQ(Next(), 2);
  EXPECT_EQ(conductor_.num_given_up(), 1);
}

TEST_F(ShardConductorTest, WhatIsToldDoesNotPileUp) {
  for (std::int64_t utime = 1; utime < 10'000; ++utime) Tell("a", utime);
  EXPECT_LE(conductor_.num_offered(), 17u);
}

DescribedScan ScanAt(std::int64_t utime) {
  DescribedScan scan;
  scan.utime = utime;
  return scan;
}

class TurnTakerTest : public ::testing::Test {
 protected:
  std::int64_t Add(std::int64_t utime) {
    return UtimeOf(taker_.Add(ScanAt(utime), 10 * utime, now_));
  }
  std::int64_t Turn(std::int64_t number, std::int64_t utime, std::int64_t fuser = 7) {
    return UtimeOf(taker_.Hear({fuser, number, utime, 10 * utime}, now_));
  }
  static std::int64_t UtimeOf(const std::optional<DescribedScan>& scan) {
    return scan ? scan->utime : 0;
  }

  Time now_ = Time() + milliseconds(1000);
  TurnTaker taker_;
};

TEST_F(TurnTakerTest, WithoutAFuserEachScanIsWorkedOnAsItComes) {
  EXPECT_EQ(Add(1), 1);
  EXPECT_EQ(Add(2), 2);
}

TEST_F(TurnTakerTest, WithAFuserScansWaitForTheirTurnAndOlderOnesAreOvertaken) {
  EXPECT_EQ(Turn(0, 0), 0);
  for (const std::int64_t utime : {1, 2, 3}) EXPECT_EQ(Add(utime), 0);
  EXPECT_EQ(Turn(1, 2), 2);
  EXPECT_EQ(Turn(1, 2), 0) << "told again";
  EXPECT_FALSE(taker_.TakeLacking());
  EXPECT_EQ(taker_.num_overtaken(), 1);
  EXPECT_EQ(taker_.num_held(), 1u);
  for (const std::int64_t utime : {4, 5, 6}) EXPECT_EQ(Add(utime), 0);
  EXPECT_EQ(taker_.num_held(), 3u);
  EXPECT_EQ(taker_.num_overtaken(), 2);
}

TEST_F(TurnTakerTest, AScanThatIsNotHereIsToldOnceAndWorkedOnWhenItComesAfterAll) {
  Turn(0, 0);
  EXPECT_EQ(Turn(1, 5), 0);
  EXPECT_TRUE(taker_.TakeLacking());
  EXPECT_FALSE(taker_.TakeLacking());
  EXPECT_EQ(Add(5), 5);
  EXPECT_EQ(Add(5), 0) << "replayed: it waits for a turn of its own";
}

TEST_F(TurnTakerTest, WhenTheFuserFallsSilentTheNewestIsWorkedOn) {
  Turn(0, 0);
  Add(1);
  Add(2);
  EXPECT_FALSE(taker_.OnIdle(now_));
  now_ += milliseconds(1001);
  EXPECT_EQ(UtimeOf(taker_.OnIdle(now_)), 2);
  EXPECT_EQ(taker_.num_overtaken(), 1);
  EXPECT_EQ(Add(3), 3);
}

TEST_F(TurnTakerTest, AFuserThatGivesNoTurnsIsNotWaitedForForever) {
  Turn(0, 0);
  Add(1);
  for (int i = 0; i < 100; ++i) {
    EXPECT_FALSE(taker_.OnIdle(now_));
    now_ += milliseconds(100);
    Turn(0, 0);
  }
  now_ += milliseconds(1);
  EXPECT_EQ(UtimeOf(taker_.OnIdle(now_)), 1);
}

TEST_F(TurnTakerTest, OfTwoFusersAllFollowTheSameOne) {
  Turn(0, 0, 7);
  Add(1);
  Add(2);
  EXPECT_EQ(Turn(9, 1, 8), 0);
  EXPECT_EQ(Turn(1, 1, 7), 1);
  EXPECT_EQ(Turn(3, 2, 6), 2) << "the lower one leads from now on";
  Add(3);
  EXPECT_EQ(Turn(2, 3, 7), 0);
}

// Shards of different speeds, messages that take their time, a sensor faster than any shard: all
// work on the same scans, one after the other, and what they work on is new.
TEST(ShardsInStepTest, UnderOverloadAllShardsWorkOnTheSameNewScans) {
  struct Simulated {
    std::string name;
    int ms = 0;  // that a scan takes
    TurnTaker taker;
    std::int64_t at_work = 0, done_at = 0;  // a scan's utime, 0: idle; ms
    std::vector<std::int64_t> done;
  };
  RandomValues random(5);
  for (int round = 0; round < 20; ++round) {
    std::vector<Simulated> shards(static_cast<std::size_t>(random.Int(2, 5)));
    Names names;
    int slowest = 0;
    for (Simulated& shard : shards) {
      shard.name = std::to_string(names.size() + 1);
      shard.ms = random.Int(150, 900);
      slowest = std::max(slowest, shard.ms);
      names.push_back(shard.name);
    }
    ShardConductor conductor;
    const int period = random.Int(30, 140), jitter = random.Int(0, 25);
    std::int64_t worst = 0;
    struct Arrival {
      std::int64_t at, utime;
      std::size_t shard;
    };
    std::vector<Arrival> arrivals;
    for (std::int64_t ms = 1; ms < 30'000; ++ms) {
      const Time now = Time() + milliseconds(100'000 + ms);
      if (ms % period == 0)
        for (std::size_t i = 0; i < shards.size(); ++i)
          arrivals.push_back({ms + random.Int(0, jitter), ms, i});
      const auto begin = [&](Simulated* shard, const std::optional<DescribedScan>& scan) {
        if (!scan) return;
        EXPECT_EQ(shard->at_work, 0);
        shard->at_work = scan->utime;
        shard->done_at = ms + shard->ms;
      };
      for (const Arrival& arrival : arrivals) {
        if (arrival.at != ms) continue;
        Simulated& shard = shards[arrival.shard];
        begin(&shard, shard.taker.Add(ScanAt(arrival.utime), 0, now));
        conductor.Hear({ShardOf(shard.name), arrival.utime, 0, true}, now);
      }
      for (Simulated& shard : shards) {
        if (shard.at_work == 0 || shard.done_at != ms) continue;
        conductor.Answered(ShardOf(shard.name), shard.at_work, 0);
        shard.done.push_back(shard.at_work);
        worst = std::max(worst, ms - shard.at_work);
        shard.at_work = 0;
      }
      conductor.Advance(names, now);
      for (Simulated& shard : shards) {
        begin(&shard, shard.taker.Hear(conductor.turn(), now));
        EXPECT_FALSE(shard.taker.TakeLacking());
      }
    }
    const std::size_t num_done = shards.front().done.size();
    EXPECT_GE(num_done, static_cast<std::size_t>(29'000 / (slowest + period)));
    for (const Simulated& shard : shards) {
      const std::size_t common = std::min(num_done, shard.done.size());
      EXPECT_TRUE(std::equal(shard.done.begin(),
                             shard.done.begin() + static_cast<std::ptrdiff_t>(common),
                             shards.front().done.begin()));
    }
    EXPECT_LT(worst, 2 * slowest) << "ms from the scan to the last answer";
    EXPECT_EQ(conductor.num_given_up(), 0);
  }
}

}  // namespace
}  // namespace rimod
