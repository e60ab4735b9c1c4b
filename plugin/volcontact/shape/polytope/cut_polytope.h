// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "volcontact/shape/polytope/polytope_graph.h"

namespace volcontact {

/// A face of the cut polytope: `count` vertices from `first` on in loop_vertices(),
/// counterclockwise seen from outside.
struct FaceLoop {
  int face;
  int first;
  int count;
  double area;  ///< for the caller's use
};

/// A convex polytope being cut by planes. The three-valent graph stays a closed oriented surface
/// whatever the rounding of the heights, so a sum over its faces never leaks or counts twice. Keeps
/// its memory from one use to the next. docs/theory.md, "Clipping".
class CutPolytope {
 public:
  /// Takes the graph; the points are then to be filled in by the caller.
  void start(const PolytopeGraph& graph);

  int size() const { return count_; }
  std::span<Vec3> points() { return {points_.data(), static_cast<std::size_t>(count_)}; }
  std::span<const Vec3> points() const {
    return {points_.data(), static_cast<std::size_t>(count_)};
  }

  /// Keeps what lies at heights <= 0 over the plane, where height(point) is a linear function.
  /// A plane that no vertex exceeds by more than `tolerance` [m] changes nothing. The new face gets
  /// the number `face`. Returns false when nothing is left.
  template <typename Height>
  bool cut(Height&& height, int face, double tolerance) {
    double highest = -1.0;
    for (int v = 0; v < count_; ++v) {
      heights_[v] = height(points_[v]);
      highest = v == 0 ? heights_[v] : (heights_[v] > highest ? heights_[v] : highest);
    }
    return highest > tolerance ? split(face, tolerance) : count_ > 0;
  }

  /// The faces of what is left. Ends the cutting: start() comes next.
  std::span<FaceLoop> faces();
  const std::vector<int>& loop_vertices() const { return loop_vertices_; }
  /// The face on the other side of the edge from entry `i` of loop_vertices() to the next.
  int face_across(int i) const {
    const int face = face_[twin_[loop_edges_[i]]];
    return face < 0 ? ~face : face;
  }

 private:
  bool split(int face, double tolerance);
  void add_vertex(int half_edge, int face);
  void link_new_vertices(int old_count);
  void drop_outside(int old_count, double tolerance);
  void reserve(int vertices);

  static int next_slot(int half_edge) {
    return (half_edge & 3) == 2 ? half_edge - 2 : half_edge + 1;
  }

  int count_ = 0;
  std::vector<Vec3> points_;
  std::vector<double> heights_;
  std::vector<int> twin_;   // as in PolytopeGraph
  std::vector<int> face_;   // the complement (~) once its loop is listed
  std::vector<int> outer_;  // half-edge, outside, that led to a new vertex
  std::vector<FaceLoop> loops_;
  std::vector<int> loop_vertices_;
  std::vector<int> loop_edges_;
};

}  // namespace volcontact
