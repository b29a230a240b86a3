#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include "io/newest_worker.h"
#include "io/stoppable.h"
#include "io/thread_pool.h"

namespace rimod {
namespace {

TEST(NewestWorkerTest, OverTheItemAtHandTheNewestWins) {
  std::promise<void> started, release;
  std::vector<int> done;
  int num_overtaken = 0;
  {
    std::promise<void> finished;
    NewestWorker<int> worker(
        1, [] {},
        [&](int item) {
          if (item == 0) {
            started.set_value();
            release.get_future().wait();
          }
          done.push_back(item);
          if (item == 4) finished.set_value();
        });
    num_overtaken += worker.Give(0);
    started.get_future().wait();
    for (const int item : {1, 2, 3, 4}) num_overtaken += worker.Give(item);
    release.set_value();
    finished.get_future().wait();
  }
  EXPECT_EQ(done, (std::vector<int>{0, 4}));
  EXPECT_EQ(num_overtaken, 3);
}

TEST(NewestWorkerTest, WithRoomEnoughAllAreDoneInOrder) {
  std::vector<int> done;
  std::promise<void> finished;
  NewestWorker<int> worker(
      1000, [] {},
      [&](int item) {
        done.push_back(item);
        if (item == 99) finished.set_value();
      });
  for (int item = 0; item < 100; ++item) EXPECT_EQ(worker.Give(item), 0);
  finished.get_future().wait();
  ASSERT_EQ(done.size(), 100u);
  for (int item = 0; item < 100; ++item) EXPECT_EQ(done[static_cast<std::size_t>(item)], item);
}

TEST(NewestWorkerTest, PreparesOnAPoke) {
  std::promise<void> prepared;
  NewestWorker<int> worker(
      1, [&] { prepared.set_value(); }, [](int) {});
  worker.Poke();
  prepared.get_future().wait();
}

TEST(NewestWorkerTest, PreparesBeforeAnItem) {
  std::vector<std::string> calls;
  std::promise<void> worked;
  NewestWorker<int> worker(
      1, [&] { calls.push_back("prepare"); },
      [&](int) {
        calls.push_back("work");
        worked.set_value();
      });
  worker.Give(1);
  worked.get_future().wait();
  EXPECT_EQ(calls, (std::vector<std::string>{"prepare", "work"}));
}

TEST(NewestWorkerTest, WhatWaitsAtTheEndIsLeftUndone) {
  std::promise<void> started, release;
  std::vector<int> done;
  std::thread releaser;
  {
    NewestWorker<int> worker(
        10, [] {},
        [&](int item) {
          started.set_value();
          release.get_future().wait();
          done.push_back(item);
        });
    worker.Give(0);
    started.get_future().wait();
    worker.Give(1);
    releaser = std::thread([&release] {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      release.set_value();
    });
  }
  releaser.join();
  EXPECT_EQ(done, std::vector<int>{0});
}

TEST(NewestWorkerTest, ItemsOfTheSecondRankWaitForAllOthersAndTheNewestWins) {
  std::promise<void> started, release, finished;
  std::vector<int> done;
  int num_overtaken = 0;
  {
    NewestWorker<int> worker(
        2, [] {},
        [&](int item) {
          if (item == 0) {
            started.set_value();
            release.get_future().wait();
          }
          done.push_back(item);
          if (item == 12) finished.set_value();
        });
    worker.Give(0);
    started.get_future().wait();
    for (const int item : {10, 11, 12}) num_overtaken += worker.GiveWhenIdle(item);
    for (const int item : {1, 2}) EXPECT_EQ(worker.Give(item), 0);
    release.set_value();
    finished.get_future().wait();
  }
  EXPECT_EQ(done, (std::vector<int>{0, 1, 2, 12}));
  EXPECT_EQ(num_overtaken, 2);
}

TEST(NewestWorkerTest, WorkOfTheSecondRankHearsThatItIsInTheWay) {
  std::promise<void> started, finished;
  std::vector<int> done;
  NewestWorker<int>* running = nullptr;
  NewestWorker<int> worker(
      1, [] {},
      [&](int item) {
        if (item == 10) {
          EXPECT_FALSE(running->wanted());
          started.set_value();
          while (!running->wanted()) std::this_thread::yield();
        }
        done.push_back(item);
        if (item == 1) {
          EXPECT_FALSE(running->wanted());
          finished.set_value();
        }
      });
  running = &worker;
  worker.GiveWhenIdle(10);
  started.get_future().wait();
  worker.Give(1);
  finished.get_future().wait();
  EXPECT_EQ(done, (std::vector<int>{10, 1}));
}

TEST(StoppableExecutionTest, RunsAsBeforeWhileNotStopped) {
  ThreadPool pool(3);
  const std::atomic<bool> stop = false;
  std::vector<std::string> stages;
  Execution watched = pool.MakeExecution();
  watched.on_stage_begin = [&stages](const std::string& stage) { stages.push_back(stage); };
  const Execution execution = StoppableExecution(watched, &stop);
  std::vector<int> squares(100);
  {
    const StageScope stage(execution, "squares");
    execution.parallel_for(squares.size(),
                           [&squares](std::size_t i) { squares[i] = static_cast<int>(i * i); });
  }
  EXPECT_EQ(squares[99], 99 * 99);
  EXPECT_EQ(stages, std::vector<std::string>{"squares"});
}

TEST(StoppableExecutionTest, AStopEndsLoopsAndStages) {
  ThreadPool pool(3);
  std::atomic<bool> stop = false;
  std::atomic<int> num_bodies = 0;
  const Execution execution = StoppableExecution(pool.MakeExecution(), &stop);
  EXPECT_THROW(execution.parallel_for(100000,
                                      [&](std::size_t) {
                                        ++num_bodies;
                                        stop = true;
                                      }),
               Stopped);
  EXPECT_LE(num_bodies, 3);
  EXPECT_THROW(execution.parallel_for(1, [](std::size_t) {}), Stopped);
  EXPECT_THROW(StageScope(execution, "next"), Stopped);
}

}  // namespace
}  // namespace rimod
