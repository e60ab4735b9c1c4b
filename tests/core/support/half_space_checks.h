// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "core/support/gradient.h"
#include "core/support/matchers.h"
#include "volcontact/shape/half_space.h"

namespace volcontact::test {

/// A pose of a solid with this rotation and the given share of its height below the plane.
template <typename Solid>
Pose immersed_by(const Solid& solid, const Mat3& rotation, double share, Random& random) {
  const Vec3 up_B = rotation.row(2);
  const double low = solid.support_height(-up_B), height = low + solid.support_height(up_B);
  const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
  return {rotation, Vec3(x, y, low - share * height)};
}

/// A rotation that tilts the body's axis by `tilt` from the upward normal of the plane.
inline Mat3 tilted_by(double tilt, Random& random) {
  return turn(Vec3::UnitZ(), random.uniform(0, 6)) * turn(Vec3::UnitX(), tilt) *
         turn(Vec3::UnitZ(), random.uniform(0, 6));
}

/// S and T are the gradient of V; the buoyancy V at the centroid is that of the depth moment.
template <typename Solid>
void expect_gradients(const Solid& solid, const Pose& X, double step, double tolerance) {
  const VolumeMetrics m = closed_form(HalfSpace(), solid, X);
  const auto volume = [&](const Pose& pose) {
    return closed_form(HalfSpace(), solid, pose).volume;
  };
  const Gradient of_volume = gradient_of_A(volume, X, step);
  EXPECT_LT((m.area_vector - of_volume.shift).norm(), tolerance);
  EXPECT_LT((m.area_moment - of_volume.turn).norm(), tolerance);
  const auto potential = [&](const Pose& pose) {
    return closed_form(HalfSpace(), solid, pose).depth_moment;
  };
  const Gradient of_potential = gradient_of_A(potential, X, step);
  const Vec3 force_on_A = -m.volume * Vec3::UnitZ();
  EXPECT_LT((of_potential.shift + force_on_A).norm(), tolerance);
  EXPECT_LT((of_potential.turn + m.centroid.cross(force_on_A)).norm(), tolerance);
}

/// Wholly below the plane: the solid's own metrics, no direction, the potential of the buoyancy.
template <typename Solid>
void expect_contained(const Solid& solid, const Pose& X, double surface) {
  const VolumeMetrics m = closed_form(HalfSpace(), solid, X);
  VolumeMetrics expected = transformed(solid.own_metrics(), X);
  const Vec3 up_B = X.rotation.row(2);
  expected.depth = solid.support_height(up_B) + solid.support_height(-up_B);
  expected.depth_moment = -expected.centroid.z() * expected.volume;
  expected.counter_area = surface;
  expected.status = Status::kContained;
  EXPECT_TRUE(same(m, expected, {1e-13, 1.0}));
  EXPECT_EQ(m.area_vector, Vec3(Vec3::Zero()));
}

/// Metrics at a pose a hair inside the surface continue to those of the whole solid.
template <typename Solid>
void expect_continuous_into_containment(const Solid& solid, const Mat3& rotation, Random& random) {
  const Pose X = immersed_by(solid, rotation, 1.0 - 1e-9, random);
  const Pose deeper{X.rotation, X.translation - 1e-8 * Vec3::UnitZ()};
  const VolumeMetrics m = closed_form(HalfSpace(), solid, X);
  const VolumeMetrics whole = closed_form(HalfSpace(), solid, deeper);
  EXPECT_EQ(m.status, Status::kOk);
  EXPECT_EQ(whole.status, Status::kContained);
  EXPECT_NEAR(m.volume, whole.volume, 1e-7 * whole.volume);
  EXPECT_LT((m.inertia - whole.inertia).norm(), 1e-6 * whole.inertia.norm());
  EXPECT_NEAR(m.counter_area, whole.counter_area, 2e-4 * whole.counter_area);
  EXPECT_NEAR(m.depth_moment, whole.depth_moment, 1e-6 * whole.depth_moment);
}

}  // namespace volcontact::test
