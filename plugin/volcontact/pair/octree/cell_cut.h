// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "volcontact/pair/octree/cell.h"
#include "volcontact/pair/octree/convex_polygon.h"
#include "volcontact/shape/polytope/cut_polytope.h"

namespace volcontact {

/// Works out what a cell contributes: cuts it by the tangent planes of the faces that pass through
/// it and corrects for their bend, whose second derivatives are known exactly, so that estimate and
/// bounds are of third order in the cell size. One per thread; holds scratch memory only.
/// docs/theory.md, "Octree".
///
///   int 1, x, x x^T dV over the cell where F_A <= 0 and F_B <= 0
class CellCut {
 public:
  /// A point on a face, from the cell's centre, and the surface it stands for: n dS, n outward.
  /// Where `sign` is -1 that surface is to be taken off again.
  struct SurfacePoint {
    Vec3 position;
    Vec3 element;
    double sign;
  };

  /// Fills in everything of `cell` but its box and region. `list` and `listed` come in as a guess
  /// of the faces that pass through it (those of its parent) and go out as those that do. A cell
  /// with more doubt than `rough_above` [m^3], which will be divided anyway, is left rough.
  void evaluate(const std::vector<CellFace>& faces, Cell& cell, double rough_above = kInfinity);

  /// Points of a quadrature on triangles, exact to degree 4 when `fine`, else 2, of the surfaces in
  /// the cell that look along `e`: calls visit(point). Each triangle is divided in four `levels`
  /// times.
  template <typename Visit>
  void for_each_surface_point(const std::vector<CellFace>& faces, Cell& cell, const Vec3& e,
                              int levels, bool fine, Visit&& visit) {
    if (!collect(faces, cell) || tangents_.empty()) return;
    cut(cell.half);
    loops_ = polytope_.faces();
    for (const FaceLoop& loop : loops_) {
      const Tangent* tangent = tangent_of(loop);
      if (!tangent || tangent->seam || !looks_along(*tangent, e)) continue;
      sample_surface(*tangent, loop, levels, fine);
      for (const SurfacePoint& point : sample_) visit(point);
    }
  }

  /// Corners of what the tangent planes leave of the cell, from its centre, each drawn back against
  /// the unit vector `e` to the true faces, where that stays within the cell: calls visit(corner).
  template <typename Visit>
  void for_each_corner(const std::vector<CellFace>& faces, Cell& cell, const Vec3& e,
                       Visit&& visit) {
    if (!collect(faces, cell)) return;
    cut(cell.half);
    for (Vec3 corner : polytope_.points()) {
      if (draw_back(cell.half, e, corner)) visit(corner);
    }
  }

 private:
  // A face near the cell: F(x) = level + slope . x + 1/2 d^T H d, d = x - touch, x from the cell's
  // centre. The first two terms are its tangent plane, the last its bend. True up to `slack`.
  struct Tangent {
    int owner = 0;
    bool seam = false;
    bool cone = false;  // the bend term is of one sign between plane and face only
    Bend bend = Bend::kFlat;
    Mat3 hessian = Mat3::Zero();
    Vec3 slope = Vec3::Zero();
    Vec3 touch = Vec3::Zero();
    double level = 0.0;
    double slack = 0.0;
    double most = 0.0;  // |bend term| + slack nowhere exceeds this in the cell

    bool exact() const { return bend == Bend::kFlat && slack == 0.0; }
    double plane(const Vec3& x) const { return level + slope.dot(x); }
    double bend_at(const Vec3& x) const {
      const Vec3 d = x - touch;
      return 0.5 * d.dot(hessian * d);
    }
    // Up to rounding.
    bool on_face(const Vec3& x) const {
      return std::abs(plane(x) + bend_at(x)) <= 1e-11 * slope.norm() * (touch - x).norm();
    }
    // The solid lies within plane <= beyond(), and plane <= -within() lies within the solid.
    double beyond() const { return bend == Bend::kConvex ? slack : exact() ? 0.0 : most; }
    double within() const { return bend == Bend::kConcave ? slack : exact() ? 0.0 : most; }
  };

