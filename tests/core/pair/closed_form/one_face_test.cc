// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/closed_form/one_face.h"

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "core/support/bevelled_box.h"
#include "core/support/evaluated.h"
#include "core/support/matchers.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"

namespace volcontact::one_face_test {
namespace {

const Box kBox({.half_sizes = Vec3(0.3, 0.25, 0.2)});

ConvexPolytope bevelled() { return test::bevelled_box(kBox.half_sizes(), 0.01); }

const std::map<std::string, Shape>& round_solids() {
  static const std::map<std::string, Shape> solids = {
      {"Ball", Sphere({.radius = 0.05})},
      {"Capsule", Capsule({.radius = 0.03, .half_length = 0.08})},
      {"Cylinder", Cylinder({.radius = 0.04, .half_length = 0.06})},
      {"Ellipsoid", Ellipsoid({.semi_axes = Vec3(0.05, 0.03, 0.08)})},
      {"Frustum", Frustum({.bottom_radius = 0.05, .top_radius = 0.02, .half_length = 0.06})},
      {"Torus", Torus({.major_radius = 0.06, .minor_radius = 0.02})}};
  return solids;
}

class OneFaceOf : public ::testing::TestWithParam<std::string> {
 protected:
  const Shape& solid() const { return round_solids().at(GetParam()); }
};

Pose near_a_side(test::Random& random, int side) {
  Pose X{random.rotation(), Vec3()};
  const int axis = side % 3;
  const double sign = side < 3 ? 1.0 : -1.0;
  for (int i = 0; i < 3; ++i) {
    X.translation[i] = random.uniform(-1.0, 1.0) * kBox.half_sizes()[i];
  }
  X.translation[axis] = sign * (kBox.half_sizes()[axis] + random.uniform(-0.03, 0.08));
  return X;
}

// The face that looks most along a direction.
struct FaceAlong {
  Vec3 direction;
  Vec3 normal = Vec3::Zero();
  double offset = 0.0;

