// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/polytope/convex_polytope.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "volcontact/base/fields.h"
#include "volcontact/shape/mesh/tetrahedron_sum.h"
#include "volcontact/shape/polytope/convex_hull.h"

namespace volcontact {
namespace {

// Neighbouring triangles are one face when all their corners lie within this fraction of the size
// from one plane: well above the rounding of rotated vertices, well below what a volume could show.
constexpr double kCoplanar = 1e-13;

using Loop = std::vector<int>;

double area_of(const Triangle& t, const std::vector<Vec3>& points) {
  return 0.5 * (points[t[1]] - points[t[0]]).cross(points[t[2]] - points[t[0]]).norm();
}

Vec3 twice_area_vector(const Loop& loop, const std::vector<Vec3>& points) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 2; i < loop.size(); ++i) {
    sum += (points[loop[i - 1]] - points[loop[0]]).cross(points[loop[i]] - points[loop[0]]);
  }
  return sum;
}

// Groups the triangles of a hull into faces. Grown from the largest triangle of each group, whose
// plane alone decides, so that the group cannot drift around a finely faceted curve.
std::vector<std::vector<int>> coplanar_groups(const std::vector<Triangle>& triangles,
                                              const std::vector<Vec3>& points, double tolerance) {
  std::map<std::pair<int, int>, int> triangle_at;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      triangle_at[{triangles[t][i], triangles[t][(i + 1) % 3]}] = static_cast<int>(t);
    }
  }
  std::vector<double> areas;
  for (const Triangle& t : triangles) areas.push_back(area_of(t, points));
  std::vector<int> order(triangles.size());
  for (std::size_t t = 0; t < order.size(); ++t) order[t] = static_cast<int>(t);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return areas[a] > areas[b]; });

  std::vector<bool> taken(triangles.size(), false);
  std::vector<std::vector<int>> groups;
  for (int seed : order) {
    if (taken[seed]) continue;
    const Vec3 origin = points[triangles[seed][0]];
    const Vec3 normal =
        twice_area_vector({triangles[seed].begin(), triangles[seed].end()}, points).normalized();
    const auto in_plane = [&](const Triangle& t) {
      return std::all_of(t.begin(), t.end(), [&](int corner) {
        return std::abs(normal.dot(points[corner] - origin)) <= tolerance;
      });
    };
    std::vector<int> group{seed};
    taken[seed] = true;
    for (std::size_t k = 0; k < group.size(); ++k) {
      const Triangle t = triangles[group[k]];
      for (int i = 0; i < 3; ++i) {
        const int neighbor = triangle_at.at({t[(i + 1) % 3], t[i]});
        if (taken[neighbor] || !in_plane(triangles[neighbor])) continue;
        taken[neighbor] = true;
        group.push_back(neighbor);
      }
    }
    groups.push_back(std::move(group));
  }
  return groups;
}

// Outline of a group of triangles; empty when it is not one simple loop.
Loop outline(const std::vector<int>& group, const std::vector<Triangle>& triangles) {
  std::map<std::pair<int, int>, bool> edges;
  for (int t : group) {
    for (int i = 0; i < 3; ++i) edges[{triangles[t][i], triangles[t][(i + 1) % 3]}] = true;
  }
  std::map<int, int> next;
  for (const auto& [edge, present] : edges) {
    if (edges.count({edge.second, edge.first})) continue;
    if (!next.emplace(edge.first, edge.second).second) return {};
  }
  Loop loop;
  for (int corner = next.begin()->first; loop.empty() || corner != loop[0];
       corner = next.at(corner)) {
    loop.push_back(corner);
  }
  return loop.size() == next.size() ? loop : Loop{};
}

// Takes out corners where only two faces meet, and faces left with two corners, until none is left.
void drop_flat_corners(std::vector<Loop>& loops) {
  for (bool changed = true; changed;) {
    std::map<int, int> faces_at;
    for (const Loop& loop : loops) {
      for (int corner : loop) ++faces_at[corner];
    }
    changed = false;
    for (Loop& loop : loops) {
      changed |= std::erase_if(loop, [&](int corner) { return faces_at[corner] < 3; }) > 0;
    }
    changed |= std::erase_if(loops, [](const Loop& loop) { return loop.size() < 3; }) > 0;
  }
}

// Every edge in exactly two faces, once in each direction, and the surface a sphere.
bool is_closed_surface(const std::vector<Loop>& loops) {
  std::map<std::pair<int, int>, int> edges;
  std::map<int, int> corners;
  for (const Loop& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      ++edges[{loop[i], loop[(i + 1) % loop.size()]}];
      ++corners[loop[i]];
    }
  }
  for (const auto& [edge, count] : edges) {
    if (count != 1 || !edges.count({edge.second, edge.first})) return false;
  }
  return corners.size() + loops.size() == edges.size() / 2 + 2;
}

