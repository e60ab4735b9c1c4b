// SPDX-License-Identifier: Apache-2.0
#pragma once

// A half-space below the plane z = 0 needs no graph: each face of the solid is cut on its own. Two
// faces cut their common edge by the same operations, so that the surface stays closed bit for bit,
// and the lid on the plane is known by its edges. Seen from the deepest corner the faces that meet
// there have no flux. Part of clip.cc.
#include <algorithm>
#include <span>
#include <vector>

#include "volcontact/pair/quadrature/region_sum.h"

namespace volcontact::clipping {

// The point of an edge on the plane; `below` and `above` are its ends, in this order in both faces.
inline Vec3 on_plane(const Vec3& below, const Vec3& above) {
  const double t = below.z() / (below.z() - above.z());
  Vec3 p = below + t * (above - below);
  p.z() = 0.0;
  return p;
}

// The part of a face at z <= 0, and where its boundary dips below the plane and comes up again.
struct FacePart {
  int count;
  const Vec3 *dip, *rise;
};

// Without branches on the heights: no processor could predict them.
inline FacePart cut_face(std::span<const int> loop, std::span<const Vec3> corners, Vec3* part) {
  Vec3* end = part;
  FacePart result{0, part, part};
  const Vec3* last = &corners[loop.back()];
  for (int index : loop) {
    const Vec3* p = &corners[index];
    const bool last_is_above = last->z() > 0.0, is_above = p->z() > 0.0;
    *end = on_plane(last_is_above ? *p : *last, last_is_above ? *last : *p);
    result.dip = last_is_above && !is_above ? end : result.dip;
    result.rise = !last_is_above && is_above ? end : result.rise;
    end += last_is_above != is_above;
    *end = *p;
    end += !is_above;
    last = p;
  }
  result.count = static_cast<int>(end - part);
  return result;
}

// What closes the part below the plane, from its edges in any order.
class Lid {
 public:
  // An edge that runs counterclockwise seen from above.
  void add_edge(const Vec3& from, const Vec3& to) {
    if (!started_) {
      apex_ = from;
      started_ = true;
    }
    const double x = from.x() - apex_.x(), y = from.y() - apex_.y();
    const double u = to.x() - apex_.x(), v = to.y() - apex_.y();
    const double w = x * v - y * u, s = x + u, t = y + v;
    area2_ += w;
    x_ += w * s;
    y_ += w * t;
    xx_ += w * (s * s + x * x + u * u);
    xy_ += w * (s * t + x * y + u * v);
    yy_ += w * (t * t + y * y + v * v);
  }

  double area() const { return std::max(0.0, 0.5 * area2_); }
  // int x dS, from the middle axis through `origin`.
  Vec2 first(const Vec3& origin) const {
    return {area() * (apex_.x() - origin.x()) + x_ / 6.0,
            area() * (apex_.y() - origin.y()) + y_ / 6.0};
  }
  // Adds its fluxes.
  void add_to(RegionSum& sum) const {
    const double depth = -sum.origin.z(), a = apex_.x() - sum.origin.x(),
                 b = apex_.y() - sum.origin.y(), dx = x_ / 6.0, dy = y_ / 6.0;
    const double x = area() * a + dx, y = area() * b + dy;
    sum.volume += depth / 3.0 * area();
    sum.first += depth / 4.0 * Vec3(x, y, area() * depth);
    sum.xx += depth / 5.0 * (a * (x + dx) + xx_ / 24.0);
    sum.xy += depth / 5.0 * (a * y + b * dx + xy_ / 24.0);
    sum.yy += depth / 5.0 * (b * (y + dy) + yy_ / 24.0);
    sum.xz += depth / 5.0 * (x * depth);
    sum.yz += depth / 5.0 * (y * depth);
    sum.zz += depth / 5.0 * (area() * depth * depth);
  }

 private:
  bool started_ = false;
  Vec3 apex_;
  double area2_ = 0.0, x_ = 0.0, y_ = 0.0, xx_ = 0.0, xy_ = 0.0, yy_ = 0.0;
};

template <typename PointAt>
double area_of(int count, PointAt&& point, const Vec3& normal) {
  const Vec3& a = point(0);
  Vec3 sum = Vec3::Zero(), to_b = point(1) - a;
  for (int i = 2; i < count; ++i) {
    const Vec3 to_c = point(i) - a;
    sum += to_b.cross(to_c);
    to_b = to_c;
  }
  return 0.5 * normal.dot(sum);
}

// Metrics of the part below z = 0 of a solid with these corners and faces, moved by `shift`.
template <typename Loop, typename Normal>
VolumeMetrics measure_below(std::span<const Vec3> corners, int faces, Loop&& loop, Normal&& normal,
                            double rounding, const Vec3& shift, std::vector<Vec3>& part) {
  RegionSum sum;
  Lid lid;
  for (const Vec3& p : corners) {
    if (p.z() < sum.origin.z()) sum.origin = p;
  }
  if (part.size() < 2 * corners.size()) part.resize(2 * corners.size());
  for (int f = 0; f < faces; ++f) {
    const std::span<const int> around = loop(f);
    const auto above =
        std::count_if(around.begin(), around.end(), [&](int i) { return corners[i].z() > 0.0; });
    const auto sides = static_cast<std::ptrdiff_t>(around.size());
    if (above == sides) continue;
    const Vec3 n = normal(f);
    const auto add = [&](int count, auto&& point) {
      const bool has_flux = std::abs(n.dot(point(0) - sum.origin)) > rounding;
      sum.counter_area +=
          has_flux ? sum.add_face(count, point, n, rounding).area : area_of(count, point, n);
    };
    if (above == 0) {
      add(static_cast<int>(sides), [&](int i) -> const Vec3& { return corners[around[i]]; });
      continue;
    }
    const FacePart below = cut_face(around, corners, part.data());
    lid.add_edge(*below.dip, *below.rise);
    if (below.count > 2) add(below.count, [&](int i) -> const Vec3& { return part[i]; });
  }
  lid.add_to(sum);
  sum.area = lid.area();
  if (!(sum.volume > sum.volume_error(rounding))) return sum.none(rounding);
  VolumeMetrics m = sum.metrics(rounding);
  const Vec3 moved = shift + sum.origin;
  m.depth_moment = std::max(0.0, -(m.centroid.z() + sum.origin.z()) * m.volume);
  m.centroid += moved;
  m.area_vector = Vec3(0.0, 0.0, sum.area);
  const Vec2 first = lid.first(-shift);
  m.area_moment = Vec3(first.y(), -first.x(), 0.0);
  m.depth = -sum.origin.z();
  return m;
}

}  // namespace volcontact::clipping
