// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/surface_sweep/face_curve.h"

#include <gtest/gtest.h>

#include "core/support/csg_solids.h"
#include "core/support/random.h"
#include "volcontact/shape/csg/csg_lines.h"

namespace volcontact::face_curve_test {
namespace {

using namespace testing;

const Vec3 kBox = Vec3::Constant(2.0);

// The parts of any line in a solid, against a solid that holds all of it.
TEST(FaceCurve, ALineHasTheIntervalsOfTheSolid) {
  const Shape all = Box({.half_sizes = {5.0, 5.0, 5.0}});
  test::Random random(2);
  FaceCurveScratch scratch;
  SweepSpans spans;
  std::vector<RayInterval> expected;
  for (const NamedSolid& kind : kinds_of_solids()) {
    SweepSolids solids;
    ASSERT_TRUE(solids.read(kind.solid, {}, all, {}, kBox));
    for (int i = 0; i < 50; ++i) {
      FaceCurve line;
      line.p = random.in_box(0.2);
      line.u = random.direction();
      line.v = Vec3::Zero();
      find_spans(solids, line, -1, scratch, spans);
      csg_line(kind.solid, line.p, line.u, expected);
      // Members that touch are joined here, and flush faces leave nothing between them.
      std::erase_if(expected, [](const RayInterval& s) { return s.leave - s.enter < 1e-9; });
      for (std::size_t k = 1; k < expected.size();) {
        if (expected[k].enter - expected[k - 1].leave > 1e-9) {
          ++k;
          continue;
        }
        expected[k - 1].leave = expected[k].leave;
        expected.erase(expected.begin() + static_cast<long>(k));
      }
      ASSERT_EQ(spans.count, static_cast<int>(expected.size())) << kind.name << " " << i;
      for (int k = 0; k < spans.count; ++k) {
        EXPECT_NEAR(spans.span[k].low.t, expected[k].enter, 1e-8) << kind.name;
        EXPECT_NEAR(spans.span[k].high.t, expected[k].leave, 1e-8) << kind.name;
      }
    }
  }
}

// A circle about the axis of a ball's pole: where the ball's surface lies in the other solid.
TEST(FaceCurve, ACircleIsInWhereItsPlacesAre) {
  test::Random random(4);
  FaceCurveScratch scratch;
  SweepSpans spans;
  int stretches = 0;
  for (const NamedSolid& kind : kinds_of_solids()) {
    const Pose X{random.rotation(), random.in_box(0.15)};
    SweepSolids solids;
    ASSERT_TRUE(solids.read(Sphere({.radius = 0.2}), {}, kind.solid, X, kBox));
    for (int i = 0; i < 8; ++i) {
      FaceCurve circle;
      circle.circle = true;
      const Mat3 r = random.rotation();
      const double latitude = random.uniform(-1.2, 1.2);
      circle.p = 0.2 * std::sin(latitude) * r.col(2);
      circle.u = 0.2 * std::cos(latitude) * r.col(0);
      circle.v = 0.2 * std::cos(latitude) * r.col(1);
      find_spans(solids, circle, 0, scratch, spans);
      stretches += spans.count;
      for (int k = 0; k < 200; ++k) {
        const double t = 2.0 * kPi * (k + 0.5) / 200;
        const double depth = kind.solid.signed_distance(X.inverse() * circle.at(t));
        bool in = false;
        for (int s = 0; s < spans.count; ++s) {
          in = in || (t > spans.span[s].low.t && t < spans.span[s].high.t);
        }
        if (std::abs(depth) > 1e-6) {
          EXPECT_EQ(in, depth < 0.0) << kind.name << " " << t;
        }
      }
    }
  }
  EXPECT_GT(stretches, 40);
}

TEST(FaceCurve, AFaceBetweenTwoMembersIsNoSurface) {
  const Csg bars = box(.2, .1, .1, at(-.2, 0, 0)) + box(.2, .1, .1, at(.2, 0, 0));
  SweepSolids solids;
  ASSERT_TRUE(solids.read(bars, {}, Box({.half_sizes = {5.0, 5.0, 5.0}}), {}, kBox));
  FaceCurveScratch scratch;
  SweepSpans spans;
  FaceCurve line;  // in the seam, x = 0
  line.p = Vec3::Zero();
  line.u = Vec3::UnitY();
  line.v = Vec3::Zero();
  for (std::size_t f = 0; f < solids.faces.size(); ++f) {
    const SweepFace& face = solids.faces[f];
    if (face.twin != static_cast<int>(f) || std::abs(face.value(line.p)) > 1e-12) continue;
    if (std::abs(face.normal.y()) > 0.5) continue;
    find_spans(solids, line, static_cast<int>(f), scratch, spans);
    EXPECT_EQ(spans.count, 0);
  }
}

}  // namespace
}  // namespace volcontact::face_curve_test
