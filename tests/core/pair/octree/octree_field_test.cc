// SPDX-License-Identifier: Apache-2.0

// Users' solids through the octree: what it makes of a signed distance alone.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>

#include "core/support/random.h"
#include "volcontact/pair/interference.h"

namespace volcontact::octree_field_test {
namespace {

struct Ball {
  double radius;
  Aabb bounds() const { return {Vec3::Constant(-radius), Vec3::Constant(radius)}; }
  double signed_distance(const Vec3& p) const { return p.norm() - radius; }
};

SignedDistance smooth_ball(double radius) {
  return SignedDistance(Ball{radius}, {.curvature = 1.5 / radius});
}

// A bar of rectangular section, turned by `twist` about z a metre. Steeper than a distance away
// from its axis.
struct TwistedBar {
  double half_x, half_y, half_z, twist;
  double reach() const { return std::hypot(half_x, half_y); }
  // Up to the corners of the bounds.
  double lipschitz() const { return std::sqrt(1.0 + 2.0 * std::pow(twist * reach(), 2)); }
  Aabb bounds() const {
    const Vec3 half(reach(), reach(), half_z);
    return {-half, half};
  }
  double signed_distance(const Vec3& p) const {
    const double c = std::cos(twist * p.z()), s = std::sin(twist * p.z());
    return std::max({std::abs(c * p.x() + s * p.y()) - half_x,
                     std::abs(c * p.y() - s * p.x()) - half_y, std::abs(p.z()) - half_z});
  }
};

// Volume of the bar at x <= limit: sections along z by the midpoint rule, the area of each exactly,
// as that of a polygon.
double bar_below(const TwistedBar& bar, double limit) {
  constexpr int kSections = 4000;
  double volume = 0.0;
  for (int k = 0; k < kSections; ++k) {
    const double z = ((k + 0.5) / kSections * 2.0 - 1.0) * bar.half_z;
    const double c = std::cos(bar.twist * z), s = std::sin(bar.twist * z);
    std::vector<std::array<double, 2>> kept;
    const auto corner = [&](int i) -> std::array<double, 2> {
      const double x = i == 0 || i == 3 ? -bar.half_x : bar.half_x;
      const double y = i < 2 ? -bar.half_y : bar.half_y;
      return {c * x - s * y, s * x + c * y};
    };
    for (int i = 0; i < 4; ++i) {
      const auto p = corner(i), q = corner((i + 1) % 4);
      if (p[0] <= limit) kept.push_back(p);
      if ((p[0] <= limit) != (q[0] <= limit)) {
        kept.push_back({limit, p[1] + (limit - p[0]) / (q[0] - p[0]) * (q[1] - p[1])});
      }
    }
    double twice = 0.0;
    for (std::size_t i = 0; i < kept.size(); ++i) {
      const auto &p = kept[i], &q = kept[(i + 1) % kept.size()];
      twice += p[0] * q[1] - p[1] * q[0];
    }
    volume += 0.5 * twice * 2.0 * bar.half_z / kSections;
  }
  return volume;
}

Interference octree(const Shape& a, const Shape& b, const Pose& X_AB, double tolerance,
                    int threads = 1) {
  static InterferenceWorkspace workspace;
  Interference out;
  interference(a, b, X_AB, {.tolerance = tolerance, .threads = threads}, workspace, out);
  return out;
}

// The half-space z <= height with its normal along x of the other solid.
Pose half_space_along_x(double limit) {
  Mat3 r;
  r.col(0) = Vec3::UnitY();
  r.col(1) = Vec3::UnitZ();
  r.col(2) = Vec3::UnitX();
  return {r, Vec3(limit, 0.0, 0.0)};
}

TEST(OctreeField, BallOfAUserIsTheSphere) {
  const Shape ball = smooth_ball(0.2), sphere = Sphere({.radius = 0.2}), ground = HalfSpace();
  for (const double depth : {0.02, 0.1, 0.25}) {
    const Pose X_AB{Mat3::Identity(), Vec3(0.03, 0.01, 0.2 - depth)};
    InterferenceWorkspace workspace;
    Interference exact;
    interference(ground, sphere, X_AB, {}, workspace, exact);
    const Interference out = octree(ground, ball, X_AB, 1e-2);
    EXPECT_EQ(out.engine, Engine::kOctree);
    const VolumeMetrics &m = out.total, &e = exact.total;
    EXPECT_EQ(m.status, Status::kOk);
    EXPECT_LE(m.volume_error, 1e-2 * m.volume);
    EXPECT_NEAR(m.volume, e.volume, m.volume_error);
    EXPECT_NEAR((m.centroid - e.centroid).norm(), 0.0, 1e-2 * depth);
    EXPECT_NEAR((m.area_vector - e.area_vector).norm(), 0.0, 1e-2 * e.area_vector.norm());
    EXPECT_NEAR(m.depth_moment, e.depth_moment, 3e-2 * e.depth_moment);
    EXPECT_EQ(out.sites.size(), 1u);
  }
}

TEST(OctreeField, TwoBallsOfUsersMakeTheLens) {
  InterferenceWorkspace workspace;
  Interference exact;
  const Pose X_AB{Mat3::Identity(), Vec3(0.2, 0.15, 0.1)};
  interference(Sphere({.radius = 0.2}), Sphere({.radius = 0.15}), X_AB, {}, workspace, exact);
  const VolumeMetrics m = octree(smooth_ball(0.2), smooth_ball(0.15), X_AB, 1e-2).total;
  EXPECT_EQ(m.status, Status::kOk);
  EXPECT_NEAR(m.volume, exact.total.volume, m.volume_error);
  EXPECT_LE(m.volume_error, 1e-2 * m.volume);
}

// With the slope alone the bound is wide, and certain; the volume is far better than it says.
TEST(OctreeField, SlopeAloneBoundsTheVolume) {
  InterferenceWorkspace workspace;
  Interference exact;
  const Pose X_AB{Mat3::Identity(), Vec3(0.0, 0.0, 0.05)};
  interference(HalfSpace(), Sphere({.radius = 0.2}), X_AB, {}, workspace, exact);
  const VolumeMetrics m = octree(HalfSpace(), SignedDistance(Ball{0.2}), X_AB, 1e-2).total;
  EXPECT_EQ(m.status, Status::kApproximate);
  EXPECT_NEAR(m.volume, exact.total.volume, m.volume_error);
  EXPECT_NEAR(m.volume, exact.total.volume, 1e-2 * exact.total.volume);
}

TEST(OctreeField, TwistedBarEqualsItsQuadrature) {
  const TwistedBar bar{0.05, 0.02, 0.15, 8.0};
  const Shape shape = SignedDistance(bar, {.lipschitz = bar.lipschitz()});
  for (const double limit : {-0.02, 0.01}) {
    const double truth = bar_below(bar, limit);
    const VolumeMetrics m = octree(shape, HalfSpace(), half_space_along_x(limit), 2e-2).total;
    EXPECT_NEAR(m.volume, truth, m.volume_error);
    EXPECT_NEAR(m.volume, truth, 2e-2 * truth);
    EXPECT_LT(m.volume_error, 0.5 * truth);
  }
}

// A slab with bumps, and how often it is asked.
struct Counted {
  long* calls;
  Aabb bounds() const { return {Vec3(-.3, -.2, -.1), Vec3(.3, .2, .1)}; }
  double signed_distance(const Vec3& p) const {
    ++*calls;
    const double bump = .02 * std::sin(40 * p.x()) * std::sin(30 * p.y());
    return .5 *
           std::max({std::abs(p.x()) - .28, std::abs(p.y()) - .18, std::abs(p.z() + bump) - .05});
  }
};

// Where the budget of cells is spent, V is known to tenths: columns that add up to it within a
// millionth are sought in vain, and took twenty times as long as the cells.
TEST(OctreeField, ColumnsAddUpToAVolumeAsFarAsItIsKnown) {
  for (const int cells : {3000, 10000}) {
    long calls = 0;
    Interference out;
    InterferenceWorkspace workspace;
    interference(SignedDistance(Counted{&calls}), Box({.half_sizes = {.2, .2, .1}}),
                 {Mat3::Identity(), Vec3(.1, .05, .12)}, {.tolerance = 1e-6, .most_cells = cells},
                 workspace, out);
    EXPECT_EQ(out.total.status, Status::kApproximate);
    EXPECT_LT(calls, 40 * cells);
    EXPECT_NEAR(out.total.depth, 0.05, 0.002);
    EXPECT_GT(out.total.depth_moment, 0.2 * out.total.volume * out.total.depth);
    EXPECT_LT(out.total.depth_moment, 0.5 * out.total.volume * out.total.depth);
  }
}

TEST(OctreeField, GivesTheSameBitsForAnyNumberOfThreads) {
  const TwistedBar bar{0.05, 0.02, 0.15, 8.0};
  const Shape shape = SignedDistance(bar, {.lipschitz = bar.lipschitz()});
  const VolumeMetrics one = octree(shape, HalfSpace(), half_space_along_x(0.0), 0.3, 1).total;
  for (const int threads : {2, 3, 8}) {
    const VolumeMetrics many =
        octree(shape, HalfSpace(), half_space_along_x(0.0), 0.3, threads).total;
    EXPECT_EQ(std::memcmp(&one.volume, &many.volume, sizeof(double)), 0);
    EXPECT_EQ(one.inertia, many.inertia);
    EXPECT_EQ(one.depth_moment, many.depth_moment);
  }
}

// A function without a zero, so that the bounds are the solid: the octree meets a box.
TEST(OctreeField, SolidEndsAtItsBounds) {
  struct Everywhere {
    Aabb bounds() const { return {Vec3(-0.3, -0.2, -0.1), Vec3(0.3, 0.2, 0.1)}; }
    double signed_distance(const Vec3&) const { return -1.0; }
  };
  const Shape filled = SignedDistance(Everywhere{}), ground = HalfSpace();
  const Pose X_AB{test::turn(Vec3(1.0, 2.0, 0.5), 0.4), Vec3(0.02, 0.0, -0.03)};
  InterferenceWorkspace workspace;
  Interference exact;
  interference(Box({.half_sizes = Vec3(0.3, 0.2, 0.1)}), ground, X_AB, {}, workspace, exact);
  const VolumeMetrics m = octree(filled, ground, X_AB, 1e-3).total, &e = exact.total;
  EXPECT_NEAR(m.volume, e.volume, 1e-9 * e.volume);
  EXPECT_NEAR((m.area_vector - e.area_vector).norm(), 0.0, 1e-9 * e.area_vector.norm());
  EXPECT_NEAR(m.depth, e.depth, 1e-9 * e.depth);
}

TEST(OctreeField, ContainedHasNoDirection) {
  const Interference out =
      octree(Box({.half_sizes = Vec3(0.3, 0.3, 0.3)}), smooth_ball(0.1), {}, 1e-2);
  EXPECT_EQ(out.total.status, Status::kContained);
  EXPECT_TRUE(out.total.normal().isZero(0.0));
  EXPECT_NEAR(out.total.volume, 4.0 / 3.0 * kPi * 1e-3, out.total.volume_error);
}

TEST(OctreeField, NoNumberIsAStatus) {
  struct Broken : Ball {
    double signed_distance(const Vec3& p) const {
      return p.x() > 0.05 ? std::nan("") : Ball::signed_distance(p);
    }
  };
  const Interference out = octree(HalfSpace(), SignedDistance(Broken{{0.2}}), {}, 1e-2);
  EXPECT_EQ(out.total.status, Status::kInvalid);
  EXPECT_EQ(out.total.volume, 0.0);
  EXPECT_TRUE(out.sites.empty());
}

}  // namespace
}  // namespace volcontact::octree_field_test
