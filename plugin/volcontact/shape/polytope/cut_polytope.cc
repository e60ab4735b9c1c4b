// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/polytope/cut_polytope.h"

#include <algorithm>

namespace volcontact {

void CutPolytope::reserve(int vertices) {
  if (static_cast<int>(points_.size()) >= vertices) return;
  points_.resize(vertices);
  heights_.resize(vertices);
  outer_.resize(vertices);
  twin_.resize(4 * vertices);
  face_.resize(4 * vertices);
  loop_vertices_.resize(3 * vertices);
  loop_edges_.resize(3 * vertices);
  loops_.resize(3 * vertices);
}

void CutPolytope::start(const PolytopeGraph& graph) {
  count_ = static_cast<int>(graph.points.size());
  reserve(count_);
  std::copy(graph.twin.begin(), graph.twin.end(), twin_.begin());
  std::copy(graph.face.begin(), graph.face.end(), face_.begin());
}

// A new vertex on the edge of `half_edge`, which leads from a kept vertex to an outside one.
void CutPolytope::add_vertex(int half_edge, int face) {
  const int v = half_edge >> 2, back = twin_[half_edge], u = back >> 2, w = count_++;
  const double below = std::max(0.0, -heights_[v]);
  points_[w] = points_[v] + below / (below + heights_[u]) * (points_[u] - points_[v]);
  twin_[4 * w] = half_edge;
  twin_[half_edge] = 4 * w;
  twin_[back] = 4 * w;  // so that a walk outside finds its way in
  outer_[w] = back;
  face_[4 * w] = face_[back];
  face_[4 * w + 1] = face_[half_edge];
  face_[4 * w + 2] = face;
}

// From each new vertex along the face outside until the walk meets the next new vertex.
void CutPolytope::link_new_vertices(int old_count) {
  for (int w = old_count; w < count_; ++w) {
    int half_edge = outer_[w];
    do {
      half_edge = twin_[next_slot(half_edge)];
    } while ((half_edge >> 2) < old_count);
    const int next = half_edge >> 2;
    twin_[4 * w + 1] = 4 * next + 2;
    twin_[4 * next + 2] = 4 * w + 1;
  }
}

// Fills the places of outside vertices from the end.
void CutPolytope::drop_outside(int old_count, double tolerance) {
  int end = count_;
  for (int v = 0; v < std::min(old_count, end); ++v) {
    if (!(heights_[v] > tolerance)) continue;
    do {
      --end;
    } while (end > v && end < old_count && heights_[end] > tolerance);
    if (end == v) break;
    points_[v] = points_[end];
    for (int slot = 0; slot < 3; ++slot) {
      const int twin = twin_[4 * end + slot];
      twin_[4 * v + slot] = twin;
      twin_[twin] = 4 * v + slot;
      face_[4 * v + slot] = face_[4 * end + slot];
    }
  }
  count_ = end;
}

bool CutPolytope::split(int face, double tolerance) {
  const int old_count = count_;
  reserve(old_count + 3 * old_count / 2);
  for (int v = 0; v < old_count; ++v) {
    if (heights_[v] > tolerance) continue;
    for (int slot = 0; slot < 3; ++slot) {
      const int u = twin_[4 * v + slot] >> 2;
      if (u < old_count && heights_[u] > tolerance) add_vertex(4 * v + slot, face);
    }
  }
  link_new_vertices(old_count);
  drop_outside(old_count, tolerance);
  return count_ > 0;
}

std::span<FaceLoop> CutPolytope::faces() {
  int loops = 0, end = 0;
  for (int v = 0; v < count_; ++v) {
    for (int start = 4 * v; start < 4 * v + 3; ++start) {
      if (face_[start] < 0) continue;
      FaceLoop& loop = loops_[loops++] = {face_[start], end, 0, 0.0};
      int half_edge = start;
      do {
        face_[half_edge] = ~face_[half_edge];
        loop_edges_[end] = half_edge;
        loop_vertices_[end++] = half_edge >> 2;
        half_edge = next_slot(twin_[half_edge]);
      } while (half_edge != start);
      loop.count = end - loop.first;
    }
  }
  return {loops_.data(), static_cast<std::size_t>(loops)};
}

}  // namespace volcontact
