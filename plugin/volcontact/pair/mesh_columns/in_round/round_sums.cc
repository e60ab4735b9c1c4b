// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/in_round/round_sums.h"

#include <cmath>

#include "volcontact/base/fields.h"
#include "volcontact/pair/quadrature/triangle_rule.h"

namespace volcontact {
namespace {

using namespace triangle_rule;

constexpr double kOffArc = 1e-6;         // of the way from the arc to the chord
constexpr double kLeastSquare = 1e-300;  // of a direction mapped
constexpr double kLeastCosine = 1e-3;
constexpr double kSteep = 0.9;          // cosine between columns and the normal where they end
constexpr double kUpright = 0.1;        // the same at an arc: columns begin there with a steep rise
constexpr double kUprightLength = 0.1;  // of a column at the arc, by that at the chord
// The share of kSliverShare where what is integrated falls with the root of the way to the arc.
constexpr double kRootShare = 0.1875 * kPi;
constexpr double kLooksUp = 1e-6;  // sine of a surface's slope
constexpr int kNewtonSteps = 4;

struct RoundDirection {
  double up[3];
  double mapped[3], square;         // the way down, mapped, and its square
  double across[3], across_square;  // the same without what runs along the axis of a capsule
  double along = 0.0;               // ... which is this
  double speed[2];                  // towards the planes
  double longest;                   // any number above the longest column
};

RoundDirection direction_of(const RoundSolid& s, const Vec3& up) {
  RoundDirection d;
  for (int i = 0; i < 3; ++i) {
    d.up[i] = up[i];
    d.along -= s.axis[i] * up[i];
  }
  const double sign = s.cone ? -1.0 : 1.0;
  for (int i = 0; i < 3; ++i) {
    d.mapped[i] = d.across[i] = 0.0;
    for (int j = 0; j < 3; ++j) {
      d.mapped[i] -= s.map[i][j] * up[j];
      d.across[i] -= s.map[i][j] * (up[j] + d.along * s.axis[j]);
    }
  }
  const double* e = d.mapped;
  d.square = e[0] * e[0] + e[1] * e[1] + sign * (e[2] * e[2]);
  e = d.across;
  d.across_square = e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
  d.longest = 0.0;
  for (int k = 0; k < s.plane_count; ++k) {
    d.speed[k] = 0.0;
    for (int i = 0; i < 3; ++i) d.speed[k] -= s.normal[k][i] * up[i];
    d.longest += std::abs(s.offset[k]);
  }
  // Between two planes a line may run along a tube for long.
  d.longest = 1e6 * (d.longest + s.size + s.half_length);
  return d;
}

}  // namespace
}  // namespace volcontact

#define VOLCONTACT_SIMD_KERNEL "volcontact/pair/mesh_columns/in_round/round_sums_kernel.inc"
#include "volcontact/base/simd_paths.inc"
#undef VOLCONTACT_SIMD_KERNEL

namespace volcontact {

void RoundTriangles::resize(std::size_t count) {
  for (auto& of_corner : corner) {
    for (auto& values : of_corner) values.assign(count, 0.0);
  }
  doubt.assign(count, 0.0);
  longest.assign(count, 0.0);
  steep.assign(count, 0.0);
}

void RoundTriangles::set(std::size_t i, const Vec3& a, const Vec3& b, const Vec3& c) {
  for (int k = 0; k < 3; ++k) {
    corner[0][k][i] = a[k];
    corner[1][k][i] = b[k];
    corner[2][k][i] = c[k];
  }
}

void RoundPoints::resize(std::size_t count) {
  for (int k = 0; k < 3; ++k) {
    middle[k].assign(count, 0.0);
    tip[k].assign(count, 0.0);
    area_vector[k].assign(count, 0.0);
  }
  tip_depth.assign(count, 0.0);
}

RoundSum sum_round_columns(const RoundSolid& solid, const Vec3& up, RoundTriangles& triangles,
                           RoundPoints& points, SimdPath path) {
  const RoundDirection d = direction_of(solid, up);
  RoundSum sum = VOLCONTACT_SIMD_CALL(path, sum_round_columns_wide, solid, d, triangles, points);
  for (const double doubt : triangles.doubt) sum.doubt += doubt;
  return sum;
}

}  // namespace volcontact
