// SPDX-License-Identifier: Apache-2.0
#include "volcontact/base/simd.h"

#include <gtest/gtest.h>

#include <limits>

namespace volcontact {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(Simd, LanesAreLoadedAndStoredInOrder) {
  const double x[kLanes] = {1, 2, 3, 4, 5, 6, 7, 8};
  double y[kLanes];
  store(load(x) * splat(2.0), y);
  for (int i = 0; i < kLanes; ++i) EXPECT_EQ(y[i], 2.0 * x[i]);
}

TEST(Simd, ABoundDropsANaN) {
  const Vec8 a = splat(kNaN), b = splat(1.0);
  EXPECT_EQ(max(a, b)[3], 1.0);
  EXPECT_EQ(min(a, b)[3], 1.0);
}

TEST(Simd, TheSumHasItsStatedOrder) {
  // In another order the small terms are lost at other places.
  const Vec8 a{1e16, 1.0, -1e16, 3.0, 1.0, 1e-3, 1.0, 7.0};
  const double expected = ((a[0] + a[4]) + (a[2] + a[6])) + ((a[1] + a[5]) + (a[3] + a[7]));
  EXPECT_EQ(sum(a), expected);
}

TEST(Simd, SelectPicksLaneByLane) {
  const Vec8 a{1, -1, 1, -1, 1, -1, 1, -1};
  const Vec8 picked = select(a > 0.0, a, 5.0);
  for (int i = 0; i < kLanes; ++i) EXPECT_EQ(picked[i], i % 2 == 0 ? 1.0 : 5.0);
  EXPECT_TRUE(any(a > 0.0));
  EXPECT_FALSE(any(a > 1.0));
  EXPECT_EQ(abs(a)[1], 1.0);
}

TEST(Simd, EveryMachineRunsThePortablePath) {
  EXPECT_TRUE(can_run(SimdPath::kPortable));
  EXPECT_TRUE(can_run(best_simd_path()));
}

}  // namespace
}  // namespace volcontact
