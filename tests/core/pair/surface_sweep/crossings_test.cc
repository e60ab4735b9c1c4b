// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/surface_sweep/crossings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/support/random.h"

namespace volcontact::crossings_test {
namespace {

// A product of sines of half the angles from given roots, with its slope.
struct Product {
  std::vector<double> roots;

  CurveValue operator()(double t) const {
    CurveValue f{1.0, 0.0};
    for (const double root : roots) {
      const double s = std::sin(0.5 * (t - root)), c = 0.5 * std::cos(0.5 * (t - root));
      f = {f.value * s, f.slope * s + f.value * c};
    }
    return f;
  }
};

TEST(Crossings, FindsTheRootsOfATrigonometricPolynomial) {
  test::Random random(3);
  int complete = 0;
  for (int k = 0; k < 400; ++k) {
    Product f;
    for (int i = 0; i < (k % 2 == 0 ? 2 : 4); ++i)
      f.roots.push_back(random.uniform(0.0, 2.0 * kPi));
    std::sort(f.roots.begin(), f.roots.end());
    CrossingList list;
    find_crossings(f, 0.0, 2.0 * kPi, 16, true, list);
    // Roots that are close may hide in one step.
    bool close = false;
    for (std::size_t i = 0; i < f.roots.size(); ++i) {
      const double next = i + 1 < f.roots.size() ? f.roots[i + 1] : f.roots[0] + 2.0 * kPi;
      close = close || next - f.roots[i] < 0.4;
    }
    if (close && list.count != static_cast<int>(f.roots.size())) continue;
    ASSERT_EQ(list.count, static_cast<int>(f.roots.size())) << k;
    ++complete;
    EXPECT_EQ(list.begins_inside, f(0.0).value < 0.0);
    for (int i = 0; i < list.count; ++i) EXPECT_NEAR(list.t[i], f.roots[i], 1e-7) << k;
  }
  EXPECT_GT(complete, 390);
}

TEST(Crossings, FindsADipBetweenTwoPlaces) {
  const auto dip = [](double t) -> CurveValue {
    return {(t - 0.41) * (t - 0.4100001), 2.0 * t - 0.8200001};
  };
  CrossingList list;
  find_crossings(dip, 0.0, 1.0, 2, false, list);
  ASSERT_EQ(list.count, 2);
  EXPECT_NEAR(list.t[0], 0.41, 1e-9);
  EXPECT_NEAR(list.t[1], 0.4100001, 1e-9);
  const auto none = [](double t) -> CurveValue { return {t * t - t + 0.26, 2.0 * t - 1.0}; };
  find_crossings(none, 0.0, 1.0, 4, false, list);
  EXPECT_EQ(list.count, 0);
  EXPECT_FALSE(list.begins_inside);
}

}  // namespace
}  // namespace volcontact::crossings_test
