// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/column_energy.h"

#include <algorithm>

namespace volcontact {
namespace {

using Point = Eigen::Vector2d;
using Polygon = std::vector<Point>;

// The part of a convex polygon where side(u, v) <= 0.
void clip(std::span<const Point> polygon, const HeightPlane& side, Polygon& out) {
  out.clear();
  if (polygon.empty()) return;
  Point last = polygon.back();
  double last_side = side(last.x(), last.y());
  for (const Point& p : polygon) {
    const double p_side = side(p.x(), p.y());
    if ((last_side > 0.0) != (p_side > 0.0)) {
      out.push_back(last + last_side / (last_side - p_side) * (p - last));
    }
    if (!(p_side > 0.0)) out.push_back(p);
    last = p;
    last_side = p_side;
  }
}

// int (a b) over the polygon, of two linear functions clamped to be >= 0.
double integrate_product(std::span<const Point> polygon, const HeightPlane& a,
                         const HeightPlane& b) {
  double sum = 0.0;
  if (polygon.size() < 3) return sum;
  const auto value = [](const HeightPlane& f, const Point& p) {
    return std::max(0.0, f(p.x(), p.y()));
  };
  const Point origin = polygon[0];
  const double a_0 = value(a, origin), b_0 = value(b, origin);
  Point p = polygon[1] - origin;
  double a_1 = value(a, polygon[1]), b_1 = value(b, polygon[1]);
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    const Point q = polygon[i] - origin;
    const double a_2 = value(a, polygon[i]), b_2 = value(b, polygon[i]);
    const double twice_area = p.x() * q.y() - p.y() * q.x();
    sum += twice_area * ((a_0 + a_1 + a_2) * (b_0 + b_1 + b_2) + a_0 * b_0 + a_1 * b_1 + a_2 * b_2);
    p = q;
    a_1 = a_2;
    b_1 = b_2;
  }
  return sum / 24.0;
}

// int (length * reach) over the cell, where the reach is the least of planes[j] - height (sign = 1)
// or of height - planes[j] (sign = -1).
double overhang_energy(std::span<const Point> cell, const HeightPlane& length,
                       const HeightPlane& height, std::span<const HeightPlane> planes, double sign,
                       Polygon (&work)[3]) {
  const auto difference = [&](const HeightPlane& a, const HeightPlane& b) {
    return sign > 0.0 ? a - b : b - a;
  };
  double sum = 0.0;
  for (std::size_t j = 0; j < planes.size(); ++j) {
    work[1].assign(cell.begin(), cell.end());
    for (std::size_t i = 0; i < planes.size() && !work[1].empty(); ++i) {
      if (i == j) continue;
      clip(work[1], difference(planes[j], planes[i]), work[2]);
      std::swap(work[1], work[2]);
    }
    sum += integrate_product(work[1], length, difference(planes[j], height));
  }
  return sum;
}

// The part of an upper face's outline over which `bottom` is the lowest face. Cut by the planes'
// heights and not by the faces' edges: the cells of all lower faces then tile the outline, however
// short and noisy the edges are.
void cell_over(const ColumnFace& bottom, std::span<const ColumnFace> lower,
               std::span<const Point> outline, Polygon& cell, Polygon& spare) {
  cell.assign(outline.begin(), outline.end());
  for (const ColumnFace& other : lower) {
    if (&other == &bottom) continue;
    clip(cell, other.height - bottom.height, spare);
    std::swap(cell, spare);
    if (cell.empty()) return;
  }
}

}  // namespace

void ColumnScene::clear() {
  outlines.clear();
  upper.clear();
  lower.clear();
  ceiling.clear();
  floor.clear();
}

void ColumnScene::add_face(bool is_upper, const HeightPlane& height, bool overhang,
                           std::span<const Point> outline) {
  ColumnFace face{static_cast<int>(outlines.size()), static_cast<int>(outline.size()), height,
                  overhang, outline[0], outline[0]};
  for (const Point& p : outline) {
    face.min = face.min.cwiseMin(p);
    face.max = face.max.cwiseMax(p);
  }
  outlines.insert(outlines.end(), outline.begin(), outline.end());
  (is_upper ? upper : lower).push_back(face);
}

double column_energy(ColumnScene& scene) {
  double sum = 0.0;
  Polygon& cell = scene.work[0];
  for (const ColumnFace& top : scene.upper) {
    const std::span<const Point> outline(scene.outlines.data() + top.first,
                                         static_cast<std::size_t>(top.count));
    for (const ColumnFace& bottom : scene.lower) {
      if ((top.min.array() > bottom.max.array()).any() ||
          (bottom.min.array() > top.max.array()).any()) {
        continue;
      }
      cell_over(bottom, scene.lower, outline, cell, scene.work[1]);
      const HeightPlane length = top.height - bottom.height;
      sum += 0.5 * integrate_product(cell, length, length);
      if (top.overhang) {
        sum += overhang_energy(cell, length, top.height, scene.ceiling, 1.0, scene.work);
      }
      if (bottom.overhang) {
        sum += overhang_energy(cell, length, bottom.height, scene.floor, -1.0, scene.work);
      }
    }
  }
  return sum;
}

}  // namespace volcontact
