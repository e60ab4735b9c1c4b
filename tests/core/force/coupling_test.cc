// SPDX-License-Identifier: Apache-2.0
#include "volcontact/force/coupling.h"

#include <gtest/gtest.h>

#include <cmath>

namespace volcontact::coupling_test {
namespace {

const Vec3 kNormal = Vec3(0.3, -0.4, std::sqrt(0.75));
const Mat3 kBasis = basis_with_z(kNormal);

// An elliptic patch under uniform pressure, or under the paraboloid of a cap.
Patch ellipse(double a, double b, bool paraboloid, double turn = 0.0) {
  const double share = paraboloid ? 1.0 / 6.0 : 0.25, volume = 3e-7;
  const Vec3 x = std::cos(turn) * kBasis.col(0) + std::sin(turn) * kBasis.col(1);
  const Vec3 y = kNormal.cross(x);
  return {.gyration_radius = std::sqrt(share * (a * a + b * b)),
          .volume = volume,
          .area = kPi * a * b,
          .second_moment = volume * share * (a * a * outer(x, x) + b * b * outer(y, y))};
}

// Exact friction of a uniform disc that slides with eps = v / (R w), in units of mu f and mu f R:
// complete elliptic integrals, design notes section 3.4, checked there against quadrature to 1e-8.
double disc_force(double e) {
  const double k = e < 1.0 ? e : 1.0 / e;
  const double K = std::comp_ellint_1(k), E = std::comp_ellint_2(k);
  const double c = 4.0 / (3.0 * kPi);
  return e < 1.0 ? c * ((e * e + 1.0) * E + (e * e - 1.0) * K) / e
                 : c * ((e * e + 1.0) * E - (e * e - 1.0) * K);
}
double disc_torque(double e) {
  const double k = e < 1.0 ? e : 1.0 / e;
  const double K = std::comp_ellint_1(k), E = std::comp_ellint_2(k);
  const double c = 4.0 / (9.0 * kPi);
  return e < 1.0 ? c * ((4.0 - 2.0 * e * e) * E + (e * e - 1.0) * K)
                 : c * e * ((4.0 - 2.0 * e * e) * E + (2.0 * e * e - 5.0 + 3.0 / (e * e)) * K);
}

TEST(IntegratedSlip, EqualsTheEllipticIntegralsOfAUniformDisc) {
  const double R = 0.05, spin = 7.0;
  const Patch patch = ellipse(R, R, false);
  for (const double e : {1e-3, 0.05, 0.2, 0.5, 0.653, 0.8, 0.9, 1.1, 1.3, 2.0, 5.0, 20.0}) {
    const GeneralizedSlip slip =
        integrated_slip(kBasis.col(0) * e * R * spin, spin, kNormal, patch);
    EXPECT_NEAR(-slip.force_direction.dot(kBasis.col(0)), disc_force(e), 1e-10) << e;
    EXPECT_NEAR(-slip.torque_arm / R, disc_torque(e), 1e-10) << e;
    EXPECT_NEAR(slip.force_direction.dot(kBasis.col(1)), 0.0, 1e-12) << e;
  }
  // Where the pole crosses the rim the rays are cut off less smoothly.
  for (const double e : {0.99, 0.999, 1.001, 1.01}) {
    const GeneralizedSlip slip =
        integrated_slip(kBasis.col(0) * e * R * spin, spin, kNormal, patch);
    EXPECT_NEAR(-slip.force_direction.dot(kBasis.col(0)), disc_force(e), 1e-5) << e;
    EXPECT_NEAR(-slip.torque_arm / R, disc_torque(e), 1e-5) << e;
  }
}

TEST(IntegratedSlip, PureSpinHasTheMeanRadius) {
  // 2/3 R under uniform pressure, 8/15 R under the paraboloid; r_g would be 6.1 and 8.3 % more.
  const double R = 0.05;
  for (const double spin : {-3.0, 1e-6, 40.0}) {
    const double sense = spin > 0.0 ? -1.0 : 1.0;
    EXPECT_NEAR(integrated_slip(Vec3::Zero(), spin, kNormal, ellipse(R, R, false)).torque_arm,
                sense * 2.0 / 3.0 * R, 1e-12);
    EXPECT_NEAR(integrated_slip(Vec3::Zero(), spin, kNormal, ellipse(R, R, true)).torque_arm,
                sense * 8.0 / 15.0 * R, 1e-12);
  }
}

TEST(IntegratedSlip, PureSlidingIsCoulomb) {
  const GeneralizedSlip slip =
      integrated_slip(0.2 * kBasis.col(1), 0.0, kNormal, ellipse(0.05, 0.02, true));
  EXPECT_NEAR((slip.force_direction + kBasis.col(1)).norm(), 0.0, 1e-14);
  EXPECT_EQ(slip.torque_arm, 0.0);
  EXPECT_DOUBLE_EQ(slip.speed, 0.2);
}

// Independent integral: midpoints over the ellipse.
TEST(IntegratedSlip, EqualsAPlainSumOverEllipses) {
  const int n = 600;
  for (const double b : {0.05, 0.025, 0.01}) {
    for (const bool paraboloid : {false, true}) {
      const double a = 0.05, turn = 0.7, spin = -2.0;
      const Patch patch = ellipse(a, b, paraboloid, turn);
      const Vec3 x_axis = std::cos(turn) * kBasis.col(0) + std::sin(turn) * kBasis.col(1);
      const Vec3 y_axis = kNormal.cross(x_axis);
      for (const double speed : {0.01, 0.06, 0.2}) {
        const double vx = 0.6 * speed, vy = 0.8 * speed;
        double fx = 0.0, fy = 0.0, torque = 0.0, sum = 0.0;
        for (int i = 0; i < n; ++i) {
          for (int j = 0; j < n; ++j) {
            const double s = (i + 0.5) / n, angle = 2.0 * kPi * (j + 0.5) / n;
            const double x = a * s * std::cos(angle), y = b * s * std::sin(angle);
            const double p = s * (paraboloid ? 1.0 - s * s : 1.0);
            const double ux = vx - spin * y, uy = vy + spin * x, u = std::hypot(ux, uy);
            fx -= p * ux / u;
            fy -= p * uy / u;
            torque -= p * (x * uy - y * ux) / u;
            sum += p;
          }
        }
        const GeneralizedSlip slip =
            integrated_slip(vx * x_axis + vy * y_axis, spin, kNormal, patch);
        EXPECT_NEAR(slip.force_direction.dot(x_axis), fx / sum, 1e-5);
        EXPECT_NEAR(slip.force_direction.dot(y_axis), fy / sum, 1e-5);
        EXPECT_NEAR(slip.torque_arm, torque / sum, 1e-5 * a);
      }
    }
  }
}

TEST(IntegratedSlip, ThinPatchIsALine) {
  // Pure spin of a line of half length a under uniform pressure along it: the ellipse of no width
  // has the pressure sqrt(1 - x^2 / a^2), whose mean distance is 4 a / (3 pi).
  const double a = 0.05;
  Patch patch = ellipse(a, 0.0, false);
  const double arm = -integrated_slip(Vec3::Zero(), 5.0, kNormal, patch).torque_arm;
  EXPECT_NEAR(arm, 4.0 * a / (3.0 * kPi), 2e-3 * a);
}

TEST(IntegratedSlip, DissipatesLessThanTheEllipsoid) {
  const Patch patch = ellipse(0.05, 0.03, true);
  for (const double speed : {0.0, 1e-3, 0.05, 0.2, 3.0}) {
    for (const double spin : {-30.0, -0.5, 0.02, 4.0}) {
      const Vec3 v = speed * kBasis.col(0);
      const GeneralizedSlip exact = integrated_slip(v, spin, kNormal, patch);
      const double power = -exact.force_direction.dot(v) - exact.torque_arm * spin;
      EXPECT_GT(power, 0.0);
      EXPECT_LE(power, exact.speed * (1.0 + 1e-9));  // mean <= root mean square
    }
  }
}

TEST(GeneralizedSlip, IsZeroAtRestForEveryCoupling) {
  for (const Coupling c : {Coupling::kEllipsoid, Coupling::kQuadrature, Coupling::kNone}) {
    const GeneralizedSlip slip =
        generalized_slip(c, Vec3::Zero(), 0.0, kNormal, ellipse(0.05, 0.05, true));
    EXPECT_EQ(slip.speed, 0.0);
    EXPECT_EQ(slip.force_direction.norm(), 0.0);
    EXPECT_EQ(slip.torque_arm, 0.0);
  }
}

}  // namespace
}  // namespace volcontact::coupling_test
