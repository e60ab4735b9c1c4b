// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "volcontact/pair/surface_sweep/sweep_patch.h"

namespace volcontact {

/// Depth and depth moment of a region of an overlap, from columns along its normal that start at
/// places of its surface. `of_region(strip)`: whether a strip is of the region.
template <typename OfRegion>
class SweepDepth {
 public:
  SweepDepth(const SweepSolids& solids, const SweepSurface& surface, OfRegion& of_region,
             FaceCurveScratch& scratch, const Vec3& n, bool convex)
      : solids_(solids),
        surface_(surface),
        of_region_(of_region),
        s_(scratch),
        n_(n),
        convex_(convex) {}

  void run(const std::vector<CurveFamily>& families, const std::vector<int>& family_of,
           VolumeMetrics& metrics) {
    for (const SweepTip& tip : surface_.tips) {
      if (of_region_(tip.strip)) reach(tip.x);
    }
    // From the side that has fewer places.
    int up = 0, down = 0;
    for (const SweepPlace& place : surface_.places) {
      if (of_region_(place.strip)) ++(n_.dot(place.n) > 0.0 ? up : down);
    }
    const double side = up <= down ? 1.0 : -1.0;
    double volume = 0.0, moment = 0.0, longest = 0.0;
    Vec3 deepest = Vec3::Zero();  // in the middle of the longest column
    for (const SweepPlace& place : surface_.places) {
      const double area = side * n_.dot(place.n);
      if (!(area > 0.0) || !of_region_(place.strip)) continue;
      const double length = column(place.x, -side * n_);
      volume += length * area;
      moment += 0.5 * length * length * area;
      if (length > longest) {
        longest = length;
        deepest = place.x - 0.5 * side * length * n_;
      }
      reach(place.x);
      reach(place.x - side * length * n_);
    }
    look_at_balls(families, family_of);
    // What is neither convex nor on a plane may reach around what it lies on.
    const bool by_extent = convex_ || metrics.flatness() >= kPlanePatch;
    metrics.depth = by_extent       ? std::max(0.0, high_ - low_)
                    : longest > 0.0 ? climb(deepest, longest, metrics)
                                    : 0.0;
    metrics.depth_moment = volume > 0.0 ? moment * metrics.volume / volume : 0.0;
  }

 private:
  void reach(const Vec3& x) {
    high_ = std::max(high_, n_.dot(x));
    low_ = std::min(low_, n_.dot(x));
  }

  // How far a ray stays in the overlap.
  double column(const Vec3& x, const Vec3& d) {
    FaceCurve ray;
    ray.p = x;
    ray.u = d;
    ray.v = Vec3::Zero();
    find_spans(solids_, ray, -1, s_, spans_);
    // In a thin layer all of it may be near.
    const double near = 1e-7 * solids_.half.norm();
    double length = 0.0;
    for (int i = 0; i < spans_.count; ++i) {
      const SweepSpans::Span& span = spans_.span[i];
      if (span.low.t <= near) length = std::max(length, span.high.t);
    }
    return length;
  }

  // Columns start at a few places alone, and the longest may be at none of them: from the longest
  // of these to the sides, in smaller and smaller steps.
  double climb(Vec3 x, double longest, const VolumeMetrics& metrics) {
    const Mat3 basis = basis_with_z(n_);
    double step = kFirstStep * std::sqrt(metrics.area_vector.norm());
    const auto look = [&](const Vec3& at) {
      double from = 0.0, length = 0.0;
      if (!column_near(at, longest, from, length) || !(length > longest)) return false;
      longest = length;
      x = at + (from + 0.5 * length) * n_;
      return true;
    };
    look(metrics.centroid);
    for (int round = 0; round < kClimbs; ++round) {
      bool longer = false;
      for (const Vec3& way : {Vec3(basis.col(0)), Vec3(basis.col(1))}) {
        longer |= look(x + step * way) || look(x - step * way);
      }
      if (!longer) step *= 0.5;
    }
    return longest;
  }

  // The column of the overlap along the normal that holds x, or comes near to it.
  bool column_near(const Vec3& x, double near, double& from, double& length) {
    FaceCurve line;
    line.p = x;
    line.u = n_;
    line.v = Vec3::Zero();
    find_spans(solids_, line, -1, s_, spans_);
    for (int i = 0; i < spans_.count; ++i) {
      const SweepSpans::Span& span = spans_.span[i];
      if (!(span.low.t <= near && span.high.t >= -near)) continue;
      from = span.low.t;
      length = span.high.t - span.low.t;
      return true;
    }
    return false;
  }

  // The farthest places of balls, which no curve need come by.
  void look_at_balls(const std::vector<CurveFamily>& families, const std::vector<int>& family_of) {
    for (std::size_t f = 0; f < family_of.size(); ++f) {
      const SweepFace& face = solids_.faces[f];
      if (family_of[f] < 0 || face.kind != SweepFace::Kind::kBall) continue;
      const CurveFamily& family = families[static_cast<std::size_t>(family_of[f])];
      const Mat3 inverse = face.round.map.inverse();
      for (const double side : {1.0, -1.0}) {
        const Vec3 x = face.round.center + inverse * (side * inverse.transpose() * n_).normalized();
        double u, t;
        family.locate(x, u, t);
        if (!(u > family.low() && u < family.high())) continue;
        find_spans(solids_, family.curve(u), static_cast<int>(f), s_, spans_);
        for (int i = 0; i < spans_.count; ++i) {
          const SweepSpans::Span& span = spans_.span[i];
          const double at = t < 0.0 ? t + 2.0 * kPi : t;
          // Of another region only if it lies beyond all of this one.
          if (at >= span.low.t && at <= span.high.t && of_height(n_.dot(x))) reach(x);
        }
      }
    }
  }
  bool of_height(double height) const {
    const double depth = high_ - low_;
    return height < high_ + depth && height > low_ - depth;
  }

  const SweepSolids& solids_;
  const SweepSurface& surface_;
  OfRegion& of_region_;
  FaceCurveScratch& s_;
  const Vec3 n_;
  const bool convex_;                                // both solids
  static constexpr double kPlanePatch = 1.0 - 1e-9;  // flatness of a patch on a plane
  static constexpr double kFirstStep = 0.25;         // of the width of a region
  static constexpr int kClimbs = 10;
  SweepSpans spans_;
  double high_ = -kInfinity, low_ = kInfinity;
};

template <typename OfRegion>
void add_sweep_depth(const SweepSolids& solids, const std::vector<CurveFamily>& families,
                     const std::vector<int>& family_of, const SweepSurface& surface,
                     OfRegion&& of_region, FaceCurveScratch& scratch, bool convex,
                     VolumeMetrics& metrics) {
  const Vec3 n = metrics.normal();
  if (n.isZero(0.0)) return;
  SweepDepth<std::remove_reference_t<OfRegion>>(solids, surface, of_region, scratch, n, convex)
      .run(families, family_of, metrics);
}

}  // namespace volcontact
