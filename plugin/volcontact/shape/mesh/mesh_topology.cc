// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/mesh/mesh_topology.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include "volcontact/base/disjoint_sets.h"

namespace volcontact {
namespace {

constexpr double kWeld = 1e-7;  // of the size: the rounding of coordinates stored as floats

std::string text_of(const Vec3& p) {
  std::ostringstream text;
  text << "(" << p.x() << ", " << p.y() << ", " << p.z() << ")";
  return text.str();
}

void check(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
  if (triangles.empty()) {
    throw std::invalid_argument("mesh: no triangles; a closed surface has at least 4");
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (!vertices[i].allFinite()) {
      throw std::invalid_argument("mesh: vertex " + std::to_string(i) + " is " +
                                  text_of(vertices[i]) + "; coordinates must be finite");
    }
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& [a, b, c] = triangles[t];
    if (a == b || b == c || c == a) {
      throw std::invalid_argument("mesh: triangle " + std::to_string(t) + " names vertex " +
                                  std::to_string(b == c ? b : a) +
                                  " twice; a triangle has three corners: leave it out");
    }
    for (int corner : triangles[t]) {
      if (corner < 0 || corner >= static_cast<int>(vertices.size())) {
        throw std::invalid_argument("mesh: triangle " + std::to_string(t) + " names vertex " +
                                    std::to_string(corner) + "; there are " +
                                    std::to_string(vertices.size()) + ", numbered from 0");
      }
    }
  }
}

// Numbers of the vertices after welding those closer than `reach` along every axis (chains of them
// become one), by sorting along x.
std::vector<int> welded_numbers(const std::vector<Vec3>& vertices, double reach) {
  const int count = static_cast<int>(vertices.size());
  std::vector<int> order(count), root;
  std::iota(order.begin(), order.end(), 0);
  make_sets(root, vertices.size());
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    const Vec3 &a = vertices[i], &b = vertices[j];
    if (a.x() != b.x()) return a.x() < b.x();
    if (a.y() != b.y()) return a.y() < b.y();
    if (a.z() != b.z()) return a.z() < b.z();
    return i < j;
  });
  for (int k = 0; k < count; ++k) {
    const Vec3& a = vertices[order[k]];
    for (int m = k + 1; m < count; ++m) {
      const Vec3& b = vertices[order[m]];
      if (b.x() - a.x() > reach) break;
      // Equal vertices stand side by side: with no reach, one comparison is enough.
      const bool near = (b - a).cwiseAbs().maxCoeff() <= reach;
      if (near) join_sets(root, order[k], order[m]);
      if (reach == 0.0 && !near) break;
    }
  }
  for (int i = 0; i < count; ++i) root[i] = root_of(root, i);
  return root;
}

void weld(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles, double reach,
          MeshTopology& topology) {
  const std::vector<int> numbers = welded_numbers(vertices, reach);
  std::vector<int> kept(vertices.size(), -1);
  topology.vertices.clear();
  topology.triangles.clear();
  for (const Triangle& given : triangles) {
    const Triangle t = {numbers[given[0]], numbers[given[1]], numbers[given[2]]};
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    Triangle& out = topology.triangles.emplace_back();
    for (int i = 0; i < 3; ++i) {
      if (kept[t[i]] < 0) {
        kept[t[i]] = static_cast<int>(topology.vertices.size());
        topology.vertices.push_back(vertices[t[i]]);
      }
      out[i] = kept[t[i]];
    }
  }
}

// Pairs half-edges over each edge and counts those that do not pair.
MeshDefects pair_edges(MeshTopology& topology) {
  struct HalfEdge {
    int low, high;
    bool up;
    int number;
  };
  MeshDefects defects;
  const int count = 3 * static_cast<int>(topology.triangles.size());
  std::vector<HalfEdge> edges(count);
  for (int h = 0; h < count; ++h) {
    const Triangle& t = topology.triangles[h / 3];
    const int from = t[h % 3], to = t[(h % 3 + 1) % 3];
    edges[h] = {std::min(from, to), std::max(from, to), from < to, h};
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    if (a.low != b.low) return a.low < b.low;
    if (a.high != b.high) return a.high < b.high;
    return a.number < b.number;
  });
  topology.twins.assign(count, -1);
  std::vector<int> up, down;
  for (int first = 0, last; first < count; first = last) {
    up.clear();
    down.clear();
    for (last = first; last < count && edges[last].low == edges[first].low &&
                       edges[last].high == edges[first].high;
         ++last) {
      (edges[last].up ? up : down).push_back(edges[last].number);
    }
    if (up.size() == down.size()) {
      for (std::size_t i = 0; i < up.size(); ++i) {
        topology.twins[up[i]] = down[i];
        topology.twins[down[i]] = up[i];
      }
      continue;
    }
    if (defects.none()) {
      defects.where = {topology.vertices[edges[first].low], topology.vertices[edges[first].high]};
    }
    ++(last - first == 1   ? defects.boundary_edges
       : last - first == 2 ? defects.inconsistent_edges
                           : defects.branching_edges);
  }
  return defects;
}

