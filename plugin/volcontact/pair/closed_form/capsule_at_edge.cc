// SPDX-License-Identifier: Apache-2.0
// Where an edge lies in a capsule, and how far what it leaves reaches.
#include "volcontact/pair/closed_form/capsule_at_edge.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace volcontact {
namespace {

constexpr double kLeastSine = 1e-3;    // of the angle between the planes
constexpr double kLeastDepth = 1e-12;  // of the edge below the surface, in radii
constexpr double kParallel = 1e-12;    // squared sine of the edge to the axis
constexpr double kOnAxis = 1e-6;       // distance of the edge from the axis, in radii
constexpr double kLevel = 1e-12;       // sine of a plane to the axis
constexpr double kSamePlace = 1e-14;   // of the size of the solid

}  // namespace

CapsuleAtEdge::CapsuleAtEdge(double radius, double half_length, const FaceMet& first,
                             const FaceMet& second)
    : faces_{first, second}, sections_{radius, half_length, Vec3::Zero(), Vec3::Zero(), 0.0} {
  is_cut_ = find_edge() && find_middle();
}

bool CapsuleAtEdge::find_edge() {
  const Vec3 &n = faces_[0].normal, &m = faces_[1].normal;
  const Vec3 across = m.cross(n);
  const double sine = across.norm(), cosine = n.dot(m);
  if (!(sine > kLeastSine)) return false;
  opening_ = kPi - std::atan2(sine, cosine);
  const Vec3 along = across / sine;
  X_AE_.rotation = Mat3::with_columns(along.cross(n), -n, along);
  const double a = -faces_[0].height, b = -faces_[1].height, per_square = 1.0 / (sine * sine);
  X_AE_.translation = (per_square * (a - b * cosine)) * n + (per_square * (b - a * cosine)) * m;
  return true;
}

// The place of the edge that is nearest to the axis, and the middle of its part in the solid.
bool CapsuleAtEdge::find_middle() {
  const double radius = sections_.radius, half_length = sections_.half_length;
  const Vec3 along = X_AE_.rotation.col(2);
  Vec3 x = X_AE_.translation;  // at right angles to the edge
  const double lean = 1.0 - square_of(along.z());
  const double z = std::clamp(lean > kParallel ? x.z() / lean : 0.0, -half_length, half_length);
  x = x + (z * along.z()) * along;
  Vec3 out = x - Vec3(0.0, 0.0, z);
  const double distance = out.norm(), depth = radius - distance;
  if (!(depth > kLeastDepth * radius)) return false;
  const double to = way_out(x, along), from = -way_out(x, -along);
  X_AE_.translation = x + 0.5 * (to + from) * along;
  sections_.half_edge = 0.5 * (to - from);
  sections_.origin = X_AE_.rotation.transposed_times(-X_AE_.translation);
  sections_.axis = X_AE_.rotation.transposed_times(Vec3::UnitZ());
  if (!(distance > kOnAxis * radius)) {
    out = lean > kParallel ? along.cross(Vec3::UnitZ()) : X_AE_.rotation.col(0);
  }
  find_flat(x, out.normalized(), depth);
  return true;
}

// Next to where the solid is thinnest, `out` of it, sections along the surface are the longest.
void CapsuleAtEdge::find_flat(const Vec3& nearest, const Vec3& out, double depth) {
  const Vec3 flat = out.cross(X_AE_.rotation.col(2)).normalized();
  flat_angle_ = std::atan2(flat.dot(X_AE_.rotation.col(1)), flat.dot(X_AE_.rotation.col(0)));
  out_angle_ = std::atan2(out.dot(X_AE_.rotation.col(1)), out.dot(X_AE_.rotation.col(0)));
  flat_scale_ = 4.0 * depth / (way_out(nearest, flat) + way_out(nearest, -flat));
}

