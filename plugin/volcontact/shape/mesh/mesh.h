// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "volcontact/shape/mesh/mesh_topology.h"
#include "volcontact/shape/mesh/obb_tree.h"
#include "volcontact/shape/solid.h"

namespace volcontact {

/// The solid inside of a closed oriented triangle mesh, convex or not, taken as given: not its
/// hull. May have several parts and cavities. Parts that overlap each other or themselves count as
/// often as the surface winds around a point. Immutable; copies share one data block.
class Mesh {
 public:
  static constexpr const char* kName = "mesh";

  /// `vertices` [m], shape (n, 3); `triangles`, shape (m, 3), indices from 0, counterclockwise seen
  /// from outside. A mesh that is inside out as a whole is turned (see topology().turned). Throws
  /// std::invalid_argument on a surface that does not bound a solid; the message says where.
  Mesh(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles);

  /// The welded surface.
  const MeshTopology& topology() const { return data_->topology; }
  const ObbTree& tree() const { return data_->tree; }
  double surface_area() const { return data_->surface_area; }

  /// The connected parts of the surface.
  struct Component {
    VolumeMetrics own;    ///< of the solid that the part alone would bound
    double surface_area;  ///< [m^2]
    bool cavity;          ///< its triangles look inwards: it is taken away
    Vec3 point;           ///< on it
    Aabb bounds;
  };
  struct Components {
    std::vector<Component> list;
    std::vector<int> of_slot;  ///< number of the part of each slot of the tree
    std::size_t size() const { return list.size(); }
  };
  const Components& components() const { return data_->components; }

  Aabb bounds() const { return data_->bounds; }
  /// Of the bounds.
  double support_height(const Vec3& e) const;
  /// Exact. The sign is that of the nearest face, edge or corner: Baerentzen and Aanaes, "Signed
  /// distance computation using the angle weighted pseudonormal", IEEE TVCG 11(3), 2005.
  double signed_distance(const Vec3& p) const;
  Vec3 gradient(const Vec3& p) const;
  VolumeMetrics own_metrics() const { return data_->metrics; }

 private:
  struct Data {
    MeshTopology topology;
    ObbTree tree;
    std::vector<Vec3> face_normals;    ///< of unit length; zero of a triangle without area
    std::vector<Vec3> corner_normals;  ///< of each vertex, weighted by the angles
    Aabb bounds;
    VolumeMetrics metrics;
    double surface_area = 0.0;
    Components components;
  };
  struct Nearest {
    double distance;
    Vec3 point;
    bool inside;
    Vec3 outward;  ///< pseudonormal
  };
  Nearest nearest(const Vec3& p) const;

  std::shared_ptr<const Data> data_;
};

static_assert(Solid<Mesh>);

}  // namespace volcontact
