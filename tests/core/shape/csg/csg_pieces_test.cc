// SPDX-License-Identifier: Apache-2.0
// Solids composed at random, on a coarse grid, so that faces are often flush and the apex of a cone
// lies in a face or in the middle of a body: read point by point, their pieces must be the solid.
#include "volcontact/shape/csg/csg_pieces.h"

#include <gtest/gtest.h>

#include "core/support/csg_solids.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"

namespace volcontact::csg_pieces_test {
namespace {

using namespace testing;  // the solids
using test::Random;

double on_grid(double low, double high, Random& random) {
  const double step = 0.1, x = random.uniform(low, high);
  return random.uniform() < 0.6 ? step * std::round(x / step) : x;
}

Csg random_member(Random& random) {
  const auto place = [&] { return on_grid(-0.3, 0.3, random); };
  const auto size = [&] { return on_grid(0.1, 0.3, random); };
  Pose X;
  X.translation.z() = place();
  if (random.uniform() < 0.5) {
    X.translation.x() = place();
    X.translation.y() = place();
  }
  const double turned = random.uniform();
  if (turned < 0.25) X.rotation = random.rotation();
  if (turned > 0.7) X.rotation = test::turn(Vec3::UnitX() + Vec3::UnitY(), kPi);
  const double p = size(), q = size(), s = size();
  switch (static_cast<int>(random.uniform(0.0, 6.0))) {
    case 0:
      return box(p, q, s, X);
    case 1:
      return tube(p, q, X);
    case 2:
      return cone(0.0, p, q, X);
    case 3:
      return cone(p, q, s, X);
    case 4:
      return ball(p, X);
    default:
      return capsule(0.5 * p, 0.5 * q, X);
  }
}

Csg random_solid(int depth, Random& random) {
  if (depth == 0 || random.uniform() < 0.2) return random_member(random);
  const Csg a = random_solid(depth - 1, random), b = random_solid(depth - 1, random);
  const double kind = random.uniform();
  return kind < 0.25 ? a + b : kind < 0.5 ? a & b : a - b;
}

// Points that are in other than one piece of the solid, or in a piece but not in the solid.
int wrong_points(const Csg& solid, const PieceList& list, int points, Random& random) {
  int wrong = 0;
  for (int k = 0; k < points; ++k) {
    const Vec3 p = random.in_box(0.6);
    const double distance = solid.signed_distance(p);
    if (std::abs(distance) < 1e-9) continue;
    int holding = 0;
    for (int i = 0; i < list.size(); ++i) {
      holding += std::all_of(list.begin(i), list.end(i),
                             [&p](const Quadric& face) { return face(p) <= 0.0; });
    }
    wrong += holding != (distance < 0.0);
  }
  return wrong;
}

TEST(CsgPieces, AreTheSolidWhateverItIsComposedOf) {
  const int kSolids = test::cases(1500, 100);
  int written = 0;
  for (int seed = 0; seed < kSolids; ++seed) {
    Random random(seed);
    const Csg solid = random_solid(1 + seed % 3, random);
    const PieceList list = csg_pieces(solid);
    if (list.size() == 0) continue;
    ++written;
    EXPECT_EQ(wrong_points(solid, list, 400, random), 0) << "seed " << seed;
  }
  EXPECT_GT(written, kSolids / 2);
}

// The middle of the block is at the apex, where the function of the cone has its least value but
// not all around the block.
TEST(CsgPieces, AnApexInTheMiddleOfABodyIsNoProof) {
  Random random(1);
  const Csg pointed = box(.3, .3, .2) - cone(0.0, .14, .1, at(0, 0, .1));
  EXPECT_EQ(wrong_points(pointed, csg_pieces(pointed), 20000, random), 0);
}

// Beyond its wide end, and behind its apex, a cone goes on.
TEST(CsgPieces, AConeEndsWhereItEnds) {
  Random random(2);
  for (const double tilt : {0.3, 0.7, 1.2}) {
    const Csg cut = cone(0.0, .16, .1, turned({1, .3, 0}, tilt, {0, 0, .28})) - tube(.1, .1);
    EXPECT_EQ(wrong_points(cut, csg_pieces(cut), 20000, random), 0) << tilt;
    const Csg corner =
        cone(.1, .3, .1, turned({1, .3, 0}, tilt, {.1, -.25, .2})) - box(.16, .19, .3);
    EXPECT_EQ(wrong_points(corner, csg_pieces(corner), 20000, random), 0) << tilt;
  }
}

}  // namespace
}  // namespace volcontact::csg_pieces_test
