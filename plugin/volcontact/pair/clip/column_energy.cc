// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/clip/column_energy.h"

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

void ColumnEnergy::Polygon::reserve(int most_points) {
  if (sides_.size() >= static_cast<std::size_t>(most_points)) return;
  for (std::vector<Point>& buffer : buffers_) buffer.resize(most_points + 1);
  sides_.resize(most_points);
}

void ColumnEnergy::Polygon::cut(const HeightPlane& side) {
  int outside = 0;
  for (int i = 0; i < count; ++i) {
    sides_[i] = side(points[i]);
    outside += sides_[i] > 0.0;
  }
  if (outside == 0) return;
  if (outside == count) {
    count = 0;
    return;
  }
  // Without branches on the sides: no processor could predict them.
  Point* kept = buffers_[next_].data();
  const Point* const begin = kept;
  Point last = points[count - 1];
  double last_side = sides_[count - 1];
  for (int i = 0; i < count; ++i) {
    const Point p = points[i];
    const double s = sides_[i];
    const double t = last_side / (last_side - s);  // of use where the signs differ
    *kept = last + t * (p - last);
    kept += (last_side > 0.0) != (s > 0.0);
    *kept = p;
    kept += !(s > 0.0);
    last = p;
    last_side = s;
  }
  points = begin;
  count = static_cast<int>(kept - begin);
  next_ = 1 - next_;
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

// For each lower face, where its neighbours are lower than it. Cells are cut by these and not by
// the edges of the face: cells of neighbours then fit together, however short and noisy an edge is.
void ColumnEnergy::list_lines() {
  lines_.clear();
  for (Lower& bottom : lower_) {
    bottom.first_line = static_cast<int>(lines_.size());
    for (int i = bottom.first; i < bottom.first + bottom.count; ++i) {
      const int other = lower_of_face_[neighbors_[i]];
      if (other >= 0) lines_.push_back(lower_[other].height - bottom.height);
    }
    bottom.line_count = static_cast<int>(lines_.size()) - bottom.first_line;
  }
}

// Every cut adds one point at most, and may write one more.
void ColumnEnergy::reserve() {
  int outline = 0, lines = 0;
  for (const Upper& top : upper_) outline = std::max(outline, top.count);
  for (const Lower& bottom : lower_) lines = std::max(lines, bottom.line_count);
  cell_.reserve(outline + lines);
  part_.reserve(outline + lines + static_cast<int>(std::max(ceiling_.size(), floor_.size())));
}

// The part of the upper face's outline over which `bottom` is the lowest face.
void ColumnEnergy::cut_cell(const Upper& top, const Lower& bottom) {
  cell_.assign(outlines_.data() + top.first, top.count);
  const HeightPlane* line = lines_.data() + bottom.first_line;
  for (int i = 0; i < bottom.line_count && cell_.count > 0; ++i) cell_.cut(line[i]);
}

// The heights of planes over `from` (sign = 1) or of `from` over planes (-1), without those that
// are nowhere in the cell the least: at its corners another one is lower throughout.
void ColumnEnergy::list_reaches(std::span<const Point> cell, const HeightPlane& from,
                                std::span<const HeightPlane> planes, double sign,
                                std::vector<HeightPlane>& reaches) const {
  const auto below_in_cell = [&](const HeightPlane& a, const HeightPlane& b) {
    for (const Point& p : cell) {
      if (a(p) > b(p)) return false;
    }
    return true;
  };
  reaches.clear();
  for (const HeightPlane& plane : planes) {
    const HeightPlane reach = sign > 0.0 ? plane - from : from - plane;
    if (std::any_of(reaches.begin(), reaches.end(),
                    [&](const HeightPlane& other) { return below_in_cell(other, reach); })) {
      continue;
    }
    std::erase_if(reaches, [&](const HeightPlane& other) { return below_in_cell(reach, other); });
    reaches.push_back(reach);
  }
}

// int (length * least of the reaches) over the cell.
double ColumnEnergy::overhang_energy(const HeightPlane& length,
                                     std::span<const HeightPlane> reaches) {
  if (reaches.size() == 1) return cell_.integral(length, reaches[0]);
  double sum = 0.0;
  for (std::size_t j = 0; j < reaches.size(); ++j) {
    part_.assign(cell_.points, cell_.count);
    for (std::size_t i = 0; i < reaches.size() && part_.count > 0; ++i) {
      if (i != j) part_.cut(reaches[j] - reaches[i]);
    }
    sum += part_.integral(length, reaches[j]);
  }
  return sum;
}

template <typename Visit>
void ColumnEnergy::for_cells(const Visit& visit) {
  list_lines();
  reserve();
  for (const Upper& top : upper_) {
    for (const Lower& bottom : lower_) {
      if (top.min.exceeds(bottom.max) || bottom.min.exceeds(top.max)) continue;
      cut_cell(top, bottom);
      if (cell_.count >= 3) visit(top, bottom, top.height - bottom.height);
    }
  }
}

double ColumnEnergy::value() {
  constexpr HeightPlane kNoHeight{};
  double sum = 0.0;
  const Upper* last = nullptr;
  for_cells([&](const Upper& top, const Lower& bottom, const HeightPlane& length) {
    if (top.overhang && &top != last) {
      const std::span<const Point> outline(outlines_.data() + top.first,
                                           static_cast<std::size_t>(top.count));
      list_reaches(outline, top.height, ceiling_, 1.0, face_reaches_);
    }
    last = &top;
    const std::span<const Point> cell(cell_.points, static_cast<std::size_t>(cell_.count));
    sum += 0.5 * cell_.integral(length, length);
    if (top.overhang) {
      list_reaches(cell, kNoHeight, face_reaches_, 1.0, reaches_);
      sum += overhang_energy(length, reaches_);
    }
    if (bottom.overhang) {
      list_reaches(cell, bottom.height, floor_, -1.0, reaches_);
      sum += overhang_energy(length, reaches_);
    }
  });
  return sum;
}

double ColumnEnergy::value_above(const HeightPlane& plane) {
  double sum = 0.0;
  for_cells([&](const Upper& top, const Lower&, const HeightPlane& length) {
    sum += cell_.integral(plane - top.height, length);
  });
  return sum;
}

}  // namespace volcontact