  // Volume between a tangent plane and its face, positive where it is to be taken off.
  struct Gap {
    double low = 0.0, high = 0.0;
    Vec3 reach = Vec3::Zero();  // of the face's part in the cell, from where the plane touches
  };
  struct Moments {
    double volume = 0.0;
    Vec3 first = Vec3::Zero();
    Mat3 second = Mat3::Zero();
  };
  struct Columns;
  // What bounds the gap, seen along a column: its height there is near(x, y) + slope w, w the way
  // from the tangent plane into the gap. `near` is an under-estimate and `far` an over-estimate, as
  // far as the other face bends.
  struct Limit {
    Linear2 near, far;
    double slope;
    const Tangent* face;  // null: the plane is all there is
    // Heights that are negative where columns of up to this length touch, or lie whole in, the
    // inside.
    Linear2 touched(double length) const { return near.raised(std::min(0.0, slope * length)); }
    Linear2 whole(double length) const { return far.raised(std::max(0.0, slope * length)); }
  };

  enum class Side { kOutside, kThrough, kInside };
  static Side classify(const Quadric& face, const Cell& cell, Tangent& tangent);
  static bool touch_cone(const Quadric& face, const Cell& cell, double value, const Vec3& slope,
                         Tangent& tangent);
  static Side classify_field(const CellFace& face, const Cell& cell, Tangent& tangent);
  static Side classify_samples(const CellFace& face, const Cell& cell, Tangent& tangent);
  bool collect(const std::vector<CellFace>& faces, Cell& cell);
  void cut(const Vec3& half);
  const Tangent* tangent_of(const FaceLoop& loop) const;
  static bool looks_along(const Tangent& tangent, const Vec3& e);
  double polytope_volume() const;
  void add_polytope(CellSums& sums) const;
  void add_surfaces(CellSums& sums);
  struct Foot;
  struct Normal;
  void sample_surface(const Tangent& tangent, const FaceLoop& loop, int levels, bool fine);
  void sample_triangle(const Normal& normal, const Vec3& p, const Vec3& q, const Vec3& r,
                       int levels, bool fine);
  void sample_point(const Normal& normal, const Vec3& x, double weight);
  double room(const Normal& normal, const Vec3& x, const Vec3& outward, int across) const;
  void sample_edge(const Normal& normal, const Vec3& p, const Vec3& q, int across, double area);
  Gap gap_of(int index, const Vec3& half);
  Gap bent_gap(int index, Columns& columns);
  void keep_touched(int index, const Columns& columns);
  struct BentColumns;
  static Limit limit_of(const Tangent& other, const Columns& columns, double from, double to,
                        const ConvexPolygon& polygon);
  static Limit plane_limit(const Tangent& other, const Columns& columns);
  void find_limits(int index, const Columns& columns);
  void add_band(std::size_t k, const BentColumns& bent, Gap& gap);
  void keep_touched_by_rest(std::size_t k, double length);
  void keep_whole_by_rest(std::size_t k, double length);
  void add_strip(std::size_t k, const BentColumns& bent, Gap& gap);
  void add_ended(std::size_t k, const Limit& limit, const BentColumns& bent, Gap& gap);
  void bound(Cell& cell);
  void estimate(Cell& cell);
  void choose_split(Cell& cell) const;
  void enclose(Cell& cell) const;
  void limit_surfaces(Cell& cell) const;
  Vec3 behind_faces(const Cell& cell, const Vec3& from) const;
  void place(Cell& cell) const;
  bool draw_back(const Vec3& half, const Vec3& e, Vec3& corner) const;

  CutPolytope polytope_;
  std::span<FaceLoop> loops_;
  std::vector<SurfacePoint> sample_;
  Moments gap_sample_;  // between plane and face, of the loop last sampled
  ConvexPolygon polygon_, band_, strip_, part_, short_;
  std::vector<Limit> limits_;
  std::vector<Tangent> tangents_;
  bool all_flat_ = false;
  Vec3 half_;                     // of the cell that was cut
  std::vector<Moments> between_;  // plane and face, estimated, by tangent
  std::vector<Gap> gaps_;
};

}  // namespace volcontact
