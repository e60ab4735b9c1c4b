// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/surface_sweep/sweep_patch.h"

#include <gtest/gtest.h>

#include "core/support/random.h"

namespace volcontact::sweep_patch_test {
namespace {

const Shape kAll = Box({.half_sizes = {9.0, 9.0, 9.0}});

SweepFlux surface_of(const Shape& shape, const Pose& X, std::size_t faces) {
  SweepSolids solids;
  EXPECT_TRUE(solids.read(shape, X, kAll, {}, Vec3::Constant(1.0)));
  EXPECT_EQ(solids.faces.size(), faces);
  SweepPatchScratch scratch;
  SweepFlux sum;
  for (std::size_t f = 0; f < solids.faces.size(); ++f) {
    const CurveFamily family(solids.faces[f], solids.half);
    SweepPatch patch;
    EXPECT_TRUE(sweep_face(solids, static_cast<int>(f), family, 1e-8, scratch, patch));
    for (const SweepStrip& strip : patch.surface.strips) {
      EXPECT_EQ(strip.owner, Owner::kA);
      sum += strip.flux;
    }
  }
  return sum;
}

// The fluxes through the whole surface of a solid are its own metrics.
TEST(SweepPatch, FluxesAreTheMomentsOfTheSolid) {
  const std::pair<Shape, std::size_t> solids[] = {
      {Sphere({.radius = 0.3}), 1},
      {Ellipsoid({.semi_axes = {0.4, 0.3, 0.2}}), 1},
      {Box({.half_sizes = {0.2, 0.3, 0.1}}), 6},
      {Cylinder({.radius = 0.2, .half_length = 0.3}), 3},
      {Frustum({.bottom_radius = 0.3, .top_radius = 0.1, .half_length = 0.2}), 3},
      {Torus({.major_radius = 0.3, .minor_radius = 0.1}), 1}};
  test::Random random(5);
  for (const auto& [shape, faces] : solids) {
    const Pose X{random.rotation(), random.in_box(0.2)};
    const SweepFlux sum = surface_of(shape, X, faces);
    const VolumeMetrics own = transformed(own_metrics_of(shape), X);
    const double V = own.volume;
    EXPECT_LE((sum.moment - V * Mat3::Identity()).norm(), 1e-7 * V) << name_of(shape);
    EXPECT_LE(sum.normal.norm(), 1e-7 * sum.area) << name_of(shape);
    EXPECT_LE((sum.first - V * own.centroid).norm(), 1e-7 * V) << name_of(shape);
    const Mat3 second = own.second_moment() + V * outer(own.centroid, own.centroid);
    EXPECT_LE((sum.second - second).norm(), 1e-6 * second.norm()) << name_of(shape);
  }
}

}  // namespace
}  // namespace volcontact::sweep_patch_test
