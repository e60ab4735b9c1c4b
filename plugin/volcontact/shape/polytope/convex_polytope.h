// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "volcontact/shape/mesh/obb_tree.h"
#include "volcontact/shape/polytope/polytope_graph.h"
#include "volcontact/shape/solid.h"

namespace volcontact {

/// Convex hull of given points. Immutable; copies share one data block.
class ConvexPolytope {
 public:
  static constexpr bool kPlanesOnly = true;
  static constexpr const char* kName = "convex_polytope";

  /// A face: the plane normal . x = offset, normal outward and of unit length, and its corners,
  /// counterclockwise seen from outside, as indices into vertices().
  struct Face {
    Vec3 normal;
    double offset;
    std::vector<int> loop;
  };

  /// The hull of `points` [m], shape (n, 3). Throws std::invalid_argument on fewer than four
  /// points, non-finite ones and flat sets.
  explicit ConvexPolytope(const std::vector<Vec3>& points);

  /// Corners of the hull.
  const std::vector<Vec3>& vertices() const { return data_->vertices; }
  /// Faces; coplanar neighbours (to 1e-13 of the size) are one face.
  const std::vector<Face>& faces() const { return data_->faces; }
  /// The surface in the form that clipping works on; its face numbers are those of faces().
  const PolytopeGraph& graph() const { return data_->graph; }

  /// The surface as triangles.
  const ObbTree& tree() const { return data_->tree; }

  Aabb bounds() const { return data_->bounds; }
  Vec3 support(const Vec3& e) const;
  double support_height(const Vec3& e) const { return e.dot(support(e)); }
  /// The largest of the distances from the face planes: exact inside, a lower bound outside.
  double signed_distance(const Vec3& p) const;
  Vec3 gradient(const Vec3& p) const;
  RayInterval ray(const Vec3& o, const Vec3& d) const;
  VolumeMetrics own_metrics() const { return data_->metrics; }
  double surface_area() const { return data_->surface_area; }
  template <typename Writer>
  void write_faces(Writer& writer) const {
    for (const Face& face : faces()) writer.plane(face.normal, face.offset);
  }

 private:
  struct Data {
    std::vector<Vec3> vertices;
    std::vector<Face> faces;
    PolytopeGraph graph;
    ObbTree tree;
    Aabb bounds;
    VolumeMetrics metrics;
    double surface_area = 0.0;
  };

  const Face& nearest_face(const Vec3& p) const;

  std::shared_ptr<const Data> data_;
};

static_assert(ConvexSolid<ConvexPolytope>);

}  // namespace volcontact