void number_components(MeshTopology& topology) {
  const int count = static_cast<int>(topology.triangles.size());
  topology.components.assign(count, -1);
  topology.component_count = 0;
  std::vector<int> stack;
  for (int seed = 0; seed < count; ++seed) {
    if (topology.components[seed] >= 0) continue;
    const int number = topology.component_count++;
    topology.components[seed] = number;
    stack.push_back(seed);
    while (!stack.empty()) {
      const int t = stack.back();
      stack.pop_back();
      for (int i = 0; i < 3; ++i) {
        const int other = topology.twins[3 * t + i] / 3;
        if (topology.components[other] >= 0) continue;
        topology.components[other] = number;
        stack.push_back(other);
      }
    }
  }
}

void turn(MeshTopology& topology) {
  for (Triangle& t : topology.triangles) std::swap(t[1], t[2]);
  pair_edges(topology);
  topology.turned = true;
}

// Six times the volume of each component, about a vertex.
std::vector<double> volumes(const MeshTopology& topology) {
  std::vector<double> sums(topology.component_count, 0.0);
  const Vec3 origin = topology.vertices[0];
  for (std::size_t t = 0; t < topology.triangles.size(); ++t) {
    const Triangle& corners = topology.triangles[t];
    const Vec3 a = topology.vertices[corners[0]] - origin;
    const Vec3 b = topology.vertices[corners[1]] - origin;
    const Vec3 c = topology.vertices[corners[2]] - origin;
    sums[topology.components[t]] += a.dot(b.cross(c));
  }
  return sums;
}

// How many times the other components wind around a point: solid angles (van Oosterom and
// Strackee, IEEE Trans. Biomed. Eng. 30, 1983).
double winding_of_others(const MeshTopology& topology, int component, const Vec3& p) {
  double angle = 0.0;
  for (std::size_t t = 0; t < topology.triangles.size(); ++t) {
    if (topology.components[t] == component) continue;
    const Triangle& corners = topology.triangles[t];
    const Vec3 a = topology.vertices[corners[0]] - p, b = topology.vertices[corners[1]] - p,
               c = topology.vertices[corners[2]] - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2.0 * std::atan2(a.dot(b.cross(c)),
                              la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle / (4.0 * kPi);
}

// A part that is inside out is a cavity when the others wind around it, and a mistake otherwise.
int inverted_components(const MeshTopology& topology, const std::vector<double>& volumes,
                        MeshDefects& defects) {
  int count = 0;
  for (int c = 0; c < topology.component_count; ++c) {
    if (!(volumes[c] < 0.0)) continue;
    const auto t = std::find(topology.components.begin(), topology.components.end(), c) -
                   topology.components.begin();
    const Triangle& corners = topology.triangles[t];
    const Vec3& p = topology.vertices[corners[0]];
    if (winding_of_others(topology, c, p) > 0.25) continue;
    if (count++ == 0) defects.where = {p, topology.vertices[corners[1]]};
  }
  return count;
}

}  // namespace

std::string MeshDefects::message() const {
  std::ostringstream text;
  const auto part = [&](int count, const char* what) {
    if (count == 0) return;
    if (text.tellp() > 0) text << ", ";
    text << count << " " << what << (count == 1 ? "" : "s");
  };
  const auto kind = [&](int count, const char* one, const char* many) {
    if (count == 0) return;
    if (text.tellp() > 0) text << ", ";
    text << count << " " << (count == 1 ? one : many);
  };
  part(boundary_edges, "boundary edge");
  kind(inconsistent_edges, "edge between triangles of opposite orientation",
       "edges between triangles of opposite orientation");
  kind(branching_edges, "edge where more than two triangles meet and do not pair up",
       "edges where more than two triangles meet and do not pair up");
  kind(inverted_components, "part inside out", "parts inside out");
  text << ", the first at " << text_of(where[0]) << " to " << text_of(where[1])
       << "; a solid needs a closed surface whose triangles all run counterclockwise seen from "
          "outside";
  return text.str();
}

MeshDefects make_topology(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                          MeshTopology& topology) {
  check(vertices, triangles);
  topology = MeshTopology{};
  weld(vertices, triangles, 0.0, topology);
  MeshDefects defects = pair_edges(topology);
  if (!defects.none()) {
    Vec3 low = vertices[0], high = vertices[0];
    for (const Vec3& v : vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
    MeshTopology welded;
    weld(vertices, triangles, kWeld * (high - low).norm(), welded);
    if (pair_edges(welded).none()) {
      topology = std::move(welded);
      defects = MeshDefects{};
    }
  }
  if (!defects.none() || topology.triangles.empty()) return defects;
  number_components(topology);
  std::vector<double> parts = volumes(topology);
  if (std::accumulate(parts.begin(), parts.end(), 0.0) < 0.0) {
    turn(topology);
    for (double& v : parts) v = -v;
  }
  if (topology.component_count > 1) {
    defects.inverted_components = inverted_components(topology, parts, defects);
  }
  return defects;
}

}  // namespace volcontact
