// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/octree/cell_cut.h"

#include <algorithm>

#include "volcontact/pair/octree/cell_math.h"

namespace volcontact {

using namespace cell_math;

namespace {

constexpr double kSteepLimit = 1e-6;
constexpr int kStrips = 2;  // of a band: half the cells of one, and hardly more with three

}  // namespace

// Columns of the cell along the axis nearest to the normal of a tangent plane. z runs along the
// column towards the outside, (x, y) across; the plane stands at z = plane(x, y).
struct CellCut::Columns {
  const Tangent& tangent;
  Vec3 half;
  int a = 0, b = 1, c = 2;  // the axes of z, x, y
  double sign = 1.0;        // of z against axis a
  double steep = 0.0;       // d L / d z
  Linear2 plane{};
  double from = 0.0, to = 0.0;  // between these offsets from the plane lies the face
  // Bend at the plane: q0 + qx x + ... ; rise of the face's F there: r(x, y).
  double q0 = 0.0, qx = 0.0, qy = 0.0, qxx = 0.0, qxy = 0.0, qyy = 0.0;
  Linear2 rise{};
  double bend_along = 0.0;  // second derivative along z, negative for some columns of a cone

  Columns(const Tangent& t, const Vec3& half_sizes) : tangent(t), half(half_sizes) {
    const Vec3 slopes = t.slope.cwiseAbs();
    a = slopes.largest();
    steep = slopes[a];
    b = (a + 1) % 3;
    c = (a + 2) % 3;
    sign = std::copysign(1.0, t.slope[a]);
    plane = {-t.level / steep, -t.slope[b] / steep, -t.slope[c] / steep};
    const double reach = t.most / steep;
    from = t.bend == Bend::kConcave && t.slack == 0.0 ? 0.0 : -reach;
    to = t.bend == Bend::kConvex && t.slack == 0.0 ? 0.0 : reach;
  }

  void expand_bend() {
    const Mat3& hessian = tangent.hessian;
    Vec3 d0 = -tangent.touch, dx = Vec3::Unit(b), dy = Vec3::Unit(c);
    d0[a] += sign * plane.a;
    dx[a] = sign * plane.b;
    dy[a] = sign * plane.c;
    const Vec3 h0 = hessian * d0, hx = hessian * dx, hy = hessian * dy;
    q0 = 0.5 * d0.dot(h0);
    qx = d0.dot(hx);
    qy = d0.dot(hy);
    qxx = 0.5 * dx.dot(hx);
    qxy = dx.dot(hy);
    qyy = 0.5 * dy.dot(hy);
    rise = {steep + sign * h0[a], sign * hx[a], sign * hy[a]};
    bend_along = -into() * hessian(a, a);
  }

  // For a face that is bent to one side: the gap runs from the plane along -z (convex) or z.
  double into() const { return tangent.bend == Bend::kConvex ? -1.0 : 1.0; }
  double length() const { return std::max(-from, to); }
  void set_length(double length) { (into() < 0.0 ? from : to) = into() * length; }

  // Size of the bend term, for a face that is bent to one side only.
  double bend(double x, double y) const {
    return std::abs(q0 + x * (qx + qxx * x + qxy * y) + y * (qy + qyy * y));
  }
  // The other face's plane, along the plane of this one.
  Linear2 along(const Tangent& other) const {
    const double up = sign * other.slope[a];
    return {other.level + up * plane.a, other.slope[b] + up * plane.b,
            other.slope[c] + up * plane.c};
  }
  double slope_up(const Tangent& other) const { return sign * other.slope[a]; }
  Vec3 point(const ConvexPolygon::Point& p) const {
    Vec3 x;
    x[a] = sign * plane(p.x, p.y);
    x[b] = p.x;
    x[c] = p.y;
    return x;
  }
};

// Columns of a face bent to one side. Their length lies between `least` and `most` times the bend,
// and is `length` at most. 1/rise lies between its tangent and its chord, so the two factors are
// linear, and differ in second order only.
struct CellCut::BentColumns {
  const Columns& columns;
  double length;
  Linear2 least{}, most{};
  double least_anywhere = 0.0, most_anywhere = 0.0;

