// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/mesh/mesh.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "volcontact/base/fields.h"
#include "volcontact/shape/mesh/tetrahedron_sum.h"

namespace volcontact {
namespace {

Mesh::Components components_of(const MeshTopology& mesh, const ObbTree& tree, const Vec3& origin) {
  const auto count = static_cast<std::size_t>(mesh.component_count);
  std::vector<TetrahedronSum> sums(count, TetrahedronSum{origin, {}});
  Mesh::Components components;
  components.list.resize(count);
  std::vector<bool> seen(count, false);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& corners = mesh.triangles[t];
    const auto number = static_cast<std::size_t>(mesh.components[t]);
    Mesh::Component& component = components.list[number];
    sums[number].add(mesh.vertices[corners[0]], mesh.vertices[corners[1]],
                     mesh.vertices[corners[2]]);
    for (int corner : corners) {
      const Vec3& v = mesh.vertices[corner];
      if (!seen[number]) component.bounds = {v, v}, component.point = v;
      seen[number] = true;
      component.bounds.min = component.bounds.min.cwiseMin(v);
      component.bounds.max = component.bounds.max.cwiseMax(v);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    Mesh::Component& component = components.list[i];
    component.cavity = sums[i].sum.volume < 0.0;
    if (component.cavity) {
      sums[i].sum.volume *= -1.0;
      sums[i].sum.first *= -1.0;
      sums[i].sum.second *= -1.0;
    }
    component.own = sums[i].metrics();
    component.surface_area = sums[i].surface_area;
  }
  for (int t : tree.triangle_of_slot) {
    components.of_slot.push_back(t < 0 ? -1 : mesh.components[static_cast<std::size_t>(t)]);
  }
  return components;
}

// The point of a triangle nearest to p, and where it lies: 0 inside, 1 + i on the edge from corner
// i, 4 + i at corner i. Ericson, "Real-Time Collision Detection", 2005, section 5.1.5.
Vec3 nearest_in(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p, int& feature) {
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return feature = 4, a;
  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return feature = 5, b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return feature = 1, Vec3(a + d1 / (d1 - d3) * ab);
  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return feature = 6, c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return feature = 3, Vec3(a + d2 / (d2 - d6) * ac);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    return feature = 2, Vec3(b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b));
  }
  feature = 0;
  return a + (vb * ab + vc * ac) / (va + vb + vc);
}

}  // namespace

