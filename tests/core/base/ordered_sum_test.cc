// SPDX-License-Identifier: Apache-2.0
#include "volcontact/base/ordered_sum.h"

#include <gtest/gtest.h>

#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>

namespace volcontact {
namespace {

// Terms of very different size and sign: any other order gives other bits.
double term(int i) { return std::sin(1.7 * i) * std::pow(10.0, i % 17 - 8); }

TEST(ForEachTask, CallsEveryTaskOnce) {
  for (int threads : {1, 2, 3, 4, 8}) {
    for (int grain : {1, 7, 1000}) {
      std::vector<std::atomic<int>> calls(1003);
      for_each_task(1003, threads, grain, [&](int i) { ++calls[i]; });
      for (const auto& count : calls) ASSERT_EQ(count.load(), 1);
    }
  }
}

TEST(ForEachTask, NothingToDoIsNothingDone) {
  int calls = 0;
  for_each_task(0, 4, 16, [&](int) { ++calls; });
  EXPECT_EQ(calls, 0);
}

TEST(OrderedSum, SameBitsForAnyNumberOfThreads) {
  std::vector<double> partial;
  for (int count : {1, 63, 64, 65, 5000}) {
    const double one = ordered_sum<double>(count, 1, 64, partial, term);
    for (int threads : {2, 3, 4, 8}) {
      const double many = ordered_sum<double>(count, threads, 64, partial, term);
      EXPECT_EQ(std::bit_cast<std::uint64_t>(one), std::bit_cast<std::uint64_t>(many));
    }
  }
}

// The test above means something only if order matters for these terms.
TEST(OrderedSum, TermsOfTheTestDependOnTheOrder) {
  std::vector<double> partial;
  const double forward = ordered_sum<double>(5000, 1, 64, partial, term);
  const double backward =
      ordered_sum<double>(5000, 1, 64, partial, [](int i) { return term(4999 - i); });
  EXPECT_NE(std::bit_cast<std::uint64_t>(forward), std::bit_cast<std::uint64_t>(backward));
}

TEST(OrderedSum, IsTheSumOfBlocksInIndexOrder) {
  std::vector<double> partial;
  double wanted = 0.0;
  for (int block = 0; block < 3; ++block) {
    double sum = 0.0;
    for (int i = 10 * block; i < std::min(25, 10 * block + 10); ++i) sum += term(i);
    wanted += sum;
  }
  EXPECT_EQ(ordered_sum<double>(25, 4, 10, partial, term), wanted);
}

TEST(OrderedSum, OfNothingIsZero) {
  std::vector<double> partial;
  EXPECT_EQ(ordered_sum<double>(0, 4, 64, partial, term), 0.0);
}

// A second use with fewer blocks must not add what the first one left.
TEST(OrderedSum, ScratchLeavesNoTrace) {
  std::vector<double> partial;
  ordered_sum<double>(5000, 2, 64, partial, term);
  std::vector<double> fresh;
  EXPECT_EQ(ordered_sum<double>(100, 2, 64, partial, term),
            ordered_sum<double>(100, 2, 64, fresh, term));
}

}  // namespace
}  // namespace volcontact
