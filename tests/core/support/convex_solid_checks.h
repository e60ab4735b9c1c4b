// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "core/support/random.h"
#include "volcontact/shape/pieces.h"
#include "volcontact/shape/solid.h"

namespace volcontact::test {

// Properties that tie the functions of a bounded convex solid to each other and to brute force.
// `surface` is a list of points of its surface, made by the caller from a parametrisation, and
// `spacing` bounds how far any point of the surface is from the nearest of them.

/// No point of the surface is higher along e than support_height, and the support point is that
/// high.
template <typename S>
void check_support(const S& solid, const std::vector<Vec3>& surface, double spacing) {
  Random random(11);
  for (int i = 0; i < 200; ++i) {
    const Vec3 e = random.log_uniform(0.1, 10.0) * random.direction();
    double highest = -kInfinity;
    for (const Vec3& p : surface) highest = std::max(highest, e.dot(p));
    const double height = solid.support_height(e);
    EXPECT_GE(height, highest - 1e-12 * e.norm());
    EXPECT_LE(height, highest + spacing * e.norm());
    EXPECT_NEAR(e.dot(solid.support(e)), height, 1e-12 * e.norm());
  }
}

/// The bounds are those of the surface.
template <typename S>
void check_bounds(const S& solid, const std::vector<Vec3>& surface, double spacing) {
  Vec3 low = Vec3::Constant(kInfinity), high = -low;
  for (const Vec3& p : surface) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Aabb bounds = solid.bounds();
  for (int k = 0; k < 3; ++k) {
    EXPECT_LE(bounds.min[k], low[k] + 1e-12);
    EXPECT_GE(bounds.min[k], low[k] - spacing);
    EXPECT_GE(bounds.max[k], high[k] - 1e-12);
    EXPECT_LE(bounds.max[k], high[k] + spacing);
  }
}

/// |signed_distance| is the distance to the nearest point of the surface. Both signs occur.
template <typename S>
void check_distance(const S& solid, const std::vector<Vec3>& surface, double spacing,
                    double half_range) {
  Random random(12);
  int inside = 0;
  constexpr int kPoints = 200;
  for (int i = 0; i < kPoints; ++i) {
    const Vec3 p = random.in_box(half_range);
    double nearest = kInfinity;
    for (const Vec3& q : surface) nearest = std::min(nearest, (p - q).norm());
    const double distance = solid.signed_distance(p);
    EXPECT_LE(std::abs(distance), nearest + 1e-12) << p;
    EXPECT_GE(std::abs(distance), nearest - spacing) << p;
    if (distance < 0.0) ++inside;
  }
  EXPECT_GT(inside, kPoints / 50);
  EXPECT_LT(inside, kPoints);
}

/// The gradient is that of signed_distance, by central differences, away from its kinks.
template <typename S>
void check_gradient(const S& solid, double half_range) {
  Random random(13);
  constexpr double kStep = 1e-6;
  int smooth = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = random.in_box(half_range), g = solid.gradient(p);
    EXPECT_NEAR(g.norm(), 1.0, 1e-12);
    Vec3 difference, second;
    for (int k = 0; k < 3; ++k) {
      const double above = solid.signed_distance(p + kStep * Vec3::Unit(k));
      const double below = solid.signed_distance(p - kStep * Vec3::Unit(k));
      difference[k] = (above - below) / (2.0 * kStep);
      second[k] = above + below - 2.0 * solid.signed_distance(p);
    }
    if (second.cwiseAbs().maxCoeff() > 1e-9) continue;
    ++smooth;
    EXPECT_LT((g - difference).norm(), 1e-6) << p;
  }
  EXPECT_GT(smooth, 400);
}

/// Points of a line are inside exactly between the ends of its interval, whatever the length of the
/// direction and the place of the origin on the line.
template <typename S>
void check_ray(const S& solid, double half_range) {
  Random random(14);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 o = random.in_box(half_range), d = random.log_uniform(0.1, 10) * random.direction();
    const RayInterval span = solid.ray(o, d);
    if (!span.empty()) {
      ++hits;
      EXPECT_NEAR(solid.signed_distance(o + span.enter * d), 0.0, 1e-12);
      EXPECT_NEAR(solid.signed_distance(o + span.leave * d), 0.0, 1e-12);
      EXPECT_LT(solid.signed_distance(o + 0.5 * (span.enter + span.leave) * d), 0.0);
      const RayInterval shifted = solid.ray(o + 7.0 * d, d);
      EXPECT_NEAR(shifted.enter + 7.0, span.enter, 1e-7);
      EXPECT_NEAR(shifted.leave + 7.0, span.leave, 1e-7);
    }
    for (int k = 0; k < 10; ++k) {
      const double t = random.uniform(-4.0, 4.0) * half_range / d.norm();
      const double distance = solid.signed_distance(o + t * d);
      if (std::abs(distance) < 1e-9) continue;
      EXPECT_EQ(t > span.enter && t < span.leave, distance < 0.0);
    }
  }
  EXPECT_GT(hits, 100);
}

/// Volume, centroid and inertia against columns along z through a fine grid (an independent
/// integral; `tolerance` covers its error, relative).
template <typename S>
void check_own_metrics(const S& solid, double tolerance) {
  constexpr int kLines = 800;
  const Aabb box = solid.bounds();
  const Vec3 size = box.max - box.min;
  MomentSum sum;
  for (int i = 0; i < kLines; ++i) {
    for (int j = 0; j < kLines; ++j) {
      const Vec3 o(box.min.x() + (i + 0.5) * size.x() / kLines,
                   box.min.y() + (j + 0.5) * size.y() / kLines, 0.0);
      const RayInterval span = solid.ray(o, Vec3::UnitZ());
      if (span.empty()) continue;
      const double length = span.leave - span.enter;
      const double weight = length * size.x() * size.y() / (1.0 * kLines * kLines);
      const Vec3 x = o + 0.5 * (span.enter + span.leave) * Vec3::UnitZ();
      sum.volume += weight;
      sum.first += weight * x;
      sum.second += weight * outer(x, x);
      sum.second(2, 2) += weight * length * length / 12.0;
    }
  }
  const VolumeMetrics wanted = sum.metrics(), own = solid.own_metrics();
  EXPECT_NEAR(own.volume, wanted.volume, tolerance * wanted.volume);
  EXPECT_LT((own.centroid - wanted.centroid).norm(), tolerance * size.norm());
  EXPECT_LT((own.inertia - wanted.inertia).norm(), tolerance * wanted.inertia.norm());
  EXPECT_EQ(own.status, Status::kOk);
}

/// The faces of the pieces describe the same set: a point is inside exactly when it lies in a
/// piece.
template <typename S>
void check_pieces(const S& solid, double half_range) {
  PieceList list;
  solid.pieces(list);
  Random random(15);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = random.in_box(half_range);
    if (std::abs(solid.signed_distance(p)) < 1e-12) continue;
    bool inside = false;
    for (int k = 0; k < list.size(); ++k) {
      bool in_piece = true;
      for (const Quadric* face = list.begin(k); face != list.end(k); ++face) {
        in_piece &= (*face)(p) <= 0.0;
      }
      inside |= in_piece;
    }
    EXPECT_EQ(inside, solid.signed_distance(p) < 0.0) << p;
  }
}

}  // namespace volcontact::test
