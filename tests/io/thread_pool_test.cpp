#include "io/thread_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

namespace rimod {
namespace {

TEST(ThreadPoolTest, EverySlotIsFilledOnce) {
  for (const int threads : {1, 2, 5}) {
    ThreadPool pool(threads);
    EXPECT_EQ(pool.num_threads(), threads);
    for (const std::size_t count : {0u, 1u, 2u, 7u, 1000u}) {
      std::vector<int> slots(count, 0);
      pool.ParallelFor(count, [&](std::size_t i) { slots[i] += static_cast<int>(i) + 1; });
      for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(slots[i], static_cast<int>(i) + 1);
    }
  }
}

TEST(ThreadPoolTest, ManyShortLoopsInARow) {
  ThreadPool pool(4);
  std::atomic<int> calls{0};
  for (int i = 0; i < 2000; ++i) pool.ParallelFor(3, [&](std::size_t) { ++calls; });
  EXPECT_EQ(calls, 6000);
}

TEST(ThreadPoolTest, LoopsInsideABodyRun) {
  ThreadPool pool(3);
  std::vector<int> sums(10, 0);
  pool.ParallelFor(10, [&](std::size_t i) {
    pool.ParallelFor(10, [&](std::size_t k) { sums[i] += static_cast<int>(k); });
  });
  EXPECT_EQ(sums, std::vector<int>(10, 45));
}

TEST(ThreadPoolTest, TheFirstFailureReachesTheCallerAndThePoolGoesOn) {
  for (const int threads : {1, 4}) {
    ThreadPool pool(threads);
    const auto fail = [](std::size_t i) {
      if (i == 13 || i == 70) throw std::runtime_error("body " + std::to_string(i));
    };
    try {
      pool.ParallelFor(100, fail);
      ADD_FAILURE() << "no exception";
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "body 13");
    }
    std::atomic<int> calls{0};
    pool.ParallelFor(100, [&](std::size_t) { ++calls; });
    EXPECT_EQ(calls, 100);
  }
}

TEST(ThreadPoolTest, NoNumberOfThreadsMeansAllOfTheMachine) {
  EXPECT_GE(ThreadPool(0).num_threads(), 1);
  EXPECT_EQ(ThreadPool(-3).num_threads(), ThreadPool(0).num_threads());
}

}  // namespace
}  // namespace rimod
