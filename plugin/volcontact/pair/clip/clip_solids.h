// SPDX-License-Identifier: Apache-2.0
#pragma once

// The two solids of a clip, as planes normal . x <= offset in A's axes about a local origin near
// both, and the cutting of B by the planes of A. Part of clip.cc.
#include <algorithm>
#include <span>
#include <vector>

#include "volcontact/pair/clip/box_faces.h"
#include "volcontact/pair/clip/clip.h"

namespace volcontact::clipping {

struct AlignedBox {  // the box A
  static constexpr bool kHasUprightSides = true;
  Vec3 half;
  Vec3 origin;
  int size() const { return 6; }
  Vec3 normal(int f) const { return (f & 1 ? 1.0 : -1.0) * Vec3::Unit(f >> 1); }
  double offset(int f) const { return half[f >> 1] - (f & 1 ? origin[f >> 1] : -origin[f >> 1]); }
};

struct PosedBox {  // the box B
  static constexpr bool kHasUprightSides = true;
  const Vec3& half;
  const Mat3& rotation;
  Vec3 center;
  int size() const { return 6; }
  Vec3 normal(int f) const { return box_normal(f, rotation); }
  double offset(int f) const { return half[f >> 1] + normal(f).dot(center); }
};

struct AlignedPolytope {  // the polytope A
  static constexpr bool kHasUprightSides = false;
  const ConvexPolytope& solid;
  Vec3 origin;
  int size() const { return static_cast<int>(solid.faces().size()); }
  const Vec3& normal(int f) const { return solid.faces()[f].normal; }
  double offset(int f) const { return solid.faces()[f].offset - normal(f).dot(origin); }
};

struct PosedPolytope {  // the polytope B
  static constexpr bool kHasUprightSides = false;
  const ConvexPolytope& solid;
  const Mat3& rotation;
  Vec3 translation;
  int size() const { return static_cast<int>(solid.faces().size()); }
  Vec3 normal(int f) const { return rotation * solid.faces()[f].normal; }
  double offset(int f) const { return solid.faces()[f].offset + normal(f).dot(translation); }
};

// The graph of a box whose faces have the numbers from `first_face` on.
inline PolytopeGraph graph_with_faces_from(int first_face) {
  std::vector<Vec3> corners(8);
  place_corners(Vec3::Ones(), Mat3::Identity(), Vec3::Zero(), corners.data());
  std::vector<std::vector<int>> loops;
  for (const auto& loop : kBoxLoops) loops.emplace_back(std::begin(loop), std::end(loop));
  PolytopeGraph graph = make_polytope_graph(corners, loops);
  for (int& face : graph.face) face += first_face;
  return graph;
}

inline void start(const PosedBox& b, ClipScratch& scratch) {
  static const PolytopeGraph graph = graph_with_faces_from(0);
  scratch.polytope.start(graph);
  place_corners(b.half, b.rotation, b.center, scratch.polytope.points().data());
}

// With the box A, to be cut by the planes of another one.
inline void start(const AlignedBox& a, ClipScratch& scratch) {
  static const PolytopeGraph graph = graph_with_faces_from(6);
  scratch.polytope.start(graph);
  place_corners(a.half, Mat3::Identity(), -a.origin, scratch.polytope.points().data());
}

inline void start(const PosedPolytope& b, ClipScratch& scratch) {
  scratch.corners.clear();
  for (const Vec3& v : b.solid.vertices()) {
    scratch.corners.push_back(b.rotation * v + b.translation);
  }
  const PolytopeGraph& graph = b.solid.graph();
  scratch.polytope.start(graph);
  const std::span<Vec3> points = scratch.polytope.points();
  for (std::size_t v = 0; v < points.size(); ++v) points[v] = scratch.corners[graph.corner[v]];
}

// --- Cutting B by A's planes; false when nothing is left. A's faces are numbered after B's,
// `middle` is a point in the middle of B.

inline Aabb bounds_of(std::span<const Vec3> points) {
  Aabb box{points[0], points[0]};
  for (const Vec3& p : points) {
    box.min = box.min.cwiseMin(p);
    box.max = box.max.cwiseMax(p);
  }
  return box;
}

inline bool cut(const AlignedBox& a, int face, int first_face, double rounding,
                CutPolytope& polytope) {
  const int axis = face >> 1;
  const double offset = a.offset(face);
  const auto above = [=](const Vec3& p) { return p[axis] - offset; };
  const auto below = [=](const Vec3& p) { return -p[axis] - offset; };
  return face & 1 ? polytope.cut(above, first_face + face, rounding)
                  : polytope.cut(below, first_face + face, rounding);
}

// The plane that leaves least of B goes first: the later cuts then find little to do.
inline bool cut(const AlignedBox& a, const Vec3&, int first_face, double rounding,
                CutPolytope& polytope) {
  const Aabb box = bounds_of(polytope.points());
  const Vec3 per_extent = (box.max - box.min).cwiseInverse();
  int deepest = 0;
  double least = kInfinity;
  for (int f = 0; f < 6; ++f) {
    const int axis = f >> 1;
    const double left = a.offset(f) + (f & 1 ? -box.min[axis] : box.max[axis]);
    const double share = left * per_extent[axis];
    if (share < least) {
      least = share;
      deepest = f;
    }
  }
  if (!cut(a, deepest, first_face, rounding, polytope)) return false;
  for (int f = 0; f < 6; ++f) {
    const int axis = f >> 1;
    const double excess = (f & 1 ? box.max[axis] : -box.min[axis]) - a.offset(f);
    if (f == deepest || !(excess > rounding)) continue;
    if (!cut(a, f, first_face, rounding, polytope)) return false;
  }
  return true;
}

// How far a box reaches over each face of another one; pose of its axes and centre in those of the
// other.
struct Excess {
  Excess(const Vec3& half, const Mat3& R, const Vec3& p, const Vec3& other_half)
      : reach(R.cwiseAbs() * half), over(reach - other_half), center(p) {}
  double operator()(int face) const {
    return over[face >> 1] + (face & 1 ? center[face >> 1] : -center[face >> 1]);
  }
  int count(double rounding) const {
    int faces = 0;
    for (int f = 0; f < 6; ++f) faces += (*this)(f) > rounding;
    return faces;
  }
  Vec3 reach, over, center;
};

// Cuts the box A by those planes of B over which it reaches, the one that leaves least first.
inline bool cut(const PosedBox& b, const Excess& excess, double rounding, CutPolytope& polytope) {
  const auto cut_by = [&](int face) {
    const Vec3 normal = b.normal(face);
    const double offset = b.offset(face);
    return polytope.cut([&](const Vec3& p) { return normal.dot(p) - offset; }, face, rounding);
  };
  int deepest = 0;
  double most = -kInfinity;
  for (int f = 0; f < 6; ++f) {
    const double share = excess(f) / excess.reach[f >> 1];
    if (share > most) {
      most = share;
      deepest = f;
    }
  }
  if (!cut_by(deepest)) return false;
  for (int f = 0; f < 6; ++f) {
    if (f != deepest && excess(f) > rounding && !cut_by(f)) return false;
  }
  return true;
}

inline bool cut(const AlignedPolytope& a, int face, int first_face, double rounding,
                CutPolytope& polytope) {
  const Vec3& normal = a.normal(face);
  const double offset = a.offset(face);
  return polytope.cut([&](const Vec3& p) { return normal.dot(p) - offset; }, first_face + face,
                      rounding);
}

inline bool cut(const AlignedPolytope& a, const Vec3& middle, int first_face, double rounding,
                CutPolytope& polytope) {
  int deepest = 0;
  double highest = -kInfinity;
  for (int f = 0; f < a.size(); ++f) {
    const double height = a.normal(f).dot(middle) - a.offset(f);
    if (height > highest) {
      highest = height;
      deepest = f;
    }
  }
  if (!cut(a, deepest, first_face, rounding, polytope)) return false;
  const Aabb left = bounds_of(polytope.points());
  const Vec3 center = left.center(), half = left.half_sizes();
  for (int f = 0; f < a.size(); ++f) {
    const double reach = a.normal(f).dot(center) + a.normal(f).cwiseAbs().dot(half);
    if (f == deepest || !(reach > a.offset(f))) continue;
    if (!cut(a, f, first_face, rounding, polytope)) return false;
  }
  return true;
}

}  // namespace volcontact::clipping
