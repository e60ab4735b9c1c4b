// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/torus_pair/torus_flux.h"

#include <gtest/gtest.h>

#include "core/support/random.h"

namespace volcontact::torus_flux_test {
namespace {

constexpr TorusSize kRing{0.3, 0.1};
constexpr double kVolume = 2.0 * kPi * 0.3 * kPi * 0.1 * 0.1;  // Pappus

// By the divergence theorem, about any origin.
TEST(TorusFlux, AWholeSurfaceGivesTheVolume) {
  test::Random random(1);
  const Pose X{random.rotation(), random.in_box(1.0)};
  const Vec3 origin = X * random.in_box(0.3);
  double sum = 0.0;
  constexpr int kSteps = 16;
  for (int i = 0; i < kSteps; ++i) {
    const Circle circle = section_circle(kRing, X, 2.0 * kPi * i / kSteps);
    sum += 2.0 * kPi / kSteps *
           (arc_flux(kRing, circle, origin, 0.0, 2.0) +
            arc_flux(kRing, circle, origin, 2.0, 2.0 * kPi));
  }
  EXPECT_NEAR(sum, kVolume, 1e-13);
}

// The surface of a cube of half length 1 about its center, by midpoints of a fine grid.
TEST(TorusFlux, SumsOfACube) {
  TorusFlux flux;
  constexpr int kSteps = 100;
  constexpr double kStep = 2.0 / kSteps;
  for (int axis = 0; axis < 3; ++axis) {
    for (double side : {-1.0, 1.0}) {
      for (int i = 0; i < kSteps; ++i) {
        for (int k = 0; k < kSteps; ++k) {
          Vec3 x;
          x[axis] = side;
          x[(axis + 1) % 3] = -1.0 + (i + 0.5) * kStep;
          x[(axis + 2) % 3] = -1.0 + (k + 0.5) * kStep;
          // The depth 1 everywhere: its moment is the volume.
          flux.add(x, kStep * kStep * side * Vec3::Unit(axis),
                   integral_from_origin([](double) { return 1.0; }));
        }
      }
    }
  }
  EXPECT_NEAR(flux.area, 24.0, 1e-10);
  EXPECT_LE((flux.volume - Vec3::Constant(8.0)).norm(), 1e-10);
  EXPECT_LE(flux.first.norm(), 1e-10);
  EXPECT_LE((flux.second / 5.0 - Mat3(Vec3::Constant(8.0 / 3.0).asDiagonal())).norm(), 2e-3);
  EXPECT_LE(flux.vector.norm() + flux.moment.norm(), 1e-10);
  EXPECT_NEAR(flux.depth_moment, 8.0, 1e-10);
}

TEST(TorusFlux, IntegralFromTheOriginIsExactForTheFifthDegree) {
  for (int power = 0; power <= 5; ++power) {
    EXPECT_NEAR(integral_from_origin([&](double s) { return std::pow(s, power); }),
                1.0 / (power + 3.0), 1e-15);
  }
}

}  // namespace
}  // namespace volcontact::torus_flux_test
