// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/window/overlap_window.h"

#include <algorithm>
#include <cmath>

#include "volcontact/pair/convex/separation.h"

namespace volcontact {
namespace {

constexpr int kMostCuts = 48;
constexpr int kRound = 4;            // cuts between two looks at the progress
constexpr double kWorthwhile = 0.7;  // a round must shrink the hull to less than this
constexpr double kPreferred = 0.9;   // a later frame must beat an earlier one by this much
constexpr double kLeastCut = 1e-9;   // at a corner, of its way to the solid: less is rounding
constexpr int kMostHeightCuts = 64;
constexpr double kHeightKnown = 1e-5;  // of a height over a place within

// Numbers of the hull's faces: below 6 those of the first bounding box, then who cut.
constexpr int kCutByA = 6, kCutByB = 7;

// One solid as seen from the hull's frame H.
struct Posed {
  const SolidView* view;
  Pose X_SH;
  int face;

  double signed_distance(const Vec3& p_H) const {
    return view->signed_distance(view->solid, X_SH * p_H);
  }
};

struct Plane {
  Vec3 normal;
  double offset;
};

// Cuts by the planes of the solid's bounding box.
bool cut_by_bounds(const Posed& posed, CutPolytope& hull) {
  for (int i = 0; i < 3; ++i) {
    const Vec3 axis = posed.X_SH.rotation.row(i);
    const double origin = posed.X_SH.translation[i];
    for (const double side : {1.0, -1.0}) {
      const double edge = side > 0.0 ? posed.view->bounds.max[i] : -posed.view->bounds.min[i];
      if (!std::isfinite(edge)) continue;
      const auto height = [&](const Vec3& p) { return side * (axis.dot(p) + origin) - edge; };
      if (!hull.cut(height, posed.face, 0.0)) return false;
    }
  }
  return true;
}

// Which part of the way from p to another place lies before the solid; 0 where it does not meet it.
double way_outside(const Posed& posed, const Vec3& p_H, const Vec3& to_H) {
  const Vec3 d_S = posed.X_SH.rotation * (to_H - p_H);
  if (!(d_S.squaredNorm() > 0.0)) return 0.0;
  const RayInterval span = posed.view->ray(posed.view->solid, posed.X_SH * p_H, d_S);
  return !span.empty() && std::isfinite(span.enter) ? std::max(span.enter, 0.0) : 0.0;
}

// A supporting plane of the solid that cuts off the outside point p. Taken where the line from p to
// the middle of the hull enters the solid, which in a shallow contact is near the rim of the
// overlap.
Plane cutting_plane(const Posed& posed, const Vec3& p_H, const Vec3& middle_H) {
  const SolidView& view = *posed.view;
  const Vec3 p_S = posed.X_SH * p_H;
  const Vec3 at_S = posed.X_SH * (p_H + way_outside(posed, p_H, middle_H) * (middle_H - p_H));
  Vec3 normal_S = view.gradient(view.solid, at_S);
  double offset = view.support_height(view.solid, normal_S);
  // At an edge the entry point's normal is not unique.
  if (!(normal_S.dot(p_S) - offset > kLeastCut * (p_S - at_S).norm())) {
    normal_S = view.gradient(view.solid, p_S);
    offset = view.support_height(view.solid, normal_S);
  }
  return {posed.X_SH.rotation.transpose() * normal_S,
          offset - normal_S.dot(posed.X_SH.translation)};
}

Vec3 middle_of(const CutPolytope& hull) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : hull.points()) sum += p;
  return sum / hull.size();
}

// Proportional to the volume, roughly; compares two states of one hull.
double size_of(const CutPolytope& hull) {
  const Vec3 middle = middle_of(hull);
  Mat3 spread = Mat3::Zero();
  for (const Vec3& p : hull.points()) spread += outer(p - middle, p - middle);
  return std::sqrt(std::max(0.0, (spread / hull.size()).determinant()));
}

// Cuts off the corner that sticks out most. False when nothing sticks out or nothing is left.
bool cut_worst_corner(const Posed (&solids)[2], CutPolytope& hull) {
  double worst = 0.0;
  const Posed* outside_of = nullptr;
  Vec3 corner;
  for (const Posed& posed : solids) {
    if (!posed.view->convex) continue;
    for (const Vec3& p : hull.points()) {
      const double distance = posed.signed_distance(p);
      if (!(distance > worst)) continue;
      worst = distance;
      outside_of = &posed;
      corner = p;
    }
  }
  if (!outside_of) return false;
  const Plane plane = cutting_plane(*outside_of, corner, middle_of(hull));
  const auto height = [&](const Vec3& p) { return plane.normal.dot(p) - plane.offset; };
  return hull.cut(height, outside_of->face, 0.0);
}

void shrink(const Posed (&solids)[2], CutPolytope& hull) {
  double size = size_of(hull);
  for (int cuts = 0; cuts < kMostCuts; cuts += kRound) {
    for (int i = 0; i < kRound; ++i) {
      if (!cut_worst_corner(solids, hull)) return;
    }
    const double now = size_of(hull);
    if (now > kWorthwhile * size && cuts >= 2 * kRound) return;
    size = now;
  }
}

// Area vector of the faces that stem from one solid. Ends the cutting.
Vec3 area_vector_of(int cut_by, bool of_start, CutPolytope& hull) {
  Vec3 sum = Vec3::Zero();
  const auto points = hull.points();
  for (const FaceLoop& loop : hull.faces()) {
    if (loop.face != cut_by && !(of_start && loop.face < kCutByA)) continue;
    const int* index = hull.loop_vertices().data() + loop.first;
    for (int i = 2; i < loop.count; ++i) {
      sum += (points[index[i - 1]] - points[index[0]]).cross(points[index[i]] - points[index[0]]);
    }
  }
  return 0.5 * sum;
}

