// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/column_energy.h"

#include <algorithm>

namespace volcontact {
namespace {

using Point = ColumnEnergy::Point;

void bound(std::span<const Point> outline, Point& min, Point& max) {
  min = max = outline[0];
  for (const Point& p : outline) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
}

}  // namespace

void ColumnEnergy::start(int face_count) {
  outlines_.clear();
  neighbors_.clear();
  upper_.clear();
  lower_.clear();
  lower_of_face_.assign(face_count, -1);
  ceiling_.clear();
  floor_.clear();
  has_overhang_ = false;
}

void ColumnEnergy::add_upper(const HeightPlane& height, bool overhang,
                             std::span<const Point> outline) {
  Upper upper{static_cast<int>(outlines_.size()),
              static_cast<int>(outline.size()),
              height,
              overhang,
              Point(),
              Point()};
  bound(outline, upper.min, upper.max);
  outlines_.insert(outlines_.end(), outline.begin(), outline.end());
  upper_.push_back(upper);
  has_overhang_ |= overhang;
}

void ColumnEnergy::add_lower(int face, const HeightPlane& height, bool overhang,
                             std::span<const Point> outline, std::span<const int> neighbors) {
  Lower lower{face,
              static_cast<int>(neighbors_.size()),
              static_cast<int>(neighbors.size()),
              height,
              overhang,
              Point(),
              Point()};
  bound(outline, lower.min, lower.max);
  neighbors_.insert(neighbors_.end(), neighbors.begin(), neighbors.end());
  int& index = lower_of_face_[face];
  if (index >= 0) {  // rounding has split off a sliver: the plane counts once
    Lower& other = lower_[index];
    if ((lower.max - lower.min).prod() > (other.max - other.min).prod()) other = lower;
    return;
  }
  index = static_cast<int>(lower_.size());
  lower_.push_back(lower);
  has_overhang_ |= overhang;
}

void ColumnEnergy::Polygon::assign(std::span<const Point> from, int most_cuts) {
  count = static_cast<int>(from.size());
  const std::size_t room = from.size() + most_cuts;
  if (points.size() < room) {
    points.resize(room);
    spare.resize(room);
    sides.resize(room);
  }
  std::copy(from.begin(), from.end(), points.begin());
}

void ColumnEnergy::Polygon::cut(const HeightPlane& side) {
  int outside = 0;
  for (int i = 0; i < count; ++i) {
    sides[i] = side(points[i]);
    outside += sides[i] > 0.0;
  }
  if (outside == 0) return;
  int kept = 0;
  for (int i = 0, last = count - 1; i < count; last = i++) {
    if ((sides[last] > 0.0) != (sides[i] > 0.0)) {
      const double t = sides[last] / (sides[last] - sides[i]);
      spare[kept++] = points[last] + t * (points[i] - points[last]);
    }
    if (!(sides[i] > 0.0)) spare[kept++] = points[i];
  }
  count = kept;
  std::swap(points, spare);
}

// int (a b) of two linear functions, clamped to be >= 0 against rounding.
double ColumnEnergy::Polygon::integral(const HeightPlane& a, const HeightPlane& b) const {
  if (count < 3) return 0.0;
  const auto value = [](const HeightPlane& f, const Point& p) { return std::max(0.0, f(p)); };
  const Point& origin = points[0];
  const double a_0 = value(a, origin), b_0 = value(b, origin);
  double a_1 = value(a, points[1]), b_1 = value(b, points[1]), sum = 0.0;
  Point p = points[1] - origin;
  for (int i = 2; i < count; ++i) {
    const Point q = points[i] - origin;
    const double a_2 = value(a, points[i]), b_2 = value(b, points[i]);
    const double twice_area = p.x() * q.y() - p.y() * q.x();
    sum += twice_area * ((a_0 + a_1 + a_2) * (b_0 + b_1 + b_2) + a_0 * b_0 + a_1 * b_1 + a_2 * b_2);
    p = q;
    a_1 = a_2;
    b_1 = b_2;
  }
  return sum / 24.0;
}

// The part of the upper face's outline over which `bottom` is the lowest face. Cut by the heights
// of the planes around it and not by its edges: cells of neighbours then fit together, however
// short and noisy the edge between them is.
void ColumnEnergy::cut_cell(const Upper& top, const Lower& bottom) {
  cell_.assign({outlines_.data() + top.first, static_cast<std::size_t>(top.count)}, bottom.count);
  for (int i = bottom.first; i < bottom.first + bottom.count && cell_.count > 0; ++i) {
    const int other = lower_of_face_[neighbors_[i]];
    if (other >= 0) cell_.cut(lower_[other].height - bottom.height);
  }
}

// The heights of planes over `from` (sign = 1) or of `from` over planes (-1), without those that
// are nowhere in the cell the least: at its corners another one is lower throughout.
void ColumnEnergy::list_reaches(const HeightPlane& from, std::span<const HeightPlane> planes,
                                double sign) {
  const auto below_in_cell = [&](const HeightPlane& a, const HeightPlane& b) {
    for (int i = 0; i < cell_.count; ++i) {
      if (a(cell_.points[i]) > b(cell_.points[i])) return false;
    }
    return true;
  };
  reaches_.clear();
  for (const HeightPlane& plane : planes) {
    const HeightPlane reach = sign > 0.0 ? plane - from : from - plane;
    if (std::any_of(reaches_.begin(), reaches_.end(),
                    [&](const HeightPlane& other) { return below_in_cell(other, reach); })) {
      continue;
    }
    std::erase_if(reaches_, [&](const HeightPlane& other) { return below_in_cell(reach, other); });
    reaches_.push_back(reach);
  }
}

// int (length * least of the reaches) over the cell.
double ColumnEnergy::overhang_energy(const HeightPlane& length) {
  double sum = 0.0;
  const int count = static_cast<int>(reaches_.size());
  for (int j = 0; j < count; ++j) {
    part_.assign({cell_.points.data(), static_cast<std::size_t>(cell_.count)}, count);
    for (int i = 0; i < count && part_.count > 0; ++i) {
      if (i != j) part_.cut(reaches_[j] - reaches_[i]);
    }
    sum += part_.integral(length, reaches_[j]);
  }
  return sum;
}

double ColumnEnergy::value() {
  double sum = 0.0;
  for (const Upper& top : upper_) {
    for (const Lower& bottom : lower_) {
      if ((top.min.array() > bottom.max.array()).any() ||
          (bottom.min.array() > top.max.array()).any()) {
        continue;
      }
      cut_cell(top, bottom);
      if (cell_.count < 3) continue;
      const HeightPlane length = top.height - bottom.height;
      sum += 0.5 * cell_.integral(length, length);
      if (top.overhang) {
        list_reaches(top.height, ceiling_, 1.0);
        sum += overhang_energy(length);
      }
      if (bottom.overhang) {
        list_reaches(bottom.height, floor_, -1.0);
        sum += overhang_energy(length);
      }
    }
  }
  return sum;
}

}  // namespace volcontact
