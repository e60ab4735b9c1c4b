// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/closed_form/circular_segment.h"

#include <gtest/gtest.h>

namespace volcontact::circular_segment_test {
namespace {

TEST(CircularSegment, EqualsItsColumns) {
  // int over the height t of 2 w(t), with t = height sin^2(x): a smooth integrand.
  for (double height : {1e-12, 1e-6, 0.01, 0.1199, 0.1201, 0.5, 1.0, 1.6, 1.99, 2.0}) {
    const CircularSegment s(height, std::sqrt(height * (2.0 - height)));
    long double area = 0, depth = 0, u = 0, uu = 0, vv = 0, uuu = 0, uvv = 0;
    constexpr int kPanels = 400;
    constexpr long double kNodes[] = {-0.774596669241483377035853079956L, 0.0L,
                                      0.774596669241483377035853079956L};
    const long double width = std::acos(0.0L) / kPanels;
    for (int i = 0; i < kPanels; ++i) {
      for (int n = 0; n < 3; ++n) {
        const long double x = width * (i + (1 + kNodes[n]) / 2), sn = std::sin(x);
        const long double t = height * sn * sn, up = 1 - t, w = std::sqrt(t * (2 - t));
        const long double slice =
            width / 2 * (n == 1 ? 8.0L : 5.0L) / 9 * height * std::sin(2 * x) * 2 * w;
        area += slice;
        depth += slice * (height - t);
        u += slice * up;
        uu += slice * up * up;
        vv += slice * w * w / 3;
        uuu += slice * up * up * up;
        uvv += slice * up * w * w / 3;
      }
    }
    const auto near = [](double value, long double expected, double allowed) {
      EXPECT_NEAR(value, static_cast<double>(expected), allowed);
    };
    near(s.area, area, 1e-11 * s.area);
    near(s.depth, depth, 1e-11 * s.depth);
    near(s.u, u, 1e-11 * s.area);
    near(s.uu, uu, 1e-11 * s.area);
    near(s.vv, vv, 1e-11 * s.area);
    near(s.uuu, uuu, 1e-11 * s.area);
    near(s.uvv, uvv, 1e-11 * s.area);
  }
}

TEST(CircularSegment, OfHeightTwoIsTheDisc) {
  const CircularSegment s(2.0, 0.0);
  const double pi = std::acos(-1.0);
  EXPECT_DOUBLE_EQ(s.area, pi);
  EXPECT_DOUBLE_EQ(s.depth, pi);
  EXPECT_DOUBLE_EQ(s.uu, pi / 4);
  EXPECT_DOUBLE_EQ(s.vv, pi / 4);
}

}  // namespace
}  // namespace volcontact::circular_segment_test
