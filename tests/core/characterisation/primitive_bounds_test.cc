// SPDX-License-Identifier: Apache-2.0

// The error that is claimed holds the true one, in both orders of a pair: simple solids in classes
// of sizes and poses whose faces change where it is hard to see. The judge is the reference
// integral, which has its own bound.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "core/reference/reference_integral.h"
#include "core/search/fuzz.h"
#include "core/support/evaluated.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"
#include "volcontact/pair/interference.h"

namespace volcontact::test::primitive_bounds_test {
namespace {

constexpr double kLeast = 1e-9;      // of V: where bounds are below rounding and the reference
constexpr double kKnown = 1e-5;      // of V: a reference that knows less is no judge
constexpr double kWorst = 1e-3;      // of V: the default tolerance
constexpr double kWorstArea = 2e-2;  // of the area, in the area vector

struct Case {
  Shape a, b;
  Pose X_AB;
};
using Maker = std::function<Case(Random&)>;

double size_of(const Shape& shape) {
  return std::visit(
      [](const auto& solid) {
        const Aabb box = solid.bounds();
        return box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).norm();
      },
      shape);
}

Reference reference(const Case& c, const VolumeMetrics& seen) {
  const Vec3 n = seen.normal().isZero() ? Vec3(0.3, 0.2, 0.9).normalized() : seen.normal();
  const double range = 2.2 * std::min(size_of(c.a), size_of(c.b));
  return reference_integral(reference_solid(c.a), reference_solid(c.b), c.X_AB,
                            {.X_AF = {basis_with_z(n), seen.centroid}, .half_range = range});
}

// How many poses had a judge.
int check(const Maker& maker, int count, std::uint64_t seed) {
  Random random(seed);
  int judged = 0;
  for (int i = 0; i < count; ++i) {
    const Case c = maker(random);
    const VolumeMetrics m = evaluated(c.a, c.b, c.X_AB).total;
    const VolumeMetrics mirrored = evaluated(c.b, c.a, c.X_AB.inverse()).total;
    if (!m.touching() && !mirrored.touching()) continue;
    const Reference expected =
        reference(c, m.touching() ? m : reversed(transformed(mirrored, c.X_AB)));
    const double volume = expected.metrics.volume;
    if (!(volume > 1e-7) || !(expected.worst_error < kKnown * volume)) continue;
    ++judged;
    for (const VolumeMetrics* answer : {&m, &mirrored}) {
      const double error = std::abs(answer->volume - volume);
      EXPECT_LE(error, answer->volume_error + expected.worst_error + kLeast * volume)
          << i << ": " << literal(c.X_AB);
      EXPECT_LE(error, kWorst * volume) << i << ": " << literal(c.X_AB);
    }
    if (expected.shared_area > 0.0) continue;
    EXPECT_LE((m.area_vector - expected.metrics.area_vector).norm(), kWorstArea * m.area)
        << i << ": " << literal(c.X_AB);
  }
  return judged;
}

double some(Random& random) { return random.uniform(0.1, 0.4); }
Shape round_one(int kind, Random& random) {
  const double r = some(random), h = some(random), s = some(random);
  switch (kind) {
    case 0:
      return Sphere({.radius = r});
    case 1:
      return Ellipsoid({.semi_axes = {r, h, s}});
    case 2:
      return Capsule({.radius = 0.7 * r, .half_length = h});
    case 3:
      return Cylinder({.radius = r, .half_length = h});
    case 4:
      return Frustum({.bottom_radius = r, .top_radius = s, .half_length = h});
    default:
      return Box({.half_sizes = {r, h, s}});
  }
}
// A tip of nothing, or of up to a hundredth of the base.
Shape sharp_cone(Random& random) {
  const double base = some(random), height = some(random);
  const double tip = random.uniform() < 0.5 ? 0.0 : base * random.log_uniform(1e-4, 1e-2);
  if (random.uniform() < 0.5) {
    return Frustum({.bottom_radius = base, .top_radius = tip, .half_length = height});
  }
  return Frustum({.bottom_radius = tip, .top_radius = base, .half_length = height});
}

const int kPoses = cases(12, 3, 2);

TEST(PrimitiveBounds, HoldForSharpConesWithAllOthers) {
  for (int kind = 0; kind <= 5; ++kind) {
    const Maker maker = [&](Random& random) -> Case {
      Shape cone = sharp_cone(random), round = round_one(kind, random);
      return {std::move(cone), std::move(round), random.pose(0.25)};
    };
    EXPECT_GE(check(maker, kPoses, 100 + static_cast<std::uint64_t>(kind)), kPoses / 3) << kind;
  }
}

TEST(PrimitiveBounds, HoldForTwoSharpCones) {
  const Maker maker = [](Random& random) -> Case {
    Shape one = sharp_cone(random), other = sharp_cone(random);
    return {std::move(one), std::move(other), random.pose(0.2)};
  };
  EXPECT_GE(check(maker, 2 * kPoses, 110), kPoses / 2);
}

TEST(PrimitiveBounds, HoldForRoundSolidsThatCrossDeeply) {
  for (int one = 0; one <= 4; ++one) {
    for (int other = 1; other <= one; ++other) {
      const Maker maker = [&](Random& random) -> Case {
        Shape a = round_one(one, random), b = round_one(other, random);
        return {std::move(a), std::move(b), random.pose(0.3)};
      };
      check(maker, kPoses / 3, 120 + static_cast<std::uint64_t>(5 * one + other));
    }
  }
}

// Each face of the box nearly touches the ball, or cuts a small cap off it.
TEST(PrimitiveBounds, HoldForABallAboutTheMiddleOfABox) {
  const Maker maker = [](Random& random) -> Case {
    const Mat3 turn = random.uniform() < 0.5 ? Mat3(Mat3::Identity()) : random.rotation();
    const double off = random.log_uniform(1e-6, 1e-2);
    return {
        Sphere({.radius = 0.3}), Box({.half_sizes = {0.3, 0.2, 0.25}}), {turn, random.in_box(off)}};
  };
  EXPECT_GE(check(maker, 2 * kPoses, 140), kPoses / 2);
}

}  // namespace
}  // namespace volcontact::test::primitive_bounds_test
