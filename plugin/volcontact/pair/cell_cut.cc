// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/cell_cut.h"

#include <algorithm>
#include <span>

#include "volcontact/pair/overlap_window.h"

namespace volcontact {
namespace {

constexpr int kFirstFace = 6;  // polytope face number of tangent 0; below: sides of the cell
constexpr double kSteepEnough = 0.05;  // of |slope|; less: no use in following the bent face
constexpr double kSplitShare = 0.4;    // axes with this share of the largest score are halved
constexpr double kOthersShare = 0.25;  // weight of the other faces' bend in a face's doubt

// Sum over |m_ij| u_i v_j.
double sum_abs(const Mat3& m, const Vec3& u) { return u.dot(m.cwiseAbs() * u); }

// The cell's sides as the box graph numbers them: -z, +z, -y, +y, -x, +x.
int cell_side(int axis, bool high) { return 2 * (2 - axis) + (high ? 1 : 0); }
Vec3 cell_side_normal(int side) { return (side & 1 ? 1.0 : -1.0) * Vec3::Unit(2 - side / 2); }

Vec3 corner_signs(int i) { return {i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0}; }

// Along the slope to where value + slope . x + 1/2 x^T H x vanishes, or is nearest to it.
Vec3 step_to_face(double value, const Vec3& slope, const Mat3& hessian) {
  const double square = slope.squaredNorm();
  if (!(square > 0.0)) return Vec3::Zero();
  const double bend = slope.dot(hessian * slope);
  const double root = square * square - 2.0 * bend * value;
  const double t = root >= 0.0 ? 2.0 * value / (square + std::sqrt(root)) : square / bend;
  return -t * slope;
}

// Smaller root t >= 0 of f = slope t - 1/2 curvature t^2; infinite where there is none.
double first_root(double f, double slope, double curvature) {
  const double square = slope * slope - 2.0 * curvature * f;
  if (!(square >= 0.0 && slope > 0.0)) return kInfinity;
  return 2.0 * f / (slope + std::sqrt(square));
}

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
  double bend_along = 0.0;  // second derivative along z

