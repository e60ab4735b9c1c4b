// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/polytope/polytope_graph.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace volcontact::polytope_graph_test {
namespace {

// Corners of the face that lies left of a half-edge, without the repetitions of split corners.
std::vector<int> walk(const PolytopeGraph& graph, int start) {
  std::vector<int> loop;
  int half_edge = start;
  do {
    const int corner = graph.corner[half_edge >> 2];
    if (loop.empty() || loop.back() != corner) loop.push_back(corner);
    const int twin = graph.twin[half_edge];
    half_edge = (twin & ~3) + ((twin & 3) + 1) % 3;
  } while (half_edge != start);
  if (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
  std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
  return loop;
}

void expect_graph_of(const std::vector<Vec3>& corners, const std::vector<std::vector<int>>& loops) {
  const PolytopeGraph graph = make_polytope_graph(corners, loops);
  const int vertices = static_cast<int>(graph.points.size());
  // A three-valent graph with these faces on a sphere has 2 F - 4 vertices (Euler).
  EXPECT_EQ(vertices, 2 * static_cast<int>(loops.size()) - 4);
  for (int v = 0; v < vertices; ++v) {
    EXPECT_EQ(graph.points[v], corners[graph.corner[v]]);
    for (int h = 4 * v; h < 4 * v + 3; ++h) {
      EXPECT_EQ(graph.twin[graph.twin[h]], h);
      std::vector<int> loop = loops[graph.face[h]];
      std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
      EXPECT_EQ(walk(graph, h), loop);
    }
  }
}

TEST(PolytopeGraph, OfATetrahedronIsItself) {
  expect_graph_of({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)},
                  {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
}

TEST(PolytopeGraph, SplitsTheApexOfAPyramid) {
  expect_graph_of({Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1)},
                  {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}});
}

TEST(PolytopeGraph, SplitsEveryCornerOfAnOctahedron) {
  expect_graph_of(
      {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)},
      {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}});
}

}  // namespace
}  // namespace volcontact::polytope_graph_test