  void plane(const Vec3& other, double at) {
    if (other.dot(direction) <= normal.dot(direction)) return;
    normal = other;
    offset = at;
  }
};

// Over an edge the normal is that of no face.
template <typename B>
bool is_of_one_face(const Interference& out, const B& planar, const Pose& X_AB) {
  if (out.engine != Engine::kClosedForm) return false;
  FaceAlong face{X_AB.rotation.transposed_times(out.total.normal())};
  planar.write_faces(face);
  return !out.total.touching() || (face.normal - face.direction).norm() < 1e-12;
}

// Against cells with certified bounds, which know of no half-space, and Q = V d_c, with d_c the
// depth of the centroid below the face.
template <typename B>
void expect_right(const Shape& round, const B& planar, std::uint64_t seed) {
  test::Random random(seed);
  // Cells take long with a torus.
  const int runs = std::holds_alternative<Torus>(round) ? 24 : test::cases(90, 36, 36);
  int by_formula = 0, others = 0;
  for (int i = 0; i < runs; ++i) {
    const Pose X_AB = near_a_side(random, i % 6).inverse();
    const Interference out = test::evaluated(round, planar, X_AB);
    if (!is_of_one_face(out, planar, X_AB)) {
      ++others;
      continue;
    }
    const Interference cells = test::evaluated(round, planar, X_AB, Engine::kOctree, 2e-3);
    ASSERT_EQ(out.total.touching(), cells.total.touching()) << i;
    ASSERT_EQ(out.sites.size(), out.total.touching() ? 1u : 0u);
    if (!out.total.touching()) continue;
    ++by_formula;
    EXPECT_LE(std::abs(out.total.volume - cells.total.volume),
              cells.total.volume_error + 1e-12 * out.total.volume)
        << i;
    // Where the solid goes over an edge, lines go on.
    const Interference lines = test::evaluated(round, planar, X_AB, Engine::kLines);
    EXPECT_LE(std::abs(out.total.volume - lines.total.volume),
              lines.total.volume_error + 1e-12 * out.total.volume)
        << i;
    FaceAlong face{X_AB.rotation.transposed_times(out.total.normal())};
    planar.write_faces(face);
    const Vec3 centroid_B = X_AB.inverse() * out.total.centroid;
    VolumeMetrics expected = cells.total;
    expected.area = out.total.area;  // rougher than the rest
    expected.depth_moment = out.total.volume * (face.offset - face.normal.dot(centroid_B));
    expected.status = out.total.status;
    EXPECT_TRUE(test::same(out.total, expected, {0.02, 0.1})) << i;
    const Interference back = test::evaluated(planar, round, X_AB.inverse());
    EXPECT_EQ(back.engine, Engine::kClosedForm);
    EXPECT_TRUE(test::same(reversed(transformed(back.total, X_AB)), out.total, {1e-9, 0.1})) << i;
  }
  EXPECT_GT(by_formula, runs / 6);
  EXPECT_GT(others, runs / 18);  // over an edge
}

TEST_P(OneFaceOf, ABoxIsThatOfAHalfSpace) { expect_right(solid(), kBox, 1); }

TEST_P(OneFaceOf, APolytopeIsThatOfAHalfSpace) { expect_right(solid(), bevelled(), 2); }

INSTANTIATE_TEST_SUITE_P(Solids, OneFaceOf,
                         ::testing::Values("Ball", "Capsule", "Cylinder", "Ellipsoid", "Frustum",
                                           "Torus"),
                         [](const auto& tested) { return tested.param; });

// Only its foot is behind the face; far above it leans out over an edge.
TEST(OneFace, ACapsuleMayLeanOverAnEdge) {
  const Capsule capsule({.radius = 0.02, .half_length = 0.3});
  const Vec3 along = Vec3(0.5, 0.0, 1.0).normalized();
  const Vec3 foot(0.2, 0.0, 0.2 + 0.015);
  const Pose X_BA{basis_with_z(along), foot + 0.3 * along};
  const Interference out = test::evaluated(capsule, kBox, X_BA.inverse());
  EXPECT_EQ(out.engine, Engine::kClosedForm);
  const Interference ball =
      test::evaluated(Sphere({.radius = 0.02}), kBox, Pose{Mat3::Identity(), foot}.inverse());
  EXPECT_NEAR(out.total.volume, ball.total.volume, 1e-12 * ball.total.volume);
  // With the foot nearer to the edge than what of it is behind the face, it is another matter.
  const Pose nearer{X_BA.rotation, X_BA.translation + Vec3(0.095, 0.0, 0.0)};
  EXPECT_FALSE(
      is_of_one_face(test::evaluated(capsule, kBox, nearer.inverse()), kBox, nearer.inverse()));
}

// Its equator is beyond the edge; what counts is how far the cap behind the face reaches.
TEST(OneFace, ABallMayReachOverAnEdge) {
  const Sphere ball({.radius = 0.05});
  const double height = 0.049, rim = std::sqrt(0.05 * 0.05 - height * height);
  const auto with_rim_at = [&](double x) {
    const Pose X_BA{Mat3::Identity(), Vec3(x - rim, 0.1, 0.2 + height)};
    return test::evaluated(ball, kBox, X_BA.inverse());
  };
  const double cap = kPi / 3.0 * 0.001 * 0.001 * (3.0 * 0.05 - 0.001);
  for (const double x : {0.25, 0.2999999, 0.3 - 1e-12}) {
    const Interference out = with_rim_at(x);
    EXPECT_EQ(out.engine, Engine::kClosedForm);
    EXPECT_EQ(out.total.normal(), Vec3::UnitZ());
    EXPECT_NEAR(out.total.volume, cap, 1e-12 * cap);
  }
  const Interference cut = with_rim_at(0.3 + 0.1 * rim);
  EXPECT_GT(cut.total.normal().x(), 1e-3);
  EXPECT_LT(cut.total.volume, 0.999 * cap);
}

// About edges of a right angle, and of bevels: a little too far, and lines find less.
TEST(OneFace, ARoundSolidNearAnEdgeIsThatOfLines) {
  test::Random random(11);
  const Shape solids[] = {Sphere({.radius = 0.05}), Capsule({.radius = 0.05, .half_length = 0.04}),
                          Cylinder({.radius = 0.05, .half_length = 0.04})};
  const Shape planar[] = {kBox, bevelled()};
  int by_formula = 0;
  for (int i = 0; i < 600; ++i) {
    const Shape& solid = solids[i % 3];
    const Vec3 place(random.uniform(0.2, 0.32), random.uniform(0.15, 0.27), 0.0);
    const Mat3 turn = random.rotation();
    const double low =
        std::visit([&](const auto& s) { return s.support_height(-Vec3(turn.row(2))); }, solid);
    const double depth = 0.02 * random.uniform() * random.uniform();
    const Pose X_BA{turn, place + Vec3(0.0, 0.0, 0.2 + low - depth)};
    const Interference out = test::evaluated(solid, planar[i / 3 % 2], X_BA.inverse());
    if (out.engine != Engine::kClosedForm || !out.total.touching()) continue;
    ++by_formula;
    const Interference lines =
        test::evaluated(solid, planar[i / 3 % 2], X_BA.inverse(), Engine::kLines);
    EXPECT_NEAR(out.total.volume, lines.total.volume,
                lines.total.volume_error + 1e-3 * out.total.volume)
        << i;
  }
  EXPECT_GT(by_formula, 100);
}

TEST(OneFace, WhatIsAheadOfAFaceTouchesNothing) {
  test::Random random(5);
  for (const auto& [name, solid] : round_solids()) {
    for (int i = 0; i < 50; ++i) {
      const Vec3 direction = random.direction();
      const Pose X_BA{random.rotation(), (0.45 + random.uniform()) * direction};
      const Interference out = test::evaluated(solid, kBox, X_BA.inverse());
      if (out.engine != Engine::kClosedForm) continue;
      EXPECT_FALSE(out.total.touching());
      EXPECT_FALSE(test::evaluated(solid, kBox, X_BA.inverse(), Engine::kLines).total.touching())
          << name;
    }
  }
}

TEST(OneFace, WithinTheSolidIsLeftToOthers) {
  const Interference out = test::evaluated(Sphere({.radius = 0.05}), kBox, Pose{});
  EXPECT_EQ(out.total.status, Status::kContained);
  EXPECT_NE(out.engine, Engine::kClosedForm);
}

// Against a face from inside, out of it by less than rounding or not at all.
TEST(OneFace, WhatTouchesAFaceFromInsideIsContained) {
  for (const auto& [name, solid] : round_solids()) {
    const double reach =
        std::visit([](const auto& s) { return s.support_height(Vec3::UnitZ()); }, solid);
    const double whole = std::visit([](const auto& s) { return s.own_metrics().volume; }, solid);
    for (const double out : {-1e-16, 0.0, 1e-17, 3e-17, 1e-16}) {
      const Pose X_BA{Mat3::Identity(), Vec3(0.0, 0.0, 0.2 - reach + out)};
      const Interference m = test::evaluated(solid, kBox, X_BA.inverse());
      EXPECT_TRUE(m.total.status != Status::kContained || m.engine != Engine::kClosedForm) << name;
      EXPECT_NEAR(m.total.volume, whole, 1e-3 * whole);
    }
  }
}

TEST(OneFace, IsAskedByAutoAlone) {
  const Shape ball = Sphere({.radius = 0.05}), box = kBox;
  const Pose X_BA{Mat3::Identity(), Vec3(0.0, 0.0, 0.24)};
  EXPECT_EQ(test::evaluated(ball, box, X_BA.inverse()).engine, Engine::kClosedForm);
  EXPECT_EQ(test::evaluated(ball, box, X_BA.inverse(), Engine::kLines).engine, Engine::kLines);
  EXPECT_FALSE(serves(Engine::kClosedForm, ball, box));
  EXPECT_EQ(engine_for(ball, box), Engine::kLines);
}

}  // namespace
}  // namespace volcontact::one_face_test
