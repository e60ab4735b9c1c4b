// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/octree/cell_cut.h"

#include <algorithm>
#include <limits>
#include <span>

#include "volcontact/pair/octree/cell_math.h"

namespace volcontact {

using namespace cell_math;

namespace {

constexpr double kMuch = 0.02;  // of a polygon's width: further and its surroundings matter

// Smaller root t >= 0 of f = slope t - 1/2 curvature t^2; infinite where there is none.
double first_root(double f, double slope, double curvature) {
  const double square = slope * slope - 2.0 * curvature * f;
  if (!(square >= 0.0 && slope > 0.0)) return kInfinity;
  return 2.0 * f / (slope + std::sqrt(square));
}

}  // namespace

const CellCut::Tangent* CellCut::tangent_of(const FaceLoop& loop) const {
  return loop.face < kFirstFace ? nullptr : &tangents_[loop.face - kFirstFace];
}

bool CellCut::looks_along(const Tangent& t, const Vec3& e) {
  return t.bend != Bend::kFlat || t.slope.dot(e) > 0.0;
}

// A tangent plane's unit normal n, with H n and n . H n.
struct CellCut::Normal {
  const Tangent& tangent;
  Vec3 n;
  Vec3 bent = Vec3::Zero();
  double along = 0.0;
  double steep;

  explicit Normal(const Tangent& t) : tangent(t), steep(t.slope.norm()) {
    n = t.slope / steep;
    if (t.bend == Bend::kFlat) return;
    bent = t.hessian * n;
    along = n.dot(bent);
  }
};

// Where x, a point of the tangent plane, meets the face along the plane's normal: how deep, and the
// outward direction there, of unit length along that normal.
struct CellCut::Foot {
  double depth = 0.0;
  Vec3 outward;

  Foot(const Normal& normal, const Vec3& x) : outward(normal.n) {
    const Tangent& t = normal.tangent;
    if (t.bend == Bend::kFlat) return;
    const Vec3 d = x - t.touch;
    const Vec3 bent = t.hessian * d;
    const double bend = 0.5 * d.dot(bent);
    const double rise = normal.steep + bent.dot(normal.n);
    if (!(rise > kSteepEnough * normal.steep)) {
      depth = bend / normal.steep;
      return;
    }
    // The root of bend = rise depth - 1/2 along depth^2, to second order.
    const double first = bend / rise;
    depth = first * (1.0 + 0.5 * normal.along * first / rise);
    const double facing = rise - depth * normal.along;
    if (facing > kSteepEnough * normal.steep) {
      outward = (t.slope + bent - depth * normal.bent) / facing;
    }
  }
};

void CellCut::add_surfaces(CellSums& sums) {
  between_.assign(tangents_.size(), Moments{});
  for (const FaceLoop& loop : loops_) {
    const Tangent* tangent = tangent_of(loop);
    if (!tangent || tangent->seam) continue;
    sample_surface(*tangent, loop, 0, false);
    CellSums::Surface& surface = sums.surface[tangent->owner];
    for (const SurfacePoint& point : sample_) {
      surface.area_vector += point.element;
      surface.moment += point.position.cross(point.element);
      surface.area += point.sign * point.element.norm();
    }
    between_[loop.face - kFirstFace] = gap_sample_;
  }
}

// The part of a face in the cell: its tangent plane's polygon, taken to the face along the plane's
// normal, and what the polygon's edges are off by.
void CellCut::sample_surface(const Tangent& tangent, const FaceLoop& loop, int levels, bool fine) {
  sample_.clear();
  gap_sample_ = Moments{};
  const Normal normal(tangent);
  const auto points = polytope_.points();
  const int* index = polytope_.loop_vertices().data() + loop.first;
  const Vec3& p = points[index[0]];
  double area = 0.0;
  for (int i = 2; i < loop.count; ++i) {
    const Vec3 &q = points[index[i - 1]], &r = points[index[i]];
    area += 0.5 * (q - p).cross(r - p).dot(normal.n);
    sample_triangle(normal, p, q, r, levels, fine);
  }
  if (all_flat_) return;
  for (int i = 0; i < loop.count; ++i) {
    sample_edge(normal, points[index[i]], points[index[i + 1 < loop.count ? i + 1 : 0]],
                polytope_.face_across(loop.first + i), area);
  }
}

// Three inner points are exact for quadratic functions, six for quartic ones (Dunavant, 1985).
void CellCut::sample_triangle(const Normal& normal, const Vec3& p, const Vec3& q, const Vec3& r,
                              int levels, bool fine) {
  if (levels > 0) {
    const Vec3 pq = 0.5 * (p + q), qr = 0.5 * (q + r), rp = 0.5 * (r + p);
    sample_triangle(normal, p, pq, rp, levels - 1, fine);
    sample_triangle(normal, pq, q, qr, levels - 1, fine);
    sample_triangle(normal, rp, qr, r, levels - 1, fine);
    sample_triangle(normal, pq, qr, rp, levels - 1, fine);
    return;
  }
  struct Orbit {
    double corner, others, weight;
  };
  static constexpr Orbit kThree[] = {{2.0 / 3.0, 1.0 / 6.0, 1.0 / 3.0}};
  static constexpr Orbit kSix[] = {{0.108103018168070, 0.445948490915965, 0.223381589678011},
                                   {0.816847572980459, 0.091576213509771, 0.109951743655322}};
  const double area = 0.5 * (q - p).cross(r - p).dot(normal.n);
  const Vec3 sum = p + q + r;
  for (const Orbit& orbit : fine ? std::span<const Orbit>(kSix) : std::span<const Orbit>(kThree)) {
    for (const Vec3* corner : {&p, &q, &r}) {
      sample_point(normal, orbit.others * sum + (orbit.corner - orbit.others) * *corner,
                   orbit.weight * area);
    }
  }
}

void CellCut::sample_point(const Normal& normal, const Vec3& x, double weight) {
  const Foot foot(normal, x);
  sample_.push_back({x - foot.depth * normal.n, weight * foot.outward, 1.0});
  if (foot.depth == 0.0) return;
  const Vec3 middle = x - 0.5 * foot.depth * normal.n;
  const double volume = weight * foot.depth;
  gap_sample_.volume += volume;
  gap_sample_.first += volume * middle;
  gap_sample_.second += outer(volume * middle, middle);
}

// How far x can go in the tangent plane along the unit vector `outward` before it leaves the cell
// or another tangent plane than the one across the edge.
double CellCut::room(const Normal& normal, const Vec3& x, const Vec3& outward, int across) const {
  double way = kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    const int side = cell_side(axis, outward[axis] > 0.0);
    if (side != across && outward[axis] != 0.0) {
      way = std::min(way, half_[axis] / std::abs(outward[axis]) - x[axis] / outward[axis]);
    }
  }
  for (std::size_t j = 0; j < tangents_.size(); ++j) {
    const Tangent& t = tangents_[j];
    const double rise = t.slope.dot(outward);
    if (&t == &normal.tangent || static_cast<int>(j) + kFirstFace == across) continue;
    if (rise > 0.0) way = std::min(way, -t.plane(x) / rise);
  }
  return std::max(0.0, way);
}