struct Fit {
  Mat3 rotation;  // R_HW
  Vec3 low, high;
  double volume = kInfinity;
};

Fit fit(const CutPolytope& hull, const Mat3& R_HW) {
  Fit result{R_HW, Vec3::Constant(kInfinity), Vec3::Constant(-kInfinity), 0.0};
  for (const Vec3& p : hull.points()) {
    const Vec3 p_W = R_HW.transpose() * p;
    result.low = result.low.cwiseMin(p_W);
    result.high = result.high.cwiseMax(p_W);
  }
  result.volume = (result.high - result.low).prod();
  return result;
}

// The smallest box around the hull with the axes of A, of B, or with z along the contact normal and
// x along an axis of A or B as seen in the contact plane.
Fit best_fit(const CutPolytope& hull, const Mat3& R_HA, const Mat3& R_HB, const Vec3& contact_H) {
  Fit best = fit(hull, R_HA);
  const auto compare = [&](const Mat3& R_HW) {
    const Fit other = fit(hull, R_HW);
    if (other.volume < kPreferred * best.volume) best = other;
  };
  compare(R_HB);
  const double length = contact_H.norm();
  if (!(length > 0.0)) return best;
  const Vec3 z = contact_H / length;
  for (const Mat3& axes : {R_HA, R_HB}) {
    for (int i = 0; i < 3; ++i) {
      const Vec3 across = axes.col(i) - z.dot(axes.col(i)) * z;
      if (across.squaredNorm() < 0.1) continue;
      Mat3 R_HW;
      R_HW.col(0) = across.normalized();
      R_HW.col(2) = z;
      R_HW.col(1) = z.cross(R_HW.col(0));
      compare(R_HW);
    }
  }
  return best;
}

bool bounds_apart(const SolidView& a, const SolidView& b, const Pose& X_AB) {
  if (!a.bounds.bounded() || !b.bounds.bounded()) return false;
  return boxes_apart(a.bounds.half_sizes(), b.bounds.half_sizes(), X_AB.rotation,
                     X_AB * b.bounds.center() - a.bounds.center());
}

}  // namespace

OverlapWindow find_window(const SolidView& a, const SolidView& b, const Pose& X_AB,
                          CutPolytope& hull_W, CutPolytope& scratch) {
  OverlapWindow window;
  if (bounds_apart(a, b, X_AB)) {
    window.apart = true;
    return window;
  }
  // The hull starts as the smaller bounding box, with its origin in the middle of it.
  const bool from_b =
      !a.bounds.bounded() ||
      (b.bounds.bounded() && b.bounds.half_sizes().prod() < a.bounds.half_sizes().prod());
  const Aabb& start = from_b ? b.bounds : a.bounds;
  Pose X_AH = from_b ? X_AB : Pose{};
  X_AH.translation = X_AH * start.center();
  const Posed solids[2] = {{&a, X_AH, kCutByA}, {&b, X_AB.inverse() * X_AH, kCutByB}};
  const Posed& other = solids[from_b ? 0 : 1];

  CutPolytope& hull = hull_W;  // in H until the end
  hull.start(box_graph());
  const Vec3 half = start.half_sizes();
  for (int i = 0; i < 8; ++i) hull.points()[i] = half.cwiseProduct(corner_signs(i));
  window.apart = !cut_by_bounds(other, hull);
  if (!window.apart) shrink(solids, hull);
  window.apart |= hull.size() == 0;
  if (window.apart) return window;

  scratch = hull;
  const Vec3 contact_H = area_vector_of(kCutByA, !from_b, scratch);
  const Mat3 R_HA = X_AH.rotation.transpose();
  const Fit box = best_fit(hull, R_HA, R_HA * X_AB.rotation, contact_H);
  const Pose X_HW{box.rotation, box.rotation * (0.5 * (box.low + box.high))};
  window.X_AW = X_AH * X_HW;
  window.X_BW = solids[1].X_SH * X_HW;
  const Pose X_WH = X_HW.inverse();
  for (Vec3& p : hull_W.points()) p = X_WH * p;
  return window;
}

double overlap_height(const SolidView& a, const SolidView& b, const OverlapWindow& window,
                      const CutPolytope& hull_W, const Vec3& inside_W, const Vec3& e,
                      CutPolytope& scratch) {
  const Posed solids[2] = {{&a, window.X_AW, kCutByA}, {&b, window.X_BW, kCutByB}};
  const double base = e.dot(inside_W);
  double height = base;
  scratch = hull_W;
  for (int cuts = 0; cuts < kMostHeightCuts && scratch.size() > 0; ++cuts) {
    Vec3 corner = scratch.points()[0];
    for (const Vec3& p : scratch.points()) {
      if (e.dot(p) > e.dot(corner)) corner = p;
    }
    const double way[2] = {way_outside(solids[0], corner, inside_W),
                           way_outside(solids[1], corner, inside_W)};
    const int outside_of = way[0] >= way[1] ? 0 : 1;
    const double highest = e.dot(corner);
    height = std::max(height, highest - way[outside_of] * (highest - base));
    if (!(highest - height > kHeightKnown * (height - base))) break;
    const Plane plane = cutting_plane(solids[outside_of], corner, inside_W);
    const auto over = [&](const Vec3& p) { return plane.normal.dot(p) - plane.offset; };
    if (!(over(corner) > 0.0) || !scratch.cut(over, outside_of, 0.0)) break;
  }
  return height;
}

}  // namespace volcontact
