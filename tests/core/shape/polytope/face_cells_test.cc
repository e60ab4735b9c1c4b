// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/polytope/face_cells.h"

#include <gtest/gtest.h>

#include "core/support/random_shapes.h"

namespace volcontact::face_cells_test {
namespace {

using test::Random;

TEST(FaceCells, FillThePolytope) {
  Random random(1);
  for (int points : {4, 8, 30}) {
    const ConvexPolytope solid = test::random_polytope(points, random);
    double volume = 0.0;
    for (const FaceCell& cell : make_face_cells(solid)) volume += cell.solid.own_metrics().volume;
    EXPECT_NEAR(volume, solid.own_metrics().volume, 1e-12 * volume);
  }
}

TEST(FaceCells, HoldWhatIsNearestToTheirFace) {
  Random random(2);
  const ConvexPolytope solid = test::random_polytope(12, random);
  for (const FaceCell& cell : make_face_cells(solid)) {
    const ConvexPolytope::Face& own = solid.faces()[static_cast<std::size_t>(cell.face)];
    for (const Vec3& x : cell.solid.vertices()) {
      EXPECT_NEAR(own.normal.dot(x) - own.offset, solid.signed_distance(x), 1e-12);
    }
  }
}

TEST(FaceCells, OfABoxArePyramidsAndRoofs) {
  // The two faces of the long axis: pyramids of a third of the smallest half size each.
  const Vec3 half(0.5, 0.3, 0.2);
  const ConvexPolytope box = test::polytope_of(Box({.half_sizes = half}));
  const std::vector<FaceCell> cells = make_face_cells(box);
  ASSERT_EQ(cells.size(), 6u);
  for (const FaceCell& cell : cells) {
    const Vec3& n = box.faces()[static_cast<std::size_t>(cell.face)].normal;
    if (std::abs(n.x()) < 0.5) continue;
    // int_0^h 4 (y - d) (z - d) dd, h = z
    const double y = half.y(), z = half.z();
    EXPECT_NEAR(cell.solid.own_metrics().volume,
                4.0 * (y * z * z - (y + z) * z * z / 2.0 + z * z * z / 3.0), 1e-14);
  }
}

}  // namespace
}  // namespace volcontact::face_cells_test
