// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/surface_sweep/sweep_solid.h"

#include <gtest/gtest.h>

#include "core/support/csg_solids.h"
#include "core/support/meshes.h"
#include "core/support/random.h"

namespace volcontact::sweep_solid_test {
namespace {

using namespace testing;

// Membership by the faces, whatever was pruned, is that of the signed distance.
TEST(SweepSolids, HoldsWhatTheSignedDistanceHolds) {
  const Shape ring = Torus({.major_radius = 0.15, .minor_radius = 0.05});
  test::Random random(1);
  for (const NamedSolid& kind : kinds_of_solids()) {
    const Pose X_WA{random.rotation(), random.in_box(0.1)}, X_WB{random.rotation(), Vec3::Zero()};
    const Vec3 half(0.2, 0.1, 0.05);
    SweepSolids solids;
    ASSERT_TRUE(solids.read(kind.solid, X_WA, ring, X_WB, half)) << kind.name;
    for (int i = 0; i < 200; ++i) {
      const Vec3 x = half.cwiseProduct(random.in_box(1.0));
      std::uint64_t in = 0;
      for (std::size_t p = 0; p < solids.parts.size(); ++p) {
        bool inside = true;
        for (int f = solids.parts[p].first; f < solids.parts[p].last; ++f) {
          inside = inside && solids.faces[f].value(x) < 0.0;
        }
        if (inside) in |= std::uint64_t{1} << p;
      }
      const double a = kind.solid.signed_distance(X_WA.inverse() * x);
      const double b = std::get<Torus>(ring).signed_distance(X_WB.inverse() * x);
      if (std::abs(a) > 1e-9) {
        EXPECT_EQ(solids.holds(Owner::kA, in), a < 0.0) << kind.name;
      }
      if (std::abs(b) > 1e-9) {
        EXPECT_EQ(solids.holds(Owner::kB, in), b < 0.0) << kind.name;
      }
    }
  }
}

TEST(SweepSolids, FindsFacesInOneSurface) {
  const Csg block = box(.3, .2, .1) - tube(.05, .05, at(0, 0, .05));
  SweepSolids solids;
  ASSERT_TRUE(
      solids.read(block, {}, Box({.half_sizes = {.1, .1, .1}}), at(0, 0, .2), Vec3(.2, .2, .3)));
  // On z = 0.1: the block's top and the tube's look up, the box's bottom looks down.
  int up = 0, down = 0;
  for (const SweepFace& face : solids.faces) {
    if (face.kind != SweepFace::Kind::kPlane || std::abs(std::abs(face.offset) - .1) > 1e-12 ||
        std::abs(face.normal.z()) < 0.5) {
      continue;
    }
    if (face.offset * face.normal.z() < 0.0) continue;  // on z = -0.1
    EXPECT_NEAR(solids.faces[face.twin].offset * solids.faces[face.twin].normal.z(), .1, 1e-12);
    ++(solids.faces[face.twin].normal.z() * face.side > 0.0 ? up : down);
  }
  EXPECT_EQ(up, 2);
  EXPECT_EQ(down, 1);
}

TEST(SweepSolids, RefusesWhatHasNoFaces) {
  SweepSolids solids;
  EXPECT_FALSE(
      solids.read(test::mesh_of(test::box_soup(Vec3::Ones())), {}, HalfSpace(), {}, Vec3::Ones()));
}

}  // namespace
}  // namespace volcontact::sweep_solid_test