std::vector<Loop> faces_of_hull(const std::vector<Triangle>& triangles,
                                const std::vector<Vec3>& points, double size) {
  std::vector<Loop> loops, single;
  for (const Triangle& t : triangles) single.emplace_back(t.begin(), t.end());
  for (const auto& group : coplanar_groups(triangles, points, kCoplanar * size)) {
    Loop loop = outline(group, triangles);
    if (!loop.empty()) {
      loops.push_back(std::move(loop));
    } else {
      for (int t : group) loops.push_back(single[t]);
    }
  }
  drop_flat_corners(loops);
  return is_closed_surface(loops) ? loops : single;
}

// A sliver's own normal is noise. Any direction outward will do for it: the plane at support height
// in that direction only touches the solid.
ConvexPolytope::Face make_face(const Loop& loop, const std::vector<Vec3>& vertices,
                               const Vec3& inside, double size) {
  const Vec3 twice_area = twice_area_vector(loop, vertices);
  const bool sliver = twice_area.norm() <= kCoplanar * size * size;
  const Vec3 outward = sliver ? Vec3(vertices[loop[0]] - inside) : twice_area;
  ConvexPolytope::Face face{outward.normalized(), -kInfinity, loop};
  for (const Vec3& v : vertices) face.offset = std::max(face.offset, face.normal.dot(v));
  return face;
}

// Fifth powers of lengths, of which inertia is made, are to be numbers.
void check_size(const std::vector<Vec3>& points) {
  constexpr double kLeast = 1e-50, kMost = 1e50;
  double largest = 0.0;
  for (const Vec3& p : points) {
    largest = std::max(largest, (p - points[0]).cwiseAbs().maxCoeff());
  }
  if (largest >= kLeast && largest <= kMost) return;
  std::ostringstream text;
  text << "convex_polytope: the vertices are up to " << largest << " m apart; must be " << kLeast
       << " to " << kMost;
  throw std::invalid_argument(text.str());
}

}  // namespace

ConvexPolytope::ConvexPolytope(const std::vector<Vec3>& points) {
  const std::vector<Triangle> triangles = convex_hull(points);
  check_size(points);
  auto data = std::make_shared<Data>();
  TetrahedronSum sum{points[triangles[0][0]], {}};
  data->bounds = {sum.origin, sum.origin};
  for (const Triangle& t : triangles) {
    sum.add(points[t[0]], points[t[1]], points[t[2]]);
    for (int corner : t) {
      data->bounds.min = data->bounds.min.cwiseMin(points[corner]);
      data->bounds.max = data->bounds.max.cwiseMax(points[corner]);
    }
  }
  data->metrics = sum.metrics();
  data->surface_area = sum.surface_area;
  const double size = (data->bounds.max - data->bounds.min).norm();
  MeshTopology surface;
  make_topology(points, triangles, surface);
  data->tree = make_obb_tree(surface);

  std::vector<Loop> loops = faces_of_hull(triangles, points, size);
  std::map<int, int> index_of;
  for (Loop& loop : loops) {
    for (int& corner : loop) {
      const auto [entry, is_new] =
          index_of.emplace(corner, static_cast<int>(data->vertices.size()));
      if (is_new) data->vertices.push_back(points[corner]);
      corner = entry->second;
    }
  }
  for (const Loop& loop : loops) {
    data->faces.push_back(make_face(loop, data->vertices, data->metrics.centroid, size));
  }
  data->graph = make_polytope_graph(data->vertices, loops);
  data_ = std::move(data);
}

Vec3 ConvexPolytope::support(const Vec3& e) const {
  const std::vector<Vec3>& vertices = data_->vertices;
  std::size_t best = 0;
  double highest = e.dot(vertices[0]);
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    const double height = e.dot(vertices[i]);
    if (height > highest) {
      highest = height;
      best = i;
    }
  }
  return vertices[best];
}

const ConvexPolytope::Face& ConvexPolytope::nearest_face(const Vec3& p) const {
  const Face* nearest = nullptr;
  double largest = -kInfinity;
  for (const Face& face : data_->faces) {
    const double distance = face.normal.dot(p) - face.offset;
    if (distance > largest || nearest == nullptr) {
      largest = distance;
      nearest = &face;
    }
  }
  return *nearest;
}

double ConvexPolytope::signed_distance(const Vec3& p) const {
  const Face& face = nearest_face(p);
  return face.normal.dot(p) - face.offset;
}

Vec3 ConvexPolytope::gradient(const Vec3& p) const { return nearest_face(p).normal; }

RayInterval ConvexPolytope::ray(const Vec3& o, const Vec3& d) const {
  RayInterval span{-kInfinity, kInfinity};
  for (const Face& face : data_->faces) {
    const double speed = face.normal.dot(d);
    const double gap = face.offset - face.normal.dot(o);
    if (speed == 0.0) {
      if (gap < 0.0) return {};
    } else if (speed > 0.0) {
      span.leave = std::min(span.leave, gap / speed);
    } else {
      span.enter = std::max(span.enter, gap / speed);
    }
  }
  return span.empty() ? RayInterval{} : span;
}

}  // namespace volcontact
