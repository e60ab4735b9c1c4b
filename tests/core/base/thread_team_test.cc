// SPDX-License-Identifier: Apache-2.0
#include "volcontact/base/thread_team.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace volcontact::thread_team_test {
namespace {

TEST(ThreadTeam, CallsEveryTaskOnce) {
  for (int threads : {1, 2, 3, 4, 8, 16, 70}) {  // of 70 some have no share of their own
    for (int grain : {1, 7, 1000}) {
      ThreadTeam team;
      std::vector<std::atomic<int>> calls(1003);
      team.run(threads, [&] { team.for_each(1003, grain, [&](int i) { ++calls[i]; }); });
      for (const auto& count : calls) ASSERT_EQ(count.load(), 1);
    }
  }
}

// A thread that comes late to a loop must not take it for the next one.
TEST(ThreadTeam, ManyShortLoopsFollowEachOther) {
  ThreadTeam team;
  std::vector<int> number(64, 0);
  team.run(4, [&] {
    for (int round = 0; round < 5000; ++round) {
      team.for_each(1 + round % 64, 1, [&](int i) { number[i] += round; });
    }
  });
  for (int i = 0; i < 64; ++i) {
    int sum = 0;
    for (int round = 0; round < 5000; ++round) sum += i <= round % 64 ? round : 0;
    ASSERT_EQ(number[i], sum);
  }
}

// What a loop writes, the program and the next loop see.
TEST(ThreadTeam, ALoopEndsWithTheLastOfItsTasks) {
  ThreadTeam team;
  std::vector<double> one(500, 0.0), two(500, 0.0);
  team.run(3, [&] {
    for (int round = 1; round <= 200; ++round) {
      team.for_each(500, 16, [&](int i) { one[i] = round + i; });
      team.for_each(500, 16, [&](int i) { two[i] = one[499 - i]; });
      for (int i = 0; i < 500; ++i) ASSERT_EQ(two[i], round + 499 - i);
    }
  });
}

// Whoever has much to do is helped.
TEST(ThreadTeam, NobodyWaitsWhileOthersHaveTasksLeft) {
  ThreadTeam team;
  std::vector<std::atomic<int>> calls(200);
  team.run(4, [&] {
    team.for_each(200, 1, [&](int i) {
      if (i == 0) {  // all others are done by those who do not hang on this one
        while (std::count(calls.begin() + 1, calls.end(), 1) < 199) std::this_thread::yield();
      }
      ++calls[i];
    });
  });
  EXPECT_EQ(calls[0].load(), 1);
}

TEST(ThreadTeam, RunsAgain) {
  ThreadTeam team;
  std::vector<int> calls(100, 0);
  for (int run = 0; run < 50; ++run) {
    team.run(1 + run % 5, [&] { team.for_each(100, 3, [&](int i) { ++calls[i]; }); });
  }
  for (const int count : calls) EXPECT_EQ(count, 50);
}

TEST(ThreadTeam, IsOpenDuringItsProgramOnly) {
  ThreadTeam team;
  EXPECT_FALSE(team.open());
  team.run(2, [&] { EXPECT_TRUE(team.open()); });
  EXPECT_FALSE(team.open());
  team.run(1, [&] { EXPECT_FALSE(team.open()); });
}

TEST(ThreadTeam, NothingToDoIsNothingDone) {
  ThreadTeam team;
  int calls = 0;
  team.run(4, [&] { team.for_each(0, 16, [&](int) { ++calls; }); });
  EXPECT_EQ(calls, 0);
}

}  // namespace
}  // namespace volcontact::thread_team_test
