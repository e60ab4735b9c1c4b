// SPDX-License-Identifier: Apache-2.0
#include "adaptor/evaluation/thread_choice.h"

#include <gtest/gtest.h>

namespace volcontact::adaptor::thread_choice_test {
namespace {

constexpr std::size_t kPairs = 100;

// Evaluations that take these times alone and shared; what they took in sum, how many shared, and
// how often the clock was read.
struct Took {
  double seconds = 0.0;
  int shared = 0, timed = 0;
};
Took run(ThreadChoice& choice, int evaluations, double alone, double shared) {
  Took sum;
  for (int i = 0; i < evaluations; ++i) {
    const bool shares = choice.shares(2, kPairs);
    // Every hundredth one is interrupted.
    const double time = (shares ? shared : alone) + (i % 100 == 99 ? 4e-3 : 0.0);
    if (choice.wants_time()) {
      choice.took(time);
      ++sum.timed;
    }
    sum.seconds += time;
    sum.shared += shares ? 1 : 0;
  }
  return sum;
}

TEST(ThreadChoice, SharesWhatGains) {
  ThreadChoice choice;
  const Took free = run(choice, 100000, 1e-3, 0.55e-3);
  EXPECT_GT(free.shared, 99000);
}

TEST(ThreadChoice, OnABusyMachineItCostsLittleMoreThanOneThread) {
  ThreadChoice choice;
  const Took busy = run(choice, 100000, 288e-6, 1990e-6);
  const double one = 100000 * 288e-6 + 1000 * 4e-3;
  EXPECT_LT(busy.seconds, 1.03 * one);
  EXPECT_GT(busy.shared, 0);  // it goes on to look
}

TEST(ThreadChoice, FollowsAMachineThatBecomesBusyAndFreeAgain) {
  ThreadChoice choice;
  run(choice, 5000, 1e-3, 0.55e-3);
  EXPECT_LT(run(choice, 5000, 1e-3, 4e-3).shared, 100);
  run(choice, 2000, 1e-3, 0.55e-3);
  EXPECT_GT(run(choice, 5000, 1e-3, 0.55e-3).shared, 4900);
}

TEST(ThreadChoice, ShortEvaluationsAndSingleThreadsAreNeverShared) {
  ThreadChoice choice;
  EXPECT_EQ(run(choice, 10000, 50e-6, 1e-6).shared, 0);
  EXPECT_FALSE(ThreadChoice().shares(1, kPairs));
  EXPECT_FALSE(ThreadChoice().shares(2, 0));
}

TEST(ThreadChoice, TheClockIsReadNowAndThenWhereOneThreadWillDoByFar) {
  ThreadChoice choice;
  EXPECT_LT(run(choice, 16000, 50e-6, 1e-6).timed, 1010);
  // What takes longer from now on is noticed, and from then on all is timed.
  run(choice, 1000, 1e-3, 0.55e-3);
  EXPECT_EQ(run(choice, 1000, 1e-3, 0.55e-3).timed, 1000);
  EXPECT_GT(run(choice, 1000, 1e-3, 0.55e-3).shared, 900);
}

TEST(ThreadChoice, IsOfItsScene) {
  ThreadChoices choices;
  int scenes[9];
  ThreadChoice& first = choices.of(&scenes[0]);
  run(first, 10, 1e-3, 0.5e-3);
  EXPECT_EQ(&choices.of(&scenes[0]), &first);
  for (const int& scene : scenes) choices.of(&scene);
  EXPECT_EQ(run(choices.of(&scenes[8]), 3, 1e-3, 1e-3).shared, 0);  // begins anew
}

}  // namespace
}  // namespace volcontact::adaptor::thread_choice_test
