// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/quadrature/small_turn.h"

#include <gtest/gtest.h>

namespace volcontact::small_turn_test {
namespace {

TEST(SmallTurn, SeriesAreExactToRounding) {
  for (int i = -80; i <= 80; ++i) {
    const double x = kSmallTurn * i / 80.0;
    const SmallTurn turn(x);
    EXPECT_NEAR(turn.cos, std::cos(x), 3e-16);
    EXPECT_NEAR(turn.sin, std::sin(x), 3e-16);
  }
}

TEST(SmallTurn, AnyAngleIsTaken) {
  const SmallTurn turn = SmallTurn::any(2.5);
  EXPECT_EQ(turn.cos, std::cos(2.5));
  EXPECT_EQ(turn.sin, std::sin(2.5));
}

}  // namespace
}  // namespace volcontact::small_turn_test