  void set_rises(double low, double high, double stretch) {
    const double middle = 0.5 * (low + high);
    const double shorter = std::min(1.0, stretch), longer = std::max(1.0, stretch);
    least = columns.rise.scaled(-1.0).raised(2.0 * middle).scaled(shorter / (middle * middle));
    most = columns.rise.scaled(-1.0).raised(low + high).scaled(longer / (low * high));
    least_anywhere = shorter / high;
    most_anywhere = longer / low;
  }
  double integral(const Linear2& factor, const ConvexPolygon& polygon) const {
    return polygon.integral([&](double x, double y) { return factor(x, y) * columns.bend(x, y); });
  }
  double largest_bend(const ConvexPolygon& polygon) const {
    double largest = 0.0;  // convex: in a corner
    for (const auto& p : polygon.points()) largest = std::max(largest, columns.bend(p.x, p.y));
    return largest;
  }
  // From the plane to the far side of the cell.
  double longest(const ConvexPolygon& polygon) const {
    double longest = 0.0;
    for (const auto& p : polygon.points()) {
      const double height = columns.plane(p.x, p.y);
      longest = std::max(longest, columns.half[columns.a] - columns.into() * height);
    }
    return longest;
  }
  std::array<double, 2> rises(const ConvexPolygon& polygon) const {
    std::array<double, 2> range{kInfinity, -kInfinity};
    for (const auto& p : polygon.points()) {
      const double rise = columns.rise(p.x, p.y);
      range = {std::min(range[0], rise), std::max(range[1], rise)};
    }
    return range;
  }
  // Of the bend, at the middle of the polygon's corners.
  Linear2 tangent(const ConvexPolygon& polygon) const {
    const auto [x, y] = polygon.middle();
    const double sign = columns.tangent.bend == volcontact::Bend::kConvex ? 1.0 : -1.0;
    const double dx = sign * (columns.qx + 2.0 * columns.qxx * x + columns.qxy * y);
    const double dy = sign * (columns.qy + columns.qxy * x + 2.0 * columns.qyy * y);
    return {columns.bend(x, y) - dx * x - dy * y, dx, dy};
  }
};

// The faces take the place of their planes one after the other, and what each of them changes adds
// up: seen from a face, those before it are themselves and those after it still planes. Keeps the
// columns in which a piece between the offsets may lie in the cell and in the others.
void CellCut::keep_touched(int index, const Columns& columns) {
  const Linear2& h = columns.plane;
  const double half = columns.half[columns.a];
  polygon_.cut({-h.a - half - columns.to, -h.b, -h.c});
  polygon_.cut({h.a - half + columns.from, h.b, h.c});
  for (int j = 0; j < static_cast<int>(tangents_.size()); ++j) {
    if (j == index || polygon_.empty()) continue;
    const Limit limit = j > index
                            ? plane_limit(tangents_[j], columns)
                            : limit_of(tangents_[j], columns, columns.from, columns.to, polygon_);
    polygon_.cut(limit.near.raised(std::min(limit.slope * columns.from, limit.slope * columns.to)));
  }
}

// The plane of another face along the columns over a polygon, between these offsets from their
// plane, with bounds of that face. A bend to one side is convex: it lies above its tangent in the
// middle, and farthest above it in a corner.
CellCut::Limit CellCut::limit_of(const Tangent& other, const Columns& columns, double from,
                                 double to, const ConvexPolygon& polygon) {
  const Linear2 height = columns.along(other);
  const double slope = columns.slope_up(other);
  if (other.exact() || other.cone ||
      (other.bend != Bend::kConvex && other.bend != Bend::kConcave)) {
    return {height.raised(-other.beyond()), height.raised(other.within()), slope, &other};
  }
  const double side = other.bend == Bend::kConvex ? 1.0 : -1.0, half_way = 0.5 * (from + to);
  const Vec3 up = columns.sign * Vec3::Unit(columns.a);
  const Vec3 middle = columns.point(polygon.middle()) + half_way * up;
  const Vec3 bent = side * (other.hessian * (middle - other.touch));
  const Vec3 bent_up = side * columns.sign * other.hessian.col(columns.a);
  const double climb = columns.sign * bent[columns.a];
  Linear2 tangent{0.5 * bent.dot(middle - other.touch) - bent.dot(middle) + climb * columns.plane.a,
                  bent[columns.b] + climb * columns.plane.b,
                  bent[columns.c] + climb * columns.plane.c};
  // Over the tangent the bend is 1/2 d^T H d, d from the middle.
  double most = 0.0;
  for (const ConvexPolygon::Point& p : polygon.points()) {
    const Vec3 d = columns.point(p) - (middle - half_way * up);
    const double square = side * d.dot(other.hessian * d), slant = d.dot(bent_up);
    const double along = columns.sign * bent_up[columns.a];
    for (const double step : {from - half_way, to - half_way}) {
      most = std::max(most, 0.5 * square + step * (slant + 0.5 * step * along));
    }
  }
  if (side > 0.0) {
    const Linear2 near = height.plus(tangent).raised(-other.slack);
    return {near, near.raised(most + 2.0 * other.slack), slope + climb, &other};
  }
  const Linear2 far = height.plus(tangent.scaled(-1.0)).raised(other.slack);
  return {far.raised(-most - 2.0 * other.slack), far, slope - climb, &other};
}

CellCut::Limit CellCut::plane_limit(const Tangent& other, const Columns& columns) {
  const Linear2 height = columns.along(other);
  return {height, height, columns.slope_up(other), nullptr};
}

void CellCut::find_limits(int index, const Columns& columns) {
  limits_.clear();
  const Linear2& h = columns.plane;
  const double half = columns.half[columns.a];
  const Linear2 top{h.a - half, h.b, h.c}, bottom{-h.a - half, -h.b, -h.c};
  limits_.push_back({top, top, columns.into(), nullptr});
  limits_.push_back({bottom, bottom, -columns.into(), nullptr});
  for (int j = 0; j < static_cast<int>(tangents_.size()); ++j) {
    if (j == index) continue;
    limits_.push_back(j > index
                          ? plane_limit(tangents_[j], columns)
                          : limit_of(tangents_[j], columns, columns.from, columns.to, polygon_));
    limits_.back().slope *= columns.into();
  }
}

// Some columns of `band_` end at limit k, within their length or a little before or after. How many
// do depends on their length: strip by strip, across the direction in which the face bends.
void CellCut::add_band(std::size_t k, const BentColumns& bent, Gap& gap) {
  double low[2] = {kInfinity, kInfinity}, high[2] = {-kInfinity, -kInfinity};
  for (const auto& p : band_.points()) {
    low[0] = std::min(low[0], p.x);
    high[0] = std::max(high[0], p.x);
    low[1] = std::min(low[1], p.y);
    high[1] = std::max(high[1], p.y);
  }
  const double width[2] = {high[0] - low[0], high[1] - low[1]};
  const int axis = std::abs(bent.columns.qxx) * width[0] * width[0] <
                   std::abs(bent.columns.qyy) * width[1] * width[1];
  const Linear2 along{0.0, axis == 0 ? 1.0 : 0.0, axis == 0 ? 0.0 : 1.0};
  const int strips = k < 2 ? 1 : kStrips;  // a side of the cell
  for (int strip = 0; strip < strips; ++strip) {
    const double from = low[axis] + strip * width[axis] / strips;
    const double to = low[axis] + (strip + 1) * width[axis] / strips;
    strip_ = band_;
    if (strip > 0) strip_.cut(along.scaled(-1.0).raised(from));
    if (strip + 1 < strips) strip_.cut(along.raised(-to));
    add_strip(k, bent, gap);
  }
}

// Of `part_`, the columns that lie in the limits after k, at least partly, or whole.
void CellCut::keep_touched_by_rest(std::size_t k, double length) {
  for (std::size_t j = k + 1; j < limits_.size() && !part_.empty(); ++j) {
    part_.cut(limits_[j].touched(length));
  }
}
void CellCut::keep_whole_by_rest(std::size_t k, double length) {
  for (std::size_t j = k + 1; j < limits_.size() && !part_.empty(); ++j) {
    part_.cut(limits_[j].whole(length));
  }
}

// The strip sees the limit closer by: over it, the other face bends less.
void CellCut::add_strip(std::size_t k, const BentColumns& bent, Gap& gap) {
  if (strip_.empty()) return;
  const double length = std::min(bent.length, bent.most_anywhere * bent.largest_bend(strip_));
  Limit limit = limits_[k];
  if (limit.face) {
    const double end = bent.columns.into() * length;
    limit = limit_of(*limit.face, bent.columns, std::min(0.0, end), std::max(0.0, end), strip_);
    limit.slope *= bent.columns.into();
  }
  strip_.cut(limit.touched(length));
  if (strip_.empty()) return;
  part_ = strip_;
  const Linear2 whole = limit.whole(length);
  part_.cut(whole);
  keep_touched_by_rest(k, bent.length);
  gap.high += bent.integral(bent.most, part_);
  keep_whole_by_rest(k, bent.length);
  gap.low += bent.integral(bent.least, part_);
  strip_.cut(whole.scaled(-1.0));
  if (!strip_.empty()) add_ended(k, limit, bent, gap);
}

// Columns of `strip_` that limit k, seen there, may end within their length.
void CellCut::add_ended(std::size_t k, const Limit& limit, const BentColumns& bent, Gap& gap) {
  // Along a steep limit the band is too thin to be worth a division by next to nothing.
  const bool steep =
      std::abs(limit.slope) < kSteepLimit * (std::abs(limit.near.b) + std::abs(limit.near.c));
  const bool begins = !steep && limit.slope < 0.0, ends = !steep && limit.slope > 0.0;
  // The bend lies above its tangent, and farthest above it in a corner.
  const Linear2 tangent = bent.tangent(strip_);
  double over = 0.0;
  for (const auto& p : strip_.points()) {
    over = std::max(over, bent.columns.bend(p.x, p.y) - tangent(p.x, p.y));
  }
  const Linear2 shortest = tangent.scaled(bent.least_anywhere);
  const Linear2 longest = tangent.raised(over).scaled(bent.most_anywhere);
  part_ = strip_;
  keep_touched_by_rest(k, bent.length);
  if (begins) {
    const Linear2 left = longest.plus(limit.near.scaled(1.0 / limit.slope));
    part_.cut(left.scaled(-1.0));
    gap.high += std::min(bent.integral(bent.most, part_), part_.integral(left));
  } else if (ends) {
    const Linear2 end = limit.near.scaled(-1.0 / limit.slope);
    const Linear2 surplus = longest.plus(end.scaled(-1.0));
    short_ = part_;
    short_.cut(surplus);
    gap.high += bent.integral(bent.most, short_);
    part_.cut(surplus.scaled(-1.0));
    gap.high += std::max(0.0, std::min(bent.integral(bent.most, part_), part_.integral(end)));
  } else {
    gap.high += bent.integral(bent.most, part_);
  }
  if (!begins && !ends) return;
  part_ = strip_;
  keep_whole_by_rest(k, bent.length);
  if (part_.empty()) return;
  if (begins) {
    const Linear2 left = shortest.plus(limit.far.scaled(1.0 / limit.slope));
    part_.cut(left.scaled(-1.0));
    gap.low += part_.integral(left);
    return;
  }
  const Linear2 end = limit.far.scaled(-1.0 / limit.slope);
  part_.cut(shortest.scaled(-1.0));
  part_.cut(end.scaled(-1.0));
  const Linear2 surplus = shortest.plus(end.scaled(-1.0));
  strip_ = part_;
  part_.cut(surplus);
  gap.low += part_.integral(shortest);
  strip_.cut(surplus.scaled(-1.0));
  gap.low += strip_.integral(end);
}

// A face bent to one side. In each column the gap is t with bend = rise t - 1/2 bend_along t^2, so
// t lies between bend / rise and stretch bend / rise, where bend is quadratic and rise linear.
CellCut::Gap CellCut::bent_gap(int index, Columns& columns) {
  Gap gap;
  columns.expand_bend();
  const double farthest = columns.length();
  BentColumns bent{columns, farthest};
  for (int pass = 0; pass < 2; ++pass) {
    const double largest = bent.largest_bend(polygon_);
    const auto [least_rise, most_rise] = bent.rises(polygon_);
    const double root = least_rise * least_rise - 2.0 * columns.bend_along * largest;
    // No column may reach the far side of the face, where it leaves or enters the solid again.
    if (!(least_rise > kSteepEnough * columns.steep && root >= 0.0 &&
          columns.bend_along * bent.longest(polygon_) <= least_rise + std::sqrt(root))) {
      gap.high = polygon_.area() * farthest;
      return gap;
    }
    bent.set_rises(least_rise, most_rise, 2.0 * least_rise / (least_rise + std::sqrt(root)));
    bent.length = std::min(farthest, bent.most_anywhere * largest);
    columns.set_length(bent.length);
    keep_touched(index, columns);
    if (polygon_.empty()) return gap;
  }
  find_limits(index, columns);
  // From the polygon of all columns, limit after limit takes the band where it cuts columns.
  for (std::size_t k = 0; k < limits_.size() && !polygon_.empty(); ++k) {
    const Linear2 whole = limits_[k].whole(bent.length);
    if (polygon_.highest(whole) <= 0.0) continue;
    band_ = polygon_;
    band_.cut(limits_[k].touched(bent.length));
    band_.cut(whole.scaled(-1.0));
    polygon_.cut(whole);
    if (!band_.empty()) add_band(k, bent, gap);
  }
  gap.high += bent.integral(bent.most, polygon_);
  gap.low += bent.integral(bent.least, polygon_);
  gap.low = std::min(gap.low, gap.high);
  return gap;
}

CellCut::Gap CellCut::gap_of(int index, const Vec3& half) {
  const Tangent& t = tangents_[index];
  const double cell_volume = 8.0 * half.prod();
  Columns columns(t, half);
  Gap gap;
  if (!(columns.steep > 0.0)) {
    gap = {t.bend == Bend::kConvex ? 0.0 : -cell_volume, cell_volume, half};
    return gap;
  }
  polygon_.start(half[columns.b], half[columns.c]);
  keep_touched(index, columns);
  if (polygon_.empty()) return gap;

  Vec3 reach = Vec3::Zero();
  for (const ConvexPolygon::Point& p : polygon_.points()) {
    reach = reach.cwiseMax((columns.point(p) - t.touch).cwiseAbs());
  }
  if (t.slack == 0.0 && (t.bend == Bend::kConvex || t.bend == Bend::kConcave)) {
    gap = bent_gap(index, columns);
    if (t.bend == Bend::kConcave) gap = {-gap.high, -gap.low, gap.reach};
  } else {
    const double area = polygon_.area();
    gap.low = -area * columns.to;
    gap.high = -area * columns.from;
  }
  gap.reach = reach.cwiseMin(2.0 * half);
  return gap;
}

}  // namespace volcontact