// The edge p q of two tangent planes lies `off` outside the edge of the two faces, across the edge
// along the first plane. The strip between is taken off, by two Gauss points.
void CellCut::sample_edge(const Normal& normal, const Vec3& p, const Vec3& q, int across,
                          double area) {
  const Tangent* other = across < kFirstFace ? nullptr : &tangents_[across - kFirstFace];
  const bool other_flat = !other || other->bend == Bend::kFlat;
  if (normal.tangent.bend == Bend::kFlat && other_flat) return;
  Vec3 outward = (q - p).cross(normal.n);
  const double length = outward.norm();
  if (!(length > 0.0)) return;
  outward /= length;
  const double width = area / length;
  constexpr double kGauss = 0.21132486540518712;
  for (const double along : {kGauss, 1.0 - kGauss}) {
    const Vec3 x = p + along * (q - p);
    const Foot foot(normal, x);
    Vec3 slope = other ? other->slope : cell_side_normal(across);
    double bend = 0.0;
    if (!other_flat) {
      const Vec3 d = x - other->touch;
      const Vec3 bent = other->hessian * d;
      slope += bent;
      bend = 0.5 * d.dot(bent);
    }
    const double rise = slope.dot(outward);
    if (!(rise > 0.0)) continue;
    double off = std::min((bend - foot.depth * slope.dot(normal.n)) / rise, width);
    if (off < -kMuch * width) off = std::max(off, -room(normal, x, outward, across));
    const double weight = -0.5 * length * off;
    const Vec3 at = x - foot.depth * normal.n - 0.5 * off * outward;
    sample_.push_back({at, weight * foot.outward, std::copysign(1.0, weight)});
  }
}

// Moves the corner against e until it lies within all faces. False when it never does, or not
// within the cell.
bool CellCut::draw_back(const Vec3& half, const Vec3& e, Vec3& corner) const {
  double excess = 0.0;
  for (const Tangent& t : tangents_) {
    const double value = t.plane(corner) + t.bend_at(corner);
    if (!(value > 0.0) || t.on_face(corner)) continue;
    const Vec3 bent = t.hessian * e;
    const double rise = t.slope.dot(e) + bent.dot(corner - t.touch);
    excess = std::max(excess, first_root(value, rise, e.dot(bent)));
  }
  if (excess == 0.0) return true;
  if (!std::isfinite(excess)) return false;
  corner -= excess * e;
  return (corner.cwiseAbs() - half).maxCoeff() <= 1e-9 * half.norm() &&
         std::all_of(tangents_.begin(), tangents_.end(), [&](const Tangent& t) {
           return t.plane(corner) + t.bend_at(corner) <= 0.0 || t.on_face(corner);
         });
}

}  // namespace volcontact