  Columns(const Tangent& t, const Vec3& half_sizes) : tangent(t), half(half_sizes) {
    Eigen::Index axis;
    steep = t.slope.cwiseAbs().maxCoeff(&axis);
    a = static_cast<int>(axis);
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
    bend_along = std::abs(hessian(a, a));
  }

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

// ---- which faces pass through the cell
// -----------------------------------------------------------

CellCut::Side CellCut::classify(const Quadric& face, const Cell& cell, Tangent& t) {
  t.seam = face.seam;
  t.bend = face.bend;
  t.slack = t.most = 0.0;
  if (face.bend == Bend::kFlat) {
    t.level = face.constant + face.linear.dot(cell.center);
    t.slope = face.linear;
    const double reach = t.slope.cwiseAbs().dot(cell.half);
    return t.level >= reach ? Side::kOutside : t.level <= -reach ? Side::kInside : Side::kThrough;
  }
  const Vec3 bent = face.hessian * cell.center;
  const double value = face.constant + cell.center.dot(face.linear + 0.5 * bent);
  const Vec3 slope = face.linear + bent;
  const double reach = slope.cwiseAbs().dot(cell.half);
  const double bend = 0.5 * sum_abs(face.hessian, cell.half);
  if (value - reach >= (face.bend == Bend::kConvex ? 0.0 : bend)) return Side::kOutside;
  if (value + reach <= (face.bend == Bend::kConcave ? 0.0 : -bend)) return Side::kInside;
  // The plane touches at the face, next to the middle of the cell if the face reaches there.
  t.hessian = face.hessian;
  t.touch = Vec3::Zero();
  t.slope = slope;
  t.level = value;
  for (int pass = 0; pass < 2; ++pass) {
    const Vec3 step = step_to_face(t.level + t.slope.dot(t.touch), t.slope, t.hessian);
    t.touch = (t.touch + step).cwiseMax(-cell.half).cwiseMin(cell.half);
    const Vec3 bent_touch = face.hessian * t.touch;
    t.slope = slope + bent_touch;
    t.level = value - 0.5 * t.touch.dot(bent_touch);
  }
  t.most = 0.5 * sum_abs(face.hessian, t.touch.cwiseAbs() + cell.half);
  return Side::kThrough;
}

CellCut::Side CellCut::classify_field(const CellFace& face, const Cell& cell, Tangent& t) {
  const SolidView& view = *face.field;
  const Vec3 p = face.X_SW * cell.center;
  const double distance = view.signed_distance(view.solid, p);
  const double radius = cell.half.norm();
  if (distance >= radius) return Side::kOutside;
  if (distance <= -radius) return Side::kInside;
  t.seam = false;
  t.bend = Bend::kFlat;
  t.level = distance;
  if (view.curvature_bound) {
    t.slope = face.X_SW.rotation.transpose() * view.gradient(view.solid, p);
    const double bend = 0.5 * view.curvature_bound(view.solid, p, radius) * radius * radius;
    t.slack = std::min(bend, 2.0 * radius);
  } else {
    fit_plane(face, cell, t);
  }
  t.most = t.slack;
  const double reach = t.slope.cwiseAbs().dot(cell.half) + t.slack;
  if (view.curvature_bound && t.level >= reach) return Side::kOutside;
  if (view.curvature_bound && t.level <= -reach) return Side::kInside;
  return Side::kThrough;
}

// Plane through the signed distances at the corners, by least squares; slack from what is left.
void CellCut::fit_plane(const CellFace& face, const Cell& cell, Tangent& t) {
  const SolidView& view = *face.field;
  std::array<double, 8> f;
  double mean = 0.0;
  Vec3 difference = Vec3::Zero();
  for (int i = 0; i < 8; ++i) {
    const Vec3 offset = corner_signs(i).cwiseProduct(cell.half);
    f[i] = view.signed_distance(view.solid, face.X_SW * (cell.center + offset));
    mean += f[i] / 8.0;
    difference += f[i] / 8.0 * corner_signs(i);
  }
  double residual = 0.0;
  for (int i = 0; i < 8; ++i) {
    residual = std::max(residual, std::abs(f[i] - mean - difference.dot(corner_signs(i))));
  }
  t.slack = std::max(residual, std::abs(t.level - mean));
  t.slope = difference.cwiseQuotient(cell.half);
  t.level = 0.5 * (t.level + mean);
}

bool CellCut::collect(const std::vector<CellFace>& faces, Cell& cell) {
  const int count = cell.listed < 0 ? cell.face_count : cell.listed;
  int through = 0;
  tangents_.clear();
  for (int i = 0; i < count; ++i) {
    const int index = cell.listed < 0 ? cell.first_face + i : cell.list[i];
    const CellFace& face = faces[index];
    Tangent& t = tangents_.emplace_back();
    t.owner = face.owner;
    const Side side = face.field ? classify_field(face, cell, t) : classify(face.quadric, cell, t);
    if (side == Side::kOutside) return false;
    if (side == Side::kInside) {
      tangents_.pop_back();
      continue;
    }
    // Safe in place: never ahead of what has been read.
    if (through < Cell::kListed) cell.list[through] = static_cast<std::uint16_t>(index);
    ++through;
  }
  all_flat_ = std::all_of(tangents_.begin(), tangents_.end(),
                          [](const Tangent& t) { return t.bend == Bend::kFlat; });
  if (through <= Cell::kListed) cell.listed = static_cast<std::int16_t>(through);
  return true;
}

// ---- the cut cell
// --------------------------------------------------------------------------------

void CellCut::cut(const Vec3& half) {
  half_ = half;
  polytope_.start(box_graph());
  for (int i = 0; i < 8; ++i) polytope_.points()[i] = corner_signs(i).cwiseProduct(half);
  for (std::size_t i = 0; i < tangents_.size(); ++i) {
    const Tangent& t = tangents_[i];
    const auto height = [&t](const Vec3& x) { return t.plane(x); };
    if (!polytope_.cut(height, kFirstFace + static_cast<int>(i), 0.0)) return;
  }
}

// The loops of the cut cell, and which faces meet in an edge.
void CellCut::read_loops() {
  const auto loops = polytope_.faces();
  loops_.assign(loops.begin(), loops.end());
  edges_.resize(std::max<std::size_t>(edges_.size(), polytope_.size()));
  edge_count_.assign(polytope_.size(), 0);
  for (const FaceLoop& loop : loops_) {
    const int* index = polytope_.loop_vertices().data() + loop.first;
    for (int i = 0; i < loop.count; ++i) {
      const int from = index[i], to = index[i + 1 < loop.count ? i + 1 : 0];
      edges_[from][edge_count_[from]++] = {to, loop.face};
    }
  }
}

int CellCut::face_across(int from, int to) const {
  for (const auto& [end, face] : edges_[to]) {
    if (end == from) return face;
  }
  return 0;
}

double CellCut::polytope_volume() const {
  const auto points = polytope_.points();
  double six = 0.0;
  for (const FaceLoop& loop : loops_) {
    const int* index = polytope_.loop_vertices().data() + loop.first;
    const Vec3& p = points[index[0]];
    for (int i = 2; i < loop.count; ++i) {
      six += p.dot(points[index[i - 1]].cross(points[index[i]]));
    }
  }
  return std::max(0.0, six / 6.0);
}

// Moments from the faces by the divergence theorem: tetrahedra from the cell's centre.
void CellCut::add_polytope(CellSums& sums) const {
  const auto points = polytope_.points();
  for (const FaceLoop& loop : loops_) {
    const int* index = polytope_.loop_vertices().data() + loop.first;
    const Vec3& p = points[index[0]];
    for (int i = 2; i < loop.count; ++i) {
      const Vec3 &q = points[index[i - 1]], &r = points[index[i]];
      const double six = p.dot(q.cross(r));
      const Vec3 sum = p + q + r;
      sums.volume += six / 6.0;
      sums.first += six / 24.0 * sum;
      sums.second +=
          six / 120.0 *
          (sum * sum.transpose() + p * p.transpose() + q * q.transpose() + r * r.transpose());
    }
  }
}

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
    const Vec3 gradient = t.slope + bent;
    const double bend = 0.5 * d.dot(bent);
    depth = first_root(bend, gradient.dot(normal.n), normal.along);
    if (!std::isfinite(depth)) depth = bend / normal.steep;
    const Vec3 on_face = gradient - depth * normal.bent;
    const double facing = on_face.dot(normal.n);
    if (facing > kSteepEnough * normal.steep) outward = on_face / facing;
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
    sample_edge(normal, index[i], index[i + 1 < loop.count ? i + 1 : 0], area);
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
  gap_sample_.second += volume * middle * middle.transpose();
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

// The edge of two tangent planes lies `off` outside the edge of the two faces, across the edge
// along the first plane. The strip between is taken off, by two Gauss points.
void CellCut::sample_edge(const Normal& normal, int from, int to, double area) {
  const int across = face_across(from, to);
  const Tangent* other = across < kFirstFace ? nullptr : &tangents_[across - kFirstFace];
  const bool other_flat = !other || other->bend == Bend::kFlat;
  if (normal.tangent.bend == Bend::kFlat && other_flat) return;
  const Vec3 &p = polytope_.points()[from], &q = polytope_.points()[to];
  Vec3 outward = (q - p).cross(normal.n);
  const double length = outward.norm();
  if (!(length > 0.0)) return;
  outward /= length;
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
    double off = (bend - foot.depth * slope.dot(normal.n)) / rise;
    off =
        off > 0.0 ? std::min(off, area / length) : std::max(off, -room(normal, x, outward, across));
    const double weight = -0.5 * length * off;
    const Vec3 at = x - foot.depth * normal.n - 0.5 * off * outward;
    sample_.push_back({at, weight * foot.outward, std::copysign(1.0, weight)});
  }
}

// ---- bounds of the volume between tangent planes and faces
// ---------------------------------------

// Keeps the columns in which a piece between the offsets may lie in the cell and in the other
// faces.
void CellCut::keep_touched(int index, const Columns& columns) {
  const Linear2& h = columns.plane;
  const double half = columns.half[columns.a];
  polygon_.cut({-h.a - half - columns.to, -h.b, -h.c});
  polygon_.cut({h.a - half + columns.from, h.b, h.c});
  for (int j = 0; j < static_cast<int>(tangents_.size()); ++j) {
    if (j == index || polygon_.empty()) continue;
    const double up = columns.slope_up(tangents_[j]);
    Linear2 height = columns.along(tangents_[j]);
    height.a += std::min(up * columns.from, up * columns.to) - tangents_[j].beyond();
    polygon_.cut(height);
  }
}

// Keeps the columns in which the whole piece between the offsets lies in the cell and in the other
// faces.
void CellCut::keep_filled(int index, const Columns& columns) {
  const Linear2& h = columns.plane;
  const double half = columns.half[columns.a];
  polygon_.cut({-h.a - half - columns.from, -h.b, -h.c});
  polygon_.cut({h.a - half + columns.to, h.b, h.c});
  for (int j = 0; j < static_cast<int>(tangents_.size()); ++j) {
    if (j == index || polygon_.empty()) continue;
    const double up = columns.slope_up(tangents_[j]);
    Linear2 height = columns.along(tangents_[j]);
    height.a += std::max(up * columns.from, up * columns.to) + tangents_[j].within();
    polygon_.cut(height);
  }
}

// A face bent to one side. In each column the gap is t with bend = rise t - 1/2 bend_along t^2, so
// bend / rise <= t <= factor * bend with constant factors, and bend is quadratic: exact integrals.
CellCut::Gap CellCut::bent_gap(int index, Columns& columns) {
  Gap gap;
  columns.expand_bend();
  const bool convex = columns.tangent.bend == Bend::kConvex;
  double& offset = convex ? columns.from : columns.to;
  const double farthest = std::abs(offset);
  double factor = 0.0;
  for (int pass = 0; pass < 2; ++pass) {
    double largest = 0.0, least_rise = kInfinity, longest = 0.0;
    for (const ConvexPolygon::Point& p : polygon_.points()) {
      largest = std::max(largest, columns.bend(p.x, p.y));
      least_rise = std::min(least_rise, columns.rise(p.x, p.y));
      const double height = columns.plane(p.x, p.y);
      longest = std::max(longest, columns.half[columns.a] + (convex ? height : -height));
    }
    const double root = least_rise * least_rise - 2.0 * columns.bend_along * largest;
    // No column may reach the far side of the face, where it leaves or enters the solid again.
    if (!(least_rise > kSteepEnough * columns.steep && root >= 0.0 &&
          columns.bend_along * longest <= least_rise + std::sqrt(root))) {
      gap.high = polygon_.area() * farthest;
      return gap;
    }
    factor = 2.0 / (least_rise + std::sqrt(root));
    const double size = std::min(farthest, factor * largest);
    offset = convex ? -size : size;
    keep_touched(index, columns);
    if (polygon_.empty()) return gap;
  }
  const auto bend = [&columns](double x, double y) { return columns.bend(x, y); };
  gap.high = std::min(factor * polygon_.integral(bend), polygon_.area() * farthest);
  keep_filled(index, columns);
  double most_rise = 0.0;
  for (const ConvexPolygon::Point& p : polygon_.points()) {
    most_rise = std::max(most_rise, columns.rise(p.x, p.y));
  }
  if (most_rise > 0.0) gap.low = std::min(gap.high, polygon_.integral(bend) / most_rise);
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

void CellCut::bound(Cell& cell) {
  const double cell_volume = 8.0 * cell.half.prod();
  cell.low = cell.high = polytope_volume();
  gaps_.assign(tangents_.size(), Gap{});
  for (std::size_t i = 0; i < tangents_.size(); ++i) {
    if (tangents_[i].exact()) continue;
    const Gap& gap = gaps_[i] = gap_of(static_cast<int>(i), cell.half);
    cell.low -= gap.high;
    cell.high -= gap.low;
    cell.doubt[tangents_[i].owner] += gap.high - gap.low;
  }
  cell.low = std::clamp(cell.low, 0.0, cell_volume);
  cell.high = std::clamp(cell.high, cell.low, cell_volume);
}

void CellCut::estimate(Cell& cell) {
  CellSums& sums = cell.sums;
  add_polytope(sums);
  add_surfaces(sums);
  for (std::size_t i = 0; i < tangents_.size(); ++i) {
    const Moments& between = between_[i];
    if (between.volume == 0.0) continue;
    const double share = std::clamp(between.volume, gaps_[i].low, gaps_[i].high) / between.volume;
    sums.volume -= share * between.volume;
    sums.first -= share * between.first;
    sums.second -= share * between.second;
  }
  const double inside = std::clamp(sums.volume, cell.low, cell.high);
  if (inside != sums.volume) {
    const double scale = sums.volume > 0.0 ? inside / sums.volume : 0.0;
    sums.volume = inside;
    sums.first *= scale;
    sums.second *= scale;
  }
}

// Halving an axis helps against a bend along it; a straight cylinder is never cut across.
void CellCut::choose_split(Cell& cell) const {
  const auto share_of = [&](std::size_t i) -> Vec3 {
    const Tangent& t = tangents_[i];
    Vec3 share = t.hessian.diagonal().cwiseAbs().cwiseProduct(gaps_[i].reach.cwiseAbs2());
    if (t.slack > 0.0 || !(share.sum() > 0.0)) share = cell.half.cwiseAbs2();
    return share / share.sum();
  };
  Vec3 others = Vec3::Zero(), score = Vec3::Zero();
  for (std::size_t i = 0; i < tangents_.size(); ++i) {
    if (!tangents_[i].exact()) others += kOthersShare * share_of(i);
  }
  for (std::size_t i = 0; i < tangents_.size(); ++i) {
    if (!tangents_[i].exact()) score += (gaps_[i].high - gaps_[i].low) * (share_of(i) + others);
  }
  cell.split = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (score[axis] >= kSplitShare * score.maxCoeff()) cell.split |= 1u << axis;
  }
}

void CellCut::evaluate(const std::vector<CellFace>& faces, Cell& cell, double rough_above) {
  cell.sums = CellSums{};
  cell.low = cell.high = 0.0;
  cell.doubt = {0.0, 0.0};
  cell.rough = false;
  cell.empty = !collect(faces, cell);
  if (cell.empty) return;
  cut(cell.half);
  if (tangents_.empty()) {
    cell.sums.volume = cell.low = cell.high = 8.0 * cell.half.prod();
    cell.sums.second = (cell.sums.volume / 3.0 * cell.half.cwiseAbs2()).asDiagonal();
    return;
  }
  const bool bounded_by_planes = std::all_of(tangents_.begin(), tangents_.end(),
                                             [](const Tangent& t) { return t.beyond() == 0.0; });
  cell.empty = polytope_.size() == 0 && bounded_by_planes;
  if (cell.empty) return;
  read_loops();
  bound(cell);
  choose_split(cell);
  cell.rough = cell.high - cell.low > rough_above;
  if (cell.rough) {
    cell.sums.volume = 0.5 * (cell.low + cell.high);
  } else {
    estimate(cell);
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
