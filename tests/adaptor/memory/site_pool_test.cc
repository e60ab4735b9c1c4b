// SPDX-License-Identifier: Apache-2.0
#include "adaptor/memory/site_pool.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace volcontact::adaptor::site_pool_test {
namespace {

constexpr SitePoolLayout kLayout{5, 3};

TEST(SitePool, FindsTheRowsOfAPair) {
  std::vector<double> numbers(static_cast<std::size_t>(kLayout.size()), 0.0);
  const SitePool<double> pool(numbers.data(), kLayout);
  for (const int pair : {2, 7, 7, 9}) {
    const std::array row{10.0 * pair, 1.0, 2.0};
    EXPECT_TRUE(pool.push(pair, row.data(), 3));
  }
  EXPECT_EQ(pool.count(), 4);
  const SiteMemory seven = pool.rows_of(7, 0.1);
  ASSERT_EQ(seven.count, 2);
  EXPECT_EQ(seven.elapsed, 0.1);
  EXPECT_EQ(seven.rows[0], 70.0);
  EXPECT_EQ(seven.rows[seven.stride + 2], 2.0);
  EXPECT_EQ(pool.rows_of(9, 0.1).count, 1);
  for (const int pair : {0, 3, 8, 12}) EXPECT_EQ(pool.rows_of(pair, 0.1).count, 0) << pair;
  pool.clear();
  EXPECT_EQ(pool.rows_of(7, 0.1).count, 0);
}

TEST(SitePool, TakesNoMoreThanItHasRoomFor) {
  std::vector<double> numbers(static_cast<std::size_t>(kLayout.size()) + 1, 0.0);
  numbers.back() = 4.0;
  const SitePool<double> pool(numbers.data(), kLayout);
  const std::array row{1.0, 2.0, 3.0};
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(pool.push(i, row.data(), 3));
  EXPECT_FALSE(pool.push(5, row.data(), 3));
  EXPECT_EQ(pool.count(), 5);
  EXPECT_EQ(numbers.back(), 4.0);
}

TEST(SitePool, ShorterRowsLeaveZerosBehind) {
  std::vector<double> numbers(static_cast<std::size_t>(kLayout.size()), 7.0);
  const SitePool<double> pool(numbers.data(), kLayout);
  pool.clear();
  const double row = 1.0;
  pool.push(0, &row, 1);
  const SiteMemory memory = pool.rows_of(0, 0.0);
  EXPECT_EQ(memory.rows[1], 0.0);
  EXPECT_EQ(memory.rows[2], 0.0);
}

TEST(SitePool, NeedsNoNumbersWhereNothingIsKept) {
  constexpr SitePoolLayout kNone{0, 0};
  EXPECT_EQ(kNone.size(), 0);
  const SitePool<double> pool(nullptr, kNone);
  pool.clear();
  EXPECT_EQ(pool.count(), 0);
}

}  // namespace
}  // namespace volcontact::adaptor::site_pool_test
