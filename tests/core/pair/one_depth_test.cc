// SPDX-License-Identifier: Apache-2.0

// The depth means the same in every engine: the longest column of the overlap along its normal.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/support/csg_solids.h"
#include "core/support/evaluated.h"
#include "core/support/meshes.h"
#include "core/support/sanitized.h"

namespace volcontact::one_depth_test {
namespace {

using test::evaluated;
using test::mesh_of;
using test::Soup;
namespace solids = volcontact::testing;

// A peg over a hole of radius kHole whose edge is a chamfer of 45 degrees from kCorner to kTop.
constexpr double kHole = 0.005, kCorner = 0.008, kTop = 0.01, kPeg = 0.00495, kHalfPeg = 0.01;

bool in_block(const Vec3& x) {
  const double r = std::hypot(x.x(), x.y()), z = x.z();
  const bool in_hole = r < kHole || (z > kCorner && r < kHole + z - kCorner);
  return z < kTop && z > -kTop && !in_hole;
}
bool in_peg(const Vec3& x) { return std::hypot(x.x(), x.y()) < kPeg && std::abs(x.z()) < kHalfPeg; }

// The longest column along n of what lies in both, found by points on lines `from` a middle.
double longest_column(const Pose& X, const Vec3& middle, const Vec3& n) {
  constexpr int kLines = 60, kPoints = 400;
  constexpr double kReach = 0.004;
  const Mat3 basis = basis_with_z(n);
  const Pose X_PW = X.inverse();
  double longest = 0.0;
  for (int i = -kLines; i <= kLines; ++i) {
    for (int j = -kLines; j <= kLines; ++j) {
      int here = 0;
      for (int k = -kPoints; k <= kPoints; ++k) {
        const Vec3 x = middle + kReach * (i * basis.col(0) + j * basis.col(1)) / kLines +
                       0.5 * kReach * k / kPoints * n;
        here = in_block(x) && in_peg(X_PW * x) ? here + 1 : 0;
        longest = std::max(longest, here * 0.5 * kReach / kPoints);
      }
    }
  }
  return longest;
}

Soup prism(double radius, double half_length, int n) {
  Soup soup;
  for (const double side : {-1.0, 1.0}) {
    for (int i = 0; i < n; ++i) {
      const double angle = 2.0 * kPi * i / n;
      soup.vertices.push_back(
          {radius * std::cos(angle), radius * std::sin(angle), side * half_length});
    }
  }
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    soup.triangles.push_back({i, j, j + n});
    soup.triangles.push_back({i, j + n, i + n});
  }
  soup.vertices.push_back({0, 0, -half_length});
  soup.vertices.push_back({0, 0, half_length});
  for (int i = 0; i < n; ++i) {
    const int j = (i + 1) % n;
    soup.triangles.push_back({2 * n, j, i});
    soup.triangles.push_back({2 * n + 1, n + i, n + j});
  }
  return soup;
}

TEST(OneDepth, APegAtTheEdgeOfAChamferedHole) {
  const Csg block = solids::box(.02, .02, kTop) - solids::tube(kHole, .05) -
                    solids::cone(kHole, .007, .001, solids::at(0, 0, .009));
  const Cylinder peg({.radius = kPeg, .half_length = kHalfPeg});
  const Mesh mesh = mesh_of(prism(kPeg, kHalfPeg, 256));
  for (const double tilt : {0.0, 0.02}) {
    if (test::kSanitized && tilt == 0.0) continue;
    for (const double low : {.0078, .0079, .00799, .0082, .0086}) {
      if (test::kSanitized && low != .0079) continue;
      for (const double aside : {.0003, .001}) {
        if (low - kCorner > 0.8 * aside) continue;
        const Mat3 turn = rotation_about(Vec3::UnitY(), tilt);
        const Pose X{turn, Vec3(aside, 0, low) + turn * Vec3(0, 0, kHalfPeg)};
        const VolumeMetrics octree = evaluated(block, peg, X, Engine::kOctree).total;
        const double expected = longest_column(X, octree.centroid, octree.normal());
        for (const Engine engine :
             {Engine::kAuto, Engine::kLines, Engine::kSurfaceSweep, Engine::kOctree}) {
          const Interference out = evaluated(block, peg, X, engine);
          const double depth = out.total.depth / expected;
          // The sweep climbs from the longest of few columns, and may stop short of the longest.
          EXPECT_GT(depth, engine == Engine::kSurfaceSweep ? 0.5 : 0.6)
              << to_string(out.engine) << " " << tilt << low << aside;
          EXPECT_LT(depth, 1.25) << to_string(out.engine) << " " << tilt << low << aside;
        }
        const Interference out = evaluated(block, mesh, X);
        EXPECT_EQ(out.engine, Engine::kColumns);
        EXPECT_GT(out.total.depth / expected, 0.55) << "mesh " << tilt << low << aside;
        EXPECT_LT(out.total.depth / expected, 1.25) << "mesh " << tilt << low << aside;
      }
    }
  }
}

}  // namespace
}  // namespace volcontact::one_depth_test
