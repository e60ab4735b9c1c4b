// SPDX-License-Identifier: Apache-2.0
#include "volcontact/force/restitution.h"

#include <gtest/gtest.h>

#include <cmath>

namespace volcontact::restitution_test {
namespace {

// Nine values of A = a v_i with their e: docs/theory.md, "Restitution"; six digits.
constexpr double kTable[][2] = {{0.01, 0.993377}, {0.05, 0.967739}, {0.1, 0.937476},
                                {0.2, 0.882190},  {0.5, 0.748435},  {1.0, 0.593624},
                                {2.0, 0.410720},  {5.0, 0.196980},  {10.0, 0.099982}};

TEST(Restitution, HasTheTableOfTheTheory) {
  for (const auto& [A, e] : kTable) EXPECT_NEAR(restitution_of(A), e, 6e-7) << A;
}

TEST(Restitution, SolvesItsEquation) {
  for (double A = 1e-4; A < 15.0; A *= 1.7) {
    const double e = restitution_of(A);
    EXPECT_NEAR(std::log1p(A) - std::log1p(-e * A), A * (1.0 + e), 1e-9 * A) << A;
  }
}

TEST(Restitution, SlowImpactsLoseTwoThirds) {
  for (const double A : {1e-3, 1e-5, 1e-7, 0.0}) {
    EXPECT_NEAR(restitution_of(A), 1.0 - 2.0 / 3.0 * A, 0.5 * A * A + 1e-15);
  }
}

TEST(Restitution, DampingNumberIsTheInverse) {
  for (const double e : {1e-3, 0.1, 0.3, 0.5, 0.8, 0.9, 0.99, 0.9999}) {
    EXPECT_NEAR(restitution_of(damping_number_of(e)), e, 1e-12);
  }
  EXPECT_EQ(damping_number_of(1.0), 0.0);
}

}  // namespace
}  // namespace volcontact::restitution_test
