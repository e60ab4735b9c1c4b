// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/quadrature/even_steps.h"

#include <gtest/gtest.h>

namespace volcontact::even_steps_test {
namespace {

// The area of a half disc, whose height is a root at both ends: exact, as sin^2 is a wave of
// number 2.
TEST(EvenSteps, HalfADisc) {
  const EvenSteps& steps = even_steps();
  double terms[kLanes], total;
  for (int i = 0; i < kLanes; ++i) {
    const double x = steps.cos[1][i];
    terms[i] = std::sqrt(1.0 - x * x) * steps.sin[i] * kPi / kLanes;
  }
  const double error = steps.error(terms, total);
  EXPECT_NEAR(total, 0.5 * kPi, 1e-14);
  EXPECT_LE(error, 1e-14);
}

// A narrow peak between the steps is seen in the waves.
TEST(EvenSteps, ErrorIsFeltWhereStepsAreTooFew) {
  const EvenSteps& steps = even_steps();
  double terms[kLanes], total;
  for (int i = 0; i < kLanes; ++i) terms[i] = i == 3 ? 1.0 : 0.0;
  EXPECT_GT(steps.error(terms, total), 0.5);
}

// What is symmetric has every second wave. The last falls less than those before: the waves go on
// as they are, here those of a cone that leaves a ring near both ends of its range.
TEST(EvenSteps, ASmallLastWaveForetellsNothingWhereFewFall) {
  const EvenSteps& steps = even_steps();
  const auto error = [&](double second, double fourth, double sixth) {
    double terms[kLanes], total;
    for (int i = 0; i < kLanes; ++i) {
      terms[i] =
          (1.0 + second * steps.cos[2][i] + fourth * steps.cos[4][i] + sixth * steps.cos[6][i]) /
          kLanes;
    }
    return steps.error(terms, total);
  };
  EXPECT_NEAR(error(-1.06, -0.014, -0.0035), 0.0035, 1e-9);
  EXPECT_LT(error(-1.0, 0.06, -0.0036), 0.0002);
}

}  // namespace
}  // namespace volcontact::even_steps_test
