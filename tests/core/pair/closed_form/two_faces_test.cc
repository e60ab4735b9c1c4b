// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/closed_form/two_faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/reference/reference_integral.h"
#include "core/support/bevelled_box.h"
#include "core/support/evaluated.h"
#include "core/support/matchers.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"

namespace volcontact::two_faces_test {
namespace {

const Box kBox({.half_sizes = Vec3(0.3, 0.25, 0.2)});

ConvexPolytope bevelled() { return test::bevelled_box(kBox.half_sizes(), 0.05); }

// A round solid: a capsule, or a ball if it has no length.
struct Round {
  std::string name;
  double radius, half_length;

  Shape shape() const {
    if (half_length > 0.0) return Capsule({.radius = radius, .half_length = half_length});
    return Sphere({.radius = radius});
  }
  double size() const { return radius + half_length; }
};
const std::vector<Round> kRounds = {
    {"Ball", 0.05, 0.0}, {"Capsule", 0.03, 0.08}, {"Rod", 0.01, 0.12}, {"Stub", 0.05, 0.01}};

// An edge of B along its y axis.
struct EdgeOfB {
  Shape solid;
  Vec3 place;
  double first, second;  // angles of the outward normals of its faces from z to x [rad]
};
const std::vector<EdgeOfB>& edges() {
  static const std::vector<EdgeOfB> all = {{kBox, Vec3(0.3, 0.0, 0.2), 0.0, kPi / 2},
                                           {bevelled(), Vec3(0.25, 0.0, 0.2), 0.0, kPi / 4},
                                           {bevelled(), Vec3(0.3, 0.0, 0.15), kPi / 4, kPi / 2}};
  return all;
}
Vec3 between(double angle) { return {std::sin(angle), 0.0, std::cos(angle)}; }

// X_BA with a place of A's surface at `depth` below the edge: one of the cylinder, or any.
Pose at_edge(test::Random& random, const Round& round, const EdgeOfB& edge, double depth) {
  for (;;) {
    const Mat3 turn = random.rotation();
    Vec3 out = between(random.uniform(edge.first - 0.2, edge.second + 0.2));
    double z = std::copysign(round.half_length, -turn.transposed_times(out).z());
    if (random.uniform() < 0.7) {
      const Vec3 axis = turn.col(2);
      out = out - out.dot(axis) * axis;
      if (out.norm() < 0.2) continue;
      out = out.normalized();
      z = random.uniform(-1.0, 1.0) * round.half_length;
    }
    const Vec3 place = edge.place + Vec3(0.0, random.uniform(-0.02, 0.02), 0.0);
    return {turn, place + (round.radius - depth) * out - z * turn.col(2)};
  }
}

// By two faces: one alone has its normal.
bool is_of_two_faces(const Interference& out, const Pose& X_BA, const EdgeOfB& edge) {
  if (out.engine != Engine::kClosedForm || !out.total.touching()) return false;
  const Vec3 n = X_BA.rotation * out.total.normal();
  return (n - between(edge.first)).norm() > 1e-12 && (n - between(edge.second)).norm() > 1e-12;
}

class TwoFacesOf : public ::testing::TestWithParam<std::size_t> {
 protected:
  const Round& round() const { return kRounds[GetParam()]; }
};

// Lines are off by about as much as they claim for V, in the normal too, and by more in Q and
// depth: there columns on a grid, below, have the word.
TEST_P(TwoFacesOf, IsWhatLinesFind) {
  test::Random random(1 + GetParam());
  const int runs = test::cases(6000, 600, 60);
  int count = 0;
  for (int i = 0; i < runs; ++i) {
    const EdgeOfB& edge = edges()[static_cast<std::size_t>(i % 3)];
    const double depth =
        round().radius * (i % 2 ? random.log_uniform(1e-6, 0.1) : random.uniform(0.05, 1.5));
    const Pose X_BA = at_edge(random, round(), edge, depth), X_AB = X_BA.inverse();
    const Interference out = test::evaluated(round().shape(), edge.solid, X_AB);
    if (!is_of_two_faces(out, X_BA, edge)) continue;
    ASSERT_EQ(out.sites.size(), 1u);
    ASSERT_EQ(out.total.status, Status::kOk);
    const Interference lines =
        test::evaluated(round().shape(), edge.solid, X_AB, Engine::kLines, 1e-6);
    if (lines.engine != Engine::kLines) continue;
    ++count;
    const double doubt = 1e-5 + 2.0 * lines.total.volume_error / lines.total.volume;
    EXPECT_NEAR(out.total.volume, lines.total.volume, 2e-5 * out.total.volume) << i;
    EXPECT_NEAR(out.total.depth, lines.total.depth, 0.02 * out.total.depth) << i;
    EXPECT_NEAR(out.total.depth_moment, lines.total.depth_moment, 5e-3 * out.total.depth_moment)
        << i;
    VolumeMetrics expected = lines.total;
    expected.depth = out.total.depth;
    expected.depth_moment = out.total.depth_moment;
    expected.status = out.total.status;  // lines were asked for more than they can do
    EXPECT_TRUE(test::same(out.total, expected, {doubt + 1e-4, round().size()})) << i;
    const Interference back = test::evaluated(edge.solid, round().shape(), X_BA);
    EXPECT_EQ(back.engine, Engine::kClosedForm);
    EXPECT_TRUE(
        test::same(reversed(transformed(back.total, X_AB)), out.total, {1e-9, round().size()}))
        << i;
  }
  EXPECT_GT(count, runs / 3);
}

// An integral that has no part of an engine.
TEST_P(TwoFacesOf, IsTheReferenceIntegral) {
  test::Random random(20 + GetParam());
  int count = 0;
  for (int i = 0; i < test::cases(60, 3, 1); ++i) {
    const EdgeOfB& edge = edges()[static_cast<std::size_t>(i % 3)];
    const double depth = round().radius * random.log_uniform(0.01, 1.0);
    const Pose X_BA = at_edge(random, round(), edge, depth), X_AB = X_BA.inverse();
    const Interference out = test::evaluated(round().shape(), edge.solid, X_AB);
    if (!is_of_two_faces(out, X_BA, edge)) continue;
    ++count;
    const Pose X_AF{basis_with_z(out.total.normal()), out.total.centroid};
    const test::Reference reference = test::reference_integral(
        test::reference_solid(round().shape()), test::reference_solid(edge.solid), X_AB,
        {X_AF, 2.0 * round().size()});
    ASSERT_LT(reference.volume_error, 1e-6 * out.total.volume) << i;
    EXPECT_NEAR(out.total.volume, reference.metrics.volume, 2e-6 * out.total.volume) << i;
    VolumeMetrics expected = reference.metrics;
    expected.depth = out.total.depth;
    expected.depth_moment = out.total.depth_moment;
    expected.status = out.total.status;
    EXPECT_TRUE(test::same(out.total, expected, {1e-4, round().size()})) << i;
  }
  EXPECT_GT(count, 0);
}

// Columns on a grid along the normal: from A's surface up to the roof of the two planes, or to A's
// own top with what is above of B on top of it.
TEST_P(TwoFacesOf, DepthAndQAreThoseOfColumns) {
  test::Random random(40 + GetParam());
  const EdgeOfB& edge = edges()[0];
  for (int i = 0; i < test::cases(40, 6, 1); ++i) {
    const double at = round().radius * random.uniform(0.05, 1.4);
    const Pose X_BA = at_edge(random, round(), edge, at);
    const VolumeMetrics m = test::evaluated(round().shape(), edge.solid, X_BA.inverse()).total;
    if (!is_of_two_faces(test::evaluated(round().shape(), edge.solid, X_BA.inverse()), X_BA,
                         edge)) {
      continue;
    }
    const Capsule a({.radius = round().radius, .half_length = round().half_length});
    const Vec3 n = m.normal();
    const Mat3 R = basis_with_z(n);
    const std::array<Vec3, 2> normals = {X_BA.rotation.transposed_times(between(edge.first)),
                                         X_BA.rotation.transposed_times(between(edge.second))};
    std::array<double, 2> heights;
    for (std::size_t k = 0; k < 2; ++k) {
      heights[k] = between(k ? edge.second : edge.first).dot(X_BA.translation - edge.place);
    }
    double low = kInfinity, high = -kInfinity, q = 0.0;
    Vec3 from = Vec3::Constant(-round().size()), to = Vec3::Constant(round().size());
    for (const int lines : {100, 500}) {  // a window, and what is in it
      Vec3 first = Vec3::Constant(kInfinity), last = Vec3::Constant(-kInfinity);
      const Vec3 step = (to - from) / lines;
      q = 0.0;
      for (int j = 0; j < lines; ++j) {
        for (int k = 0; k < lines; ++k) {
          const Vec3 place(from.x() + (j + 0.5) * step.x(), from.y() + (k + 0.5) * step.y(), 0.0);
          const Vec3 o = R * place;
          const RayInterval in_a = a.ray(o, n);
          double roof = kInfinity;
          for (std::size_t f = 0; f < 2; ++f) {
            roof = std::min(roof, -(normals[f].dot(o) + heights[f]) / normals[f].dot(n));
          }
          const double top = std::min(in_a.leave, roof);
          if (in_a.empty() || !(top > in_a.enter)) continue;
          const double length = top - in_a.enter;
          q += step.x() * step.y() * length * (0.5 * length + roof - top);
          first = first.cwiseMin(place);
          last = last.cwiseMax(place);
          low = std::min(low, in_a.enter);
          high = std::max(high, top);
        }
      }
      from = first - step;
      to = last + step;
    }
    EXPECT_NEAR(m.depth_moment, q, 4e-3 * q) << i;
    EXPECT_GT(m.depth, (high - low) * (1.0 - 1e-9)) << i;
    EXPECT_NEAR(m.depth, high - low, 0.02 * m.depth) << i;
  }
}

// From the face, over the edge, to the other face: V has a continuous slope, nothing has a step.
TEST_P(TwoFacesOf, NoStepsOverTheEdge) {
  test::Random random(60 + GetParam());
  constexpr double kStep = 1e-10;
  int changes = 0;
  for (int i = 0; i < test::cases(300, 60, 6); ++i) {
    const EdgeOfB& edge = edges()[0];
    const Mat3 turn = random.rotation();
    const double depth = round().radius * random.uniform(0.01, 0.5);
    const double low = round().radius + round().half_length * std::abs(turn.row(2).z());
    const auto at = [&](double x) {
      const Pose X_BA{turn, Vec3(x, 0.0, edge.place.z() + low - depth)};
      return test::evaluated(round().shape(), edge.solid, X_BA.inverse());
    };
    const auto is_one_face = [&](const Interference& out) {
      return (turn * out.total.normal() - Vec3::UnitZ()).norm() < 1e-13;
    };
    // Where the edge begins to cut.
    double inside = 0.0, outside = 0.3;
    while (outside - inside > kStep) {
      const double middle = 0.5 * (inside + outside);
      (is_one_face(at(middle)) ? inside : outside) = middle;
    }
    const Interference one = at(inside), two = at(outside);
    if (!one.total.touching() || one.engine != two.engine) continue;
    if (two.engine != Engine::kClosedForm) continue;
    ++changes;
    EXPECT_LT((one.total.inertia - two.total.inertia).norm(), 1e-4 * one.total.inertia.norm()) << i;
    EXPECT_NEAR(one.total.depth_moment, two.total.depth_moment, 1e-4 * one.total.depth_moment) << i;
    VolumeMetrics expected = one.total;
    expected.inertia = two.total.inertia;
    expected.depth_moment = two.total.depth_moment;
    EXPECT_TRUE(test::same(two.total, expected, {3e-6, round().size()})) << i;
    EXPECT_NEAR(one.total.depth, two.total.depth, 1e-3 * one.total.depth) << i;
    EXPECT_LT((one.total.normal() - two.total.normal()).norm(), 1e-6) << i;
  }
  EXPECT_GT(changes, 0);
}

INSTANTIATE_TEST_SUITE_P(Solids, TwoFacesOf, ::testing::Values(0u, 1u, 2u, 3u),
                         [](const auto& tested) { return kRounds[tested.param].name; });

// Of a solid that is its own mirror image in both planes: a quarter of it, and of its integrals.
TEST(TwoFaces, AQuarterIsAQuarter) {
  for (const Round& round : kRounds) {
    const double r = round.radius, l = round.half_length;
    // The axis along the edge, and z, the top of the box, along the axis of A that is x there.
    const Pose X_BA{Mat3::with_columns(Vec3::UnitZ(), Vec3::UnitX(), Vec3::UnitY()),
                    edges()[0].place};
    const Interference out = test::evaluated(round.shape(), kBox, X_BA.inverse());
    EXPECT_EQ(out.engine, Engine::kClosedForm);
    const VolumeMetrics& m = out.total;
    const double volume = kPi * r * r * (2.0 / 4.0 * l + r / 3.0);
    EXPECT_NEAR(m.volume, volume, 1e-9 * volume);
    // Half discs about the axis, each with the area 2 r^2 / 2 of the lower half.
    const double first = 2.0 / 3.0 * r * r * r / 2.0 * 2.0 * l + kPi / 8.0 * r * r * r * r;
    EXPECT_LT((m.centroid - Vec3(-first, -first, 0.0) / volume).norm(), 1e-9 * r) << round.name;
    const double face = 2.0 * r * l + kPi / 2.0 * r * r;
    EXPECT_NEAR(m.counter_area, 2.0 * face, 1e-9 * face);
    EXPECT_NEAR(m.area, kPi * r * (r + l), 1e-9 * face);
    EXPECT_LT((m.area_vector - Vec3(-face, -face, 0.0)).norm(), 1e-9 * face);
    EXPECT_LT(m.area_moment.norm(), 1e-9 * face * r);
    EXPECT_NEAR(m.depth, r, 1e-9 * r);
    const double second = kPi / 16.0 * r * r * r * r * 2.0 * l + kPi * r * r * r * r * r / 15.0;
    const Mat3 about = m.second_moment() + m.volume * outer(m.centroid, m.centroid);
    EXPECT_NEAR(about(0, 0), second, 1e-8 * second);
    EXPECT_NEAR(about(1, 1), second, 1e-8 * second);
  }
}

// Poses of a drawing: the axis along the edge, across it, at 45 degrees, upright, at places that
// are even numbers. Also where a face is in line with an end of the cylinder.
TEST(TwoFaces, PosesOfADrawing) {
  const double r = 0.03, l = 0.08;
  const Shape capsule = Capsule({.radius = r, .half_length = l});
  const EdgeOfB& edge = edges()[0];
  const double offsets[] = {0.0, r / 2, -r / 2, 0.999 * r, -0.999 * r, r, l, -l, l + r / 2};
  int count = 0, others = 0;
  for (int axis = 14; axis < 27; ++axis) {  // half of the directions: a capsule has two ends
    const Vec3 along = Vec3(axis % 3 - 1, axis / 3 % 3 - 1, axis / 9 - 1).normalized();
    for (const double x : offsets) {
      for (const double z : offsets) {
        const Pose X_BA{basis_with_z(along), edge.place + Vec3(x, 0.0, z)};
        const Interference out = test::evaluated(capsule, kBox, X_BA.inverse());
        if (!out.total.touching()) continue;
        if (!is_of_two_faces(out, X_BA, edge)) {
          others += out.engine != Engine::kClosedForm;
          continue;
        }
        const Interference lines =
            test::evaluated(capsule, kBox, X_BA.inverse(), Engine::kLines, 1e-6);
        ++count;
        EXPECT_NEAR(out.total.volume, lines.total.volume,
                    2.0 * lines.total.volume_error + 1e-5 * out.total.volume)
            << along.x() << along.y() << along.z() << " " << x << " " << z;
      }
    }
  }
  EXPECT_GT(count, 100);
  EXPECT_LT(others, count);
}

// The third face of a corner is not left out, nor what cuts the far end of a rod.
TEST(TwoFaces, CornersAreLeftToOthers) {
  const Shape ball = Sphere({.radius = 0.05});
  const Pose at_corner{Mat3::Identity(), Vec3(0.31, 0.24, 0.21)};
  EXPECT_EQ(test::evaluated(ball, kBox, at_corner.inverse()).engine, Engine::kLines);
  const Pose before{Mat3::Identity(), Vec3(0.31, 0.25 - 0.06, 0.21)};
  EXPECT_EQ(test::evaluated(ball, kBox, before.inverse()).engine, Engine::kClosedForm);
  const Shape rod = Capsule({.radius = 0.01, .half_length = 0.5});
  const Pose along_edge{Mat3::with_columns(Vec3::UnitZ(), Vec3::UnitX(), Vec3::UnitY()),
                        Vec3(0.3, 0.0, 0.2)};
  EXPECT_EQ(test::evaluated(rod, kBox, along_edge.inverse()).engine, Engine::kLines);
  const Interference within = test::evaluated(ball, kBox, Pose{});
  EXPECT_EQ(within.total.status, Status::kContained);
  EXPECT_NE(within.engine, Engine::kClosedForm);
}

TEST(TwoFaces, IsAskedByAutoAlone) {
  const Shape ball = Sphere({.radius = 0.05}), box = kBox;
  const Pose X_BA{Mat3::Identity(), Vec3(0.32, 0.0, 0.225)};
  EXPECT_EQ(test::evaluated(ball, box, X_BA.inverse()).engine, Engine::kClosedForm);
  EXPECT_EQ(test::evaluated(ball, box, X_BA.inverse(), Engine::kLines).engine, Engine::kLines);
  EXPECT_FALSE(serves(Engine::kClosedForm, ball, box));
  EXPECT_EQ(engine_for(ball, box), Engine::kLines);
}

}  // namespace
}  // namespace volcontact::two_faces_test
