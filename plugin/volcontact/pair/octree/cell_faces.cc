// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/octree/cell_cut.h"

#include <algorithm>

#include "volcontact/pair/octree/cell_math.h"

namespace volcontact {

using namespace cell_math;

namespace {

constexpr double kOnFace = 1e-14;  // of the terms of F, where F counts as zero

// Sum over |m_ij| u_i v_j.
double sum_abs(const Mat3& m, const Vec3& u) { return u.dot(m.cwiseAbs() * u); }

// Along the slope to where value + slope . x + 1/2 x^T H x vanishes, or is nearest to it.
Vec3 step_to_face(double value, const Vec3& slope, const Mat3& hessian) {
  const double square = slope.squaredNorm();
  if (!(square > 0.0)) return Vec3::Zero();
  const double bend = slope.dot(hessian * slope);
  const double root = square * square - 2.0 * bend * value;
  const double t = root >= 0.0 ? 2.0 * value / (square + std::sqrt(root)) : square / bend;
  return -t * slope;
}

}  // namespace

// A plane that touches a cone along one of its lines has all of that nappe on one side and the
// other nappe on the other, as if the cone were convex. It must touch the true face, if outside of
// the cell. False where the nearest line is of the other nappe, or there is none.
bool CellCut::touch_cone(const Quadric& face, const Cell& cell, double value, const Vec3& slope,
                         Tangent& t) {
  t.touch = step_to_face(value, slope, face.hessian);
  const Vec3 bent = face.hessian * t.touch;
  const double off = value + t.touch.dot(slope + 0.5 * bent);
  const double size = std::abs(value) + std::abs(t.touch.dot(slope)) + std::abs(t.touch.dot(bent));
  const double radius = face.nappe_offset + face.nappe.dot(cell.center + t.touch);
  if (!(std::abs(off) <= kOnFace * size && radius > 0.0)) return false;
  t.bend = face.bend == Bend::kCone ? Bend::kConvex : Bend::kConcave;
  t.slope = slope + bent;
  t.level = value - 0.5 * t.touch.dot(bent);
  t.most = 0.5 * sum_abs(face.hessian, t.touch.cwiseAbs() + cell.half);
  return true;
}

CellCut::Side CellCut::classify(const Quadric& face, const Cell& cell, Tangent& t) {
  t.seam = face.seam;
  t.bend = face.bend;
  t.cone = face.bend == Bend::kCone || face.bend == Bend::kConeHole;
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
  t.hessian = face.hessian;
  if (t.cone && touch_cone(face, cell, value, slope, t)) return Side::kThrough;
  // The plane touches at the face, next to the middle of the cell if the face reaches there.
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
  if (face.sampled()) return classify_samples(face, cell, t);
  const SolidView& view = *face.field;
  const Vec3 p = face.X_SW * cell.center;
  const double distance = view.signed_distance(view.solid, p);
  const double radius = cell.half.norm();
  if (distance >= radius) return Side::kOutside;
  if (distance <= -radius) return Side::kInside;
  t.seam = t.cone = false;
  t.bend = Bend::kFlat;
  t.level = distance;
  t.slope = face.X_SW.rotation.transpose() * view.gradient(view.solid, p);
  const double bend = 0.5 * view.curvature_bound(view.solid, p, radius) * radius * radius;
  t.most = t.slack = std::min(bend, 2.0 * radius);
  const double reach = t.slope.cwiseAbs().dot(cell.half) + t.slack;
  return t.level >= reach ? Side::kOutside : t.level <= -reach ? Side::kInside : Side::kThrough;
}

// The plane through the distances at the corners by least squares, at the height of the centre. The
// differences of opposite corners tell the slope but for 3/2 times half the bend over the radius;
// together with the bend itself the plane is off by 5/2 times that at most. Without a bound of the
// bend, the slope alone bounds how far off.
CellCut::Side CellCut::classify_samples(const CellFace& face, const Cell& cell, Tangent& t) {
  const SolidView& view = *face.field;
  const std::array<double, 9>& f = cell.samples[face.owner];
  const double radius = cell.half.norm();
  if (f[0] >= radius) return Side::kOutside;
  if (f[0] <= -radius) return Side::kInside;
  t.seam = t.cone = false;
  t.bend = Bend::kFlat;
  t.level = f[0];
  Vec3 difference = Vec3::Zero();
  for (int i = 0; i < 8; ++i) difference += 0.125 * f[i + 1] * corner_signs(i);
  t.slope = difference.cwiseQuotient(cell.half);
  const double across = difference.cwiseAbs().sum();
  // Within a cell of this size the function stays where the bound of its bend holds.
  const bool bounded = 4.0 * view.bend_bound * radius <= 1.0;
  const double bend = bounded ? 1.25 * view.bend_bound * radius * radius : kInfinity;
  t.most = t.slack = std::min(bend, radius + across);
  if (t.level >= across + t.slack) return Side::kOutside;
  if (t.level <= -across - t.slack) return Side::kInside;
  return Side::kThrough;
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

}  // namespace volcontact