// From a place within along a unit vector: through the cylinder, or through a round end.
double CapsuleAtEdge::way_out(const Vec3& from, const Vec3& along) const {
  const double radius = sections_.radius, half_length = sections_.half_length;
  const auto root = [](double a, double b, double c) {  // a s^2 + 2 b s = c, c >= 0: the larger s
    const double d = std::sqrt(b * b + a * std::max(0.0, c));
    return b > 0.0 ? std::max(0.0, c) / (b + d) : (d - b) / a;
  };
  double end = std::copysign(half_length, along.z());
  const double a = square_of(along.x()) + square_of(along.y());
  if (half_length > 0.0 && a > square_of(kLevel)) {
    const double away = std::hypot(from.x(), from.y());
    const double s =
        root(a, along.x() * from.x() + along.y() * from.y(), (radius - away) * (radius + away));
    const double z = from.z() + s * along.z();
    if (std::abs(z) <= half_length) return s;
    end = std::copysign(half_length, z);
  }
  const Vec3 p = from - Vec3(0.0, 0.0, end);
  const double away = p.norm();
  return root(1.0, p.dot(along), (radius - away) * (radius + away));
}

bool CapsuleAtEdge::is_behind(int face, const Vec3& x) const {
  const FaceMet& f = faces_[static_cast<std::size_t>(face)];
  const double size = sections_.radius + sections_.half_length;
  return f.normal.dot(x) + f.height <= kSamePlace * size;
}

// The farthest place along e of what of the solid is in the plane of a face. It is made of discs
// about the axis, of which the best is where the slope vanishes. False if it is not behind the
// other face.
bool CapsuleAtEdge::reaches_in_face(const Vec3& e, int face, double& reach) const {
  const double radius = sections_.radius, half_length = sections_.half_length;
  const FaceMet& f = faces_[static_cast<std::size_t>(face)];
  const double rise = f.normal.z(), upright = e.dot(f.normal);
  const Vec3 flat = e - upright * f.normal;
  const double length = flat.norm(), slope = e.z() - rise * upright;
  double z = std::copysign(half_length, slope);
  if (std::abs(rise) > kLevel) {
    const double size = std::hypot(slope, length * rise);
    const double best = size > 0.0 ? std::copysign(radius, rise) * slope / size : 0.0;
    z = std::clamp((best - f.height) / rise, -half_length, half_length);
    // No farther than the solid is in the plane.
    const double p = (-radius - f.height) / rise, q = (radius - f.height) / rise;
    z = std::min(std::max(z, std::min(p, q)), std::max(p, q));
  }
  const double height = rise * z + f.height, disc = (radius - height) * (radius + height);
  if (!(std::abs(z) <= half_length && disc >= 0.0)) return false;
  const double out = length > 0.0 ? std::sqrt(disc) / length : 0.0;
  const Vec3 x = Vec3(0.0, 0.0, z) - height * f.normal + out * flat;
  reach = e.dot(x);
  return is_behind(1 - face, x);
}

// By the place of the solid that is farthest along e, or the one in a face, or on the edge.
double CapsuleAtEdge::reach(const Vec3& along) const {
  const double length = along.norm();
  if (!(length > 0.0)) return 0.0;
  const Vec3 e = along / length;
  const Vec3 farthest =
      sections_.radius * e + Vec3(0.0, 0.0, std::copysign(sections_.half_length, e.z()));
  if (is_behind(0, farthest) && is_behind(1, farthest)) return length * e.dot(farthest);
  double most =
      e.dot(X_AE_.translation) + sections_.half_edge * std::abs(e.dot(X_AE_.rotation.col(2)));
  for (const int face : {0, 1}) {
    double here = 0.0;
    if (reaches_in_face(e, face, here)) most = std::max(most, here);
  }
  return length * most;
}

// A column that starts at x ends at x + t n in the first of the two faces that it meets. The height
// over the other face is linear in x if the column ends in a given one of them: no less.
bool CapsuleAtEdge::is_roof_behind(const FaceMet& other, const Vec3& n) const {
  const double rise = other.normal.dot(n);
  if (!(rise > 0.0)) return true;
  for (const FaceMet& f : faces_) {
    const double rate = rise / f.normal.dot(n);
    const double height = reach(other.normal - rate * f.normal) - rate * f.height;
    if (other.height + height <= 0.0) return true;
  }
  return false;
}

}  // namespace volcontact
