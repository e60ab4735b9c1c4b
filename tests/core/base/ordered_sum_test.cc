// SPDX-License-Identifier: Apache-2.0
#include "volcontact/base/ordered_sum.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>

namespace volcontact::ordered_sum_test {
namespace {

// Terms of very different size and sign: any other order gives other bits.
double term(int i) { return std::sin(1.7 * i) * std::pow(10.0, i % 17 - 8); }

// The sum of `count` terms on a team of so many threads.
double sum_on(int threads, int count, int grain, std::vector<double>& partial) {
  ThreadTeam team;
  double sum = 0.0;
  team.run(threads, [&] { sum = ordered_sum<double>(team, count, grain, partial, term); });
  return sum;
}

TEST(OrderedSum, SameBitsForAnyNumberOfThreads) {
  std::vector<double> partial;
  for (int count : {1, 63, 64, 65, 5000}) {
    const double one = sum_on(1, count, 64, partial);
    for (int threads : {2, 3, 4, 8}) {
      const double many = sum_on(threads, count, 64, partial);
      EXPECT_EQ(std::bit_cast<std::uint64_t>(one), std::bit_cast<std::uint64_t>(many));
    }
  }
}

// The test above means something only if order matters for these terms.
TEST(OrderedSum, TermsOfTheTestDependOnTheOrder) {
  std::vector<double> partial;
  ThreadTeam alone;
  const double forward = sum_on(1, 5000, 64, partial);
  const double backward =
      ordered_sum<double>(alone, 5000, 64, partial, [](int i) { return term(4999 - i); });
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
  EXPECT_EQ(sum_on(4, 25, 10, partial), wanted);
}

TEST(OrderedSum, OfNothingIsZero) {
  std::vector<double> partial;
  EXPECT_EQ(sum_on(4, 0, 64, partial), 0.0);
}

// A second use with fewer blocks must not add what the first one left.
TEST(OrderedSum, ScratchLeavesNoTrace) {
  std::vector<double> partial;
  sum_on(2, 5000, 64, partial);
  std::vector<double> fresh;
  EXPECT_EQ(sum_on(2, 100, 64, partial), sum_on(2, 100, 64, fresh));
}

}  // namespace
}  // namespace volcontact::ordered_sum_test
