// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/polytope/polytope_graph.h"

#include <map>
#include <utility>

namespace volcontact {
namespace {

using DirectedEdge = std::pair<int, int>;  // corner to corner

struct Side {
  int face;   // to the left of the edge
  int after;  // the corner that follows in that face
};

using Sides = std::map<DirectedEdge, Side>;

Sides sides_of(const std::vector<std::vector<int>>& loops) {
  Sides sides;
  for (std::size_t f = 0; f < loops.size(); ++f) {
    const std::vector<int>& loop = loops[f];
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const int tail = loop[i], head = loop[(i + 1) % loop.size()];
      sides[{tail, head}] = {static_cast<int>(f), loop[(i + 2) % loop.size()]};
    }
  }
  return sides;
}

// Ends of the edges that leave `corner`, in slot order, starting with `first`.
std::vector<int> fan_of(int corner, int first, const Sides& sides) {
  std::vector<int> fan;
  int end = first;
  do {
    fan.push_back(end);
    end = sides.at({end, corner}).after;
  } while (end != first);
  return fan;
}

class GraphBuilder {
 public:
  GraphBuilder(const std::vector<Vec3>& corners, const std::vector<std::vector<int>>& loops)
      : sides_(sides_of(loops)) {
    std::map<int, int> first_end;
    for (const auto& [edge, side] : sides_) first_end.emplace(edge.first, edge.second);
    for (const auto& [corner, end] : first_end) add_corner(corner, end, corners[corner]);
    for (const auto& [edge, half_edge] : half_edge_of_) {
      graph_.twin[half_edge] = half_edge_of_.at({edge.second, edge.first});
    }
  }
  PolytopeGraph graph() && { return std::move(graph_); }

 private:
  int add_vertex(int corner, const Vec3& point) {
    graph_.points.push_back(point);
    graph_.corner.push_back(corner);
    graph_.twin.resize(4 * graph_.points.size(), 0);
    graph_.face.resize(4 * graph_.points.size(), 0);
    return static_cast<int>(graph_.points.size()) - 1;
  }
  void put_edge(int half_edge, const DirectedEdge& edge) {
    half_edge_of_[edge] = half_edge;
    graph_.face[half_edge] = sides_.at(edge).face;
  }
  // The corner's k edges, spread over a chain of k - 2 vertices: the first vertex has edges 0 and
  // 1, the next ones 2, 3, ..., the last one k - 2 and k - 1; links join them.
  void add_corner(int corner, int first_end, const Vec3& point) {
    const std::vector<int> fan = fan_of(corner, first_end, sides_);
    const int last = static_cast<int>(fan.size()) - 2;
    int previous = -1;
    for (int j = 1; j <= last; ++j) {
      const int v = add_vertex(corner, point);
      if (j == 1) {
        put_edge(4 * v, {corner, fan[0]});
      } else {
        link(previous, v, sides_.at({corner, fan[j]}).face, sides_.at({corner, fan[0]}).face);
      }
      put_edge(4 * v + 1, {corner, fan[j]});
      if (j == last) put_edge(4 * v + 2, {corner, fan[j + 1]});
      previous = v;
    }
  }
  // Edge from slot 2 of `from` to slot 0 of `to`, with its left face in each direction.
  void link(int from, int to, int forward_face, int backward_face) {
    graph_.twin[4 * from + 2] = 4 * to;
    graph_.twin[4 * to] = 4 * from + 2;
    graph_.face[4 * from + 2] = forward_face;
    graph_.face[4 * to] = backward_face;
  }

  Sides sides_;
  std::map<DirectedEdge, int> half_edge_of_;
  PolytopeGraph graph_;
};

}  // namespace

PolytopeGraph make_polytope_graph(const std::vector<Vec3>& corners,
                                  const std::vector<std::vector<int>>& loops) {
  return GraphBuilder(corners, loops).graph();
}

const PolytopeGraph& box_graph() {
  static const PolytopeGraph graph = [] {
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i) corners.push_back(corner_signs(i));
    return make_polytope_graph(
        corners,
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}});
  }();
  return graph;
}

}  // namespace volcontact
