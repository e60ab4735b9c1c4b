// SPDX-License-Identifier: Apache-2.0

// What is promised of single pairs, by numbers that do not come from the engines. Others stand in
// tests/core/pair: half-space with a round solid and two balls in closed_form/, a ball on the rim
// of a bore in bored_lines_test.cc.
#include <gtest/gtest.h>

#include "core/reference/reference_integral.h"
#include "core/support/evaluated.h"
#include "core/support/random.h"
#include "volcontact/pair/interference.h"

namespace volcontact::test::acceptance_test {
namespace {

// Volume, centroid and inertia, relative; the area vector by A's area, along the normal n alone
// where one is given: of thin overlaps the reference knows no more.
void expect_close(const VolumeMetrics& m, const VolumeMetrics& expected, double volume,
                  double others, const Vec3& n = Vec3::Zero()) {
  const double length = std::sqrt(expected.second_moment().trace() / expected.volume);
  EXPECT_NEAR(m.volume / expected.volume, 1.0, volume);
  EXPECT_LE((m.centroid - expected.centroid).norm(), others * length);
  EXPECT_LE((m.inertia - expected.inertia).norm(), others * expected.inertia.norm());
  const Vec3 error = m.area_vector - expected.area_vector;
  EXPECT_LE(n.isZero() ? error.norm() : std::abs(error.dot(n)), others * expected.area);
}

// A corner with three edges below the plane z = 0 of A: a tetrahedron.
VolumeMetrics corner(const Vec3& tip, const Vec3 edges[3]) {
  Vec3 points[4] = {tip};
  for (int i = 0; i < 3; ++i) points[i + 1] = tip - tip.z() / edges[i].z() * edges[i];
  VolumeMetrics m;
  const Vec3 a = points[1] - tip, b = points[2] - tip, c = points[3] - tip;
  m.volume = std::abs(a.cross(b).dot(c)) / 6.0;
  m.centroid = 0.25 * (points[0] + points[1] + points[2] + points[3]);
  Mat3 second = Mat3::Zero();
  for (const Vec3& p : points) {
    second += m.volume / 20.0 * outer(p - m.centroid, p - m.centroid);
  }
  m.inertia = second.trace() * Mat3::Identity() - second;
  m.area = 0.5 * (b - a).cross(c - a).norm();
  m.area_vector = m.area * Vec3::UnitZ();
  return m;
}

constexpr double kExact = 1e-12;

TEST(Acceptance, CornerOfABox) {
  const Vec3 half(0.4, 0.3, 0.2);
  const Box box({.half_sizes = half});
  Random random(1);
  for (int i = 0; i < 20; ++i) {
    // The tip is the corner that is lowest; well inside of the face of the box below.
    const Mat3 r = random.rotation();
    Vec3 edges[3], tip(0.05, -0.03, -random.log_uniform(1e-3, 2e-2)), offset = Vec3::Zero();
    double least = 1.0;
    for (int k = 0; k < 3; ++k) {
      edges[k] = r.col(k) * std::copysign(1.0, r(2, k));
      offset += half[k] * edges[k];
      least = std::min(least, edges[k].z());
    }
    if (least < 0.2) continue;  // a long thin corner may reach an end of the box
    const Pose X{r, tip + offset};
    const VolumeMetrics expected = corner(tip, edges);
    expect_close(evaluated(HalfSpace(), box, X).total, expected, kExact, 10.0 * kExact);
    // The same plane as the upper face of a box.
    const Pose up{Mat3::Identity(), Vec3(0.0, 0.0, half.z())};
    expect_close(evaluated(box, box, up * X).total, transformed(expected, up), kExact,
                 10.0 * kExact);
  }
}

// The truncated icosahedron has 32 faces, and three edges at every corner.
std::vector<Vec3> football() {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  const Vec3 seeds[] = {{0.0, 1.0, 3.0 * g}, {1.0, 2.0 + g, 2.0 * g}, {g, 2.0, 2.0 * g + 1.0}};
  std::vector<Vec3> points;
  for (const Vec3& seed : seeds) {
    for (int signs = 0; signs < 8; ++signs) {
      if (seed.x() == 0.0 && signs % 2 == 1) continue;
      const Vec3 s(signs & 1 ? -1.0 : 1.0, signs & 2 ? -1.0 : 1.0, signs & 4 ? -1.0 : 1.0);
      const Vec3 p = 0.1 * seed.cwiseProduct(s);
      for (int k = 0; k < 3; ++k) points.emplace_back(p[k], p[(k + 1) % 3], p[(k + 2) % 3]);
    }
  }
  return points;
}

TEST(Acceptance, CornersOfA32Hedron) {
  const std::vector<Vec3> points = football();
  const ConvexPolytope ball(points);
  ASSERT_EQ(points.size(), 60u);
  ASSERT_EQ(ball.faces().size(), 32u);
  // A hexagon of A, with z up; its pole p is the point of the face nearest the center.
  const auto& face =
      *std::max_element(ball.faces().begin(), ball.faces().end(),
                        [](const auto& a, const auto& b) { return a.offset > b.offset; });
  const Pose X_AF{basis_with_z(face.normal), face.offset * face.normal};
  Random random(2);
  for (const Vec3& point : points) {
    // Its three nearest neighbours are those that edges lead to.
    std::vector<Vec3> others = points;
    std::sort(others.begin(), others.end(), [&](const Vec3& a, const Vec3& b) {
      return (a - point).norm() < (b - point).norm();
    });
    const Mat3 point_down = basis_with_z(-point.normalized()).transpose();
    const Mat3 r = turn(random.direction(), 0.1) * point_down;
    const Vec3 tip(0.01, 0.005, -random.log_uniform(1e-3, 1e-2));
    Vec3 edges[3];
    for (int k = 0; k < 3; ++k) {
      edges[k] = r * (others[static_cast<std::size_t>(k + 1)] - point).normalized();
    }
    const VolumeMetrics expected = corner(tip, edges);
    const VolumeMetrics m = evaluated(ball, ball, X_AF * Pose{r, tip - r * point}).total;
    expect_close(m, transformed(expected, X_AF), kExact, 10.0 * kExact);
  }
}

// The integral with lines along the axes of a frame in the overlap, whose z axis is about the
// normal.
Reference reference(const Shape& a, const Shape& b, const Pose& X_AB, const Pose& X_AF,
                    double range) {
  return reference_integral(reference_solid(a), reference_solid(b), X_AB, {X_AF, range});
}

const Mat3 kAskew = turn(Vec3(0.2, 0.1, 1.0), 0.3);  // off the edges of the solids

TEST(Acceptance, AnEllipsoidOverTheEdgeOfABox) {
  const Shape box = Box({.half_sizes = Vec3(0.4, 0.3, 0.2)});
  const Shape ellipsoid = Ellipsoid({.semi_axes = Vec3(0.3, 0.2, 0.15)});
  for (const double depth : {0.003, 0.02, 0.06}) {
    const Vec3 edge(0.4, 0.05, 0.2), out = Vec3(1.0, 0.0, 0.7).normalized();
    const Mat3 r = turn(Vec3(0.3, 1.0, 0.2), 0.6);
    // The point of the ellipsoid farthest along -out lies `depth` under the edge.
    const Vec3 axes(0.3, 0.2, 0.15), e = r.transpose() * -out;
    const Vec3 farthest = axes.cwiseAbs2().cwiseProduct(e) / axes.cwiseProduct(e).norm();
    const Pose X{r, edge - depth * out - r * farthest};
    const Reference expected =
        reference(box, ellipsoid, X, {basis_with_z(out) * kAskew, edge - 0.5 * depth * out}, 0.5);
    ASSERT_LT(expected.volume_error, 1e-7 * expected.metrics.volume);
    expect_close(evaluated(box, ellipsoid, X).total, expected.metrics, 1e-5, 1e-4, out);
  }
}

TEST(Acceptance, TheCapEdgeOfATiltedCylinderInABoxFace) {
  const Shape box = Box({.half_sizes = Vec3(0.4, 0.4, 0.2)});
  const Shape cylinder = Cylinder({.radius = 0.2, .half_length = 0.3});
  for (const double depth : {0.002, 0.02}) {
    for (const double tilt : {0.05, 0.4, 1.2}) {
      const Mat3 r = turn(Vec3(1.0, 0.5, 0.0), tilt);
      // The lowest point of the lower cap's edge.
      const Vec3 down = r.transpose() * -Vec3::UnitZ();
      const Vec3 low(0.2 * down.x() / std::hypot(down.x(), down.y()),
                     0.2 * down.y() / std::hypot(down.x(), down.y()), -0.3);
      const Vec3 tip(0.03, 0.05, 0.2 - depth);
      const Pose X{r, tip - r * low};
      const Reference expected =
          reference(box, cylinder, X, {kAskew, tip + Vec3(0.0, 0.0, 0.5 * depth)}, 0.5);
      ASSERT_LT(expected.volume_error, 1e-6 * expected.metrics.volume);
      expect_close(evaluated(box, cylinder, X).total, expected.metrics, 1e-4, 1e-3, Vec3::UnitZ());
    }
  }
}

// Ten times a bore of 10 mm: clearances of 3 % and of 0.02 mm.
struct PegInBore {
  explicit PegInBore(double clearance)
      : peg(Cylinder({.radius = 0.1 - clearance, .half_length = 0.4})),
        X(Pose{turn(Vec3(1.0, 0.2, 0.0), 1.5 * clearance / 0.2), Vec3::Zero()}) {}
  Shape block = Csg(Csg::Operation::kDifference, Csg(Box({.half_sizes = Vec3(0.3, 0.3, 0.2)})),
                    Csg(Cylinder({.radius = 0.1, .half_length = 0.5})));
  Shape peg;
  Pose X;
};

TEST(Acceptance, ATiltedPegInABoreTouchesInTwoSites) {
  for (const double clearance : {3e-3, 2e-4}) {
    const PegInBore c(clearance);
    const Interference out = evaluated(c.block, c.peg, c.X);
    EXPECT_EQ(out.engine, Engine::kLines);
    ASSERT_EQ(out.sites.size(), 2u);
    for (const VolumeMetrics& site : out.sites) {
      const Mat3 look = basis_with_z(site.normal()) * turn(Vec3::UnitZ(), 0.3);
      // The sites lie at the two ends of the bore: the half of the block with this one.
      const double up = site.centroid.z() > 0.0 ? kPi : 0.0;
      const Csg half(Csg::Operation::kIntersection, std::get<Csg>(c.block),
                     Csg(HalfSpace(), Pose{turn(Vec3::UnitX(), up), Vec3::Zero()}));
      const Reference expected = reference(half, c.peg, c.X, {look, site.centroid}, 1.0);
      ASSERT_LT(expected.volume_error, 1e-5 * expected.metrics.volume);
      expect_close(site, expected.metrics, 1e-4, 1e-3, site.normal());
    }
  }
}

TEST(Acceptance, TheOctreeBoundsAPegInABore) {
  for (const double clearance : {3e-3, 2e-4}) {
    const PegInBore c(clearance);
    const VolumeMetrics m =
        evaluated(c.block, c.peg, c.X, {.tolerance = 1e-2, .engine = Engine::kOctree}).total;
    const VolumeMetrics lines = evaluated(c.block, c.peg, c.X).total;  // judged above, to 1e-4
    EXPECT_EQ(m.status, Status::kOk);
    EXPECT_LE(m.volume_error, 1e-2 * m.volume);
    EXPECT_LE(std::abs(m.volume - lines.volume), m.volume_error + 1e-4 * lines.volume);
  }
}

}  // namespace
}  // namespace volcontact::test::acceptance_test
