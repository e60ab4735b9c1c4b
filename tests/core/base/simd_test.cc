// SPDX-License-Identifier: Apache-2.0
#include "volcontact/base/simd.h"

#include <gtest/gtest.h>

#include <cstring>

#define VOLCONTACT_SIMD_KERNEL "core/base/simd_test_kernel.inc"
#include "volcontact/base/simd_paths.inc"

namespace volcontact::simd_test {
namespace {

constexpr SimdPath kPaths[] = {SimdPath::kPortable, SimdPath::kAvx2, SimdPath::kAvx512};

// What one operation gives on one path: eight numbers.
struct Result {
  double lane[kLanes];
};
Result run(SimdPath path, int operation, const double* a, const double* b) {
  Result r;
  VOLCONTACT_SIMD_CALL(path, operate, operation, a, b, r.lane);
  return r;
}

TEST(Simd, OperationsAreThoseOfDoublesOnEveryPath) {
  const double nan = std::nan("");
  const double a[kLanes] = {1.0, -2.0, 3.5, 1e300, 0.1, -0.0, 7.0, nan};
  const double b[kLanes] = {3.0, 5.0, -3.5, 1e10, 0.3, 2.0, 7.0, 1.0};
  for (SimdPath path : kPaths) {
    if (!can_run(path)) continue;
    for (int i = 0; i < kLanes; ++i) {
      const double x = a[i], y = b[i];
      const auto is = [&](int operation, double expected) {
        const double value = run(path, operation, a, b).lane[i];
        EXPECT_EQ(std::memcmp(&value, &expected, sizeof(double)) == 0 ||
                      (std::isnan(value) && std::isnan(expected)),
                  true)
            << "operation " << operation << " on " << x << ", " << y << " gives " << value;
      };
      is(portable::kAdd, x + y);
      is(portable::kSubtract, x - y);
      is(portable::kMultiply, x * y);
      is(portable::kDivide, x / y);
      is(portable::kSquareRoot, std::sqrt(y));
      is(portable::kLarger, x > y ? x : y);
      is(portable::kSmaller, x < y ? x : y);
      is(portable::kSize, std::abs(x));
      is(portable::kPick, x < y ? x : 5.0);
    }
  }
}

TEST(Simd, FloatsAreThoseOfEveryPath) {
  const float a[kLanes] = {1.0f, -2.0f, 3.5f, 1e30f, 0.1f, -0.0f, 7.0f, std::nanf("")};
  const float b[kLanes] = {3.0f, 5.0f, -3.5f, 1e10f, 0.3f, 2.0f, 7.0f, 1.0f};
  const auto mask = [&](auto&& holds) {
    unsigned bits = 0;
    for (int i = 0; i < kLanes; ++i) bits |= (holds(a[i], b[i]) ? 1u : 0u) << i;
    return static_cast<float>(bits);
  };
  for (SimdPath path : kPaths) {
    if (!can_run(path)) continue;
    float r[kLanes];
    const auto run = [&](int operation) {
      return VOLCONTACT_SIMD_CALL(path, operate, operation, a, b, r);
    };
    const auto are = [&](int operation, auto&& expected) {
      run(operation);
      for (int i = 0; i + 1 < kLanes; ++i) EXPECT_EQ(r[i], expected(a[i], b[i])) << operation;
      EXPECT_TRUE(std::isnan(r[kLanes - 1]));
    };
    are(portable::kAdd, [](float x, float y) { return x + y; });
    are(portable::kSubtract, [](float x, float y) { return x - y; });
    are(portable::kMultiply, [](float x, float y) { return x * y; });
    are(portable::kSize, [](float x, float) { return std::abs(x); });
    EXPECT_EQ(run(portable::kSmaller), mask([](float x, float y) { return x < y; }));
    EXPECT_EQ(run(portable::kLarger), mask([](float x, float y) { return x > y; }));
    EXPECT_EQ(run(portable::kNotSmaller), mask([](float x, float y) { return x >= y; }));
    EXPECT_EQ(run(portable::kNotLarger), mask([](float x, float y) { return x <= y; }));
    EXPECT_EQ(run(portable::kEither), mask([](float x, float y) { return x < y || x > y; }));
    double wide[kLanes];
    VOLCONTACT_SIMD_CALL(path, widen, a, wide);
    for (int i = 0; i + 1 < kLanes; ++i) EXPECT_EQ(wide[i], static_cast<double>(a[i]));
  }
}

TEST(Simd, TheSumHasItsStatedOrderOnEveryPath) {
  // In another order other small terms are lost.
  const double a[kLanes] = {1e16, 1.0, -1e16, 3.0, 1.0, 1e-3, 1.0, 7.0};
  const double expected = ((a[0] + a[4]) + (a[2] + a[6])) + ((a[1] + a[5]) + (a[3] + a[7]));
  for (SimdPath path : kPaths) {
    if (!can_run(path)) continue;
    EXPECT_EQ(run(path, portable::kSum, a, a).lane[0], expected);
  }
}

TEST(Simd, AnyFindsOneLane) {
  const double zero[kLanes] = {};
  for (SimdPath path : kPaths) {
    if (!can_run(path)) continue;
    EXPECT_EQ(run(path, portable::kAny, zero, zero).lane[0], 0.0);
    for (int i = 0; i < kLanes; ++i) {
      double one[kLanes] = {};
      one[i] = 1.0;
      EXPECT_EQ(run(path, portable::kAny, one, zero).lane[0], 1.0);
    }
  }
}

TEST(Simd, EveryMachineRunsThePortablePath) {
  EXPECT_TRUE(can_run(SimdPath::kPortable));
  EXPECT_TRUE(can_run(best_simd_path()));
}

}  // namespace
}  // namespace volcontact::simd_test