Mesh::Mesh(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
  auto data = std::make_shared<Data>();
  MeshTopology& mesh = data->topology;
  const MeshDefects defects = make_topology(vertices, triangles, mesh);
  if (!defects.none()) throw std::invalid_argument("mesh: " + defects.message());
  if (mesh.triangles.empty()) {
    throw std::invalid_argument("mesh: all triangles have two equal corners; nothing is left");
  }
  data->bounds = {mesh.vertices[0], mesh.vertices[0]};
  for (const Vec3& v : mesh.vertices) {
    data->bounds.min = data->bounds.min.cwiseMin(v);
    data->bounds.max = data->bounds.max.cwiseMax(v);
  }
  TetrahedronSum whole{data->bounds.center(), {}};
  data->corner_normals.assign(mesh.vertices.size(), Vec3::Zero());
  for (const Triangle& t : mesh.triangles) {
    const Vec3 corners[] = {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    const Vec3 twice_area = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    whole.add(corners[0], corners[1], corners[2]);
    data->face_normals.push_back(twice_area.stableNormalized());
    for (int i = 0; i < 3; ++i) {
      const Vec3 u = corners[(i + 1) % 3] - corners[i], v = corners[(i + 2) % 3] - corners[i];
      const double angle = std::atan2(u.cross(v).norm(), u.dot(v));
      data->corner_normals[t[i]] += angle * data->face_normals.back();
    }
  }
  data->metrics = whole.metrics();
  data->surface_area = whole.surface_area;
  const double size = data->bounds.half_sizes().norm();
  if (!(data->metrics.volume > 1e-14 * size * size * size)) {
    throw std::invalid_argument("mesh: encloses no volume; a solid must not be flat");
  }
  data->tree = make_obb_tree(mesh);
  data->components = components_of(mesh, data->tree, data->bounds.center());
  data_ = std::move(data);
}

Mesh::Nearest Mesh::nearest(const Vec3& p) const {
  const ObbTree& tree = data_->tree;
  const MeshTopology& mesh = data_->topology;
  // Branch and bound, nearest box first; the stack holds boxes that may still be nearer.
  struct Entry {
    double squared;
    int child;
  };
  Entry stack[512];
  int size = 0, best_triangle = -1, best_feature = 0;
  Vec3 best_point = Vec3::Zero();
  double best = kInfinity;
  stack[size++] = {0.0, 0};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry.squared >= best) continue;
    if (entry.child < 0) {
      const int leaf = ~entry.child;
      for (int lane = 0; lane < tree.leaves[leaf].count; ++lane) {
        const int t = tree.triangle_of_slot[leaf * kLanes + lane];
        const Triangle& corners = mesh.triangles[t];
        int feature;
        const Vec3 q = nearest_in(mesh.vertices[corners[0]], mesh.vertices[corners[1]],
                                  mesh.vertices[corners[2]], p, feature);
        const double squared = (p - q).squaredNorm();
        if (squared < best) {
          best = squared, best_triangle = t, best_feature = feature, best_point = q;
        }
      }
      continue;
    }
    const ObbTree::Node& node = tree.nodes[entry.child];
    double squared[kLanes];
    for (int lane = 0; lane < kLanes; ++lane) squared[lane] = 0.0;
    for (int k = 0; k < 3; ++k) {
      for (int lane = 0; lane < kLanes; ++lane) {
        const double x = node.axis[k][0][lane] * (p.x() - node.center[0][lane]) +
                         node.axis[k][1][lane] * (p.y() - node.center[1][lane]) +
                         node.axis[k][2][lane] * (p.z() - node.center[2][lane]);
        const double beyond = std::max(std::abs(x) - node.half[k][lane], 0.0);
        squared[lane] += beyond * beyond;
      }
    }
    // The axes of the boxes are floats: not quite at right angles.
    for (double& s : squared) s *= 1.0 - ObbTree::kRounding;
    const int first = size;
    for (int lane = 0; lane < node.count; ++lane) {
      if (squared[lane] < best) stack[size++] = {squared[lane], node.child[lane]};
    }
    std::sort(stack + first, stack + size, [](const Entry& a, const Entry& b) {
      return a.squared != b.squared ? a.squared > b.squared : a.child > b.child;
    });
  }
  const std::vector<Vec3>& faces = data_->face_normals;
  if (best_triangle < 0) {  // p is no number, or so far away that squares overflow
    const Vec3& corner = mesh.vertices[mesh.triangles[0][0]];
    return {(p - corner).stableNorm(), corner, false, faces[0]};
  }
  const Triangle& corners = mesh.triangles[best_triangle];
  Vec3 outward = faces[best_triangle];
  if (best_feature >= 4) {
    outward = data_->corner_normals[corners[best_feature - 4]];
  } else if (best_feature >= 1) {
    outward += faces[mesh.twins[3 * best_triangle + best_feature - 1] / 3];
  }
  return {std::sqrt(best), best_point, (p - best_point).dot(outward) < 0.0, outward};
}

double Mesh::signed_distance(const Vec3& p) const {
  const Nearest found = nearest(p);
  return found.inside ? -found.distance : found.distance;
}

double Mesh::support_height(const Vec3& e) const {
  return e.dot(bounds().center()) + e.cwiseAbs().dot(bounds().half_sizes());
}

Vec3 Mesh::gradient(const Vec3& p) const {
  const Nearest found = nearest(p);
  const Vec3 offset = found.inside ? Vec3(found.point - p) : Vec3(p - found.point);
  const Vec3 direction =
      found.distance > 1e-12 * bounds().half_sizes().norm() ? offset : found.outward;
  return direction.squaredNorm() > 0.0 ? Vec3(direction.stableNormalized()) : Vec3::UnitZ();
}

}  // namespace volcontact
