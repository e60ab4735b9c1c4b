// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "volcontact/base/types.h"

namespace volcontact {

/// Corners of a triangle as indices of vertices, counterclockwise seen from outside.
using Triangle = std::array<int, 3>;

/// The surface of a solid: a closed oriented triangle mesh.
struct MeshTopology {
  std::vector<Vec3> vertices;       ///< [m], each position once
  std::vector<Triangle> triangles;  ///< none with two equal corners
  /// Half-edge 3 t + i goes from corner i of triangle t to corner i + 1; its twin goes back.
  std::vector<int> twins;
  std::vector<int> components;  ///< number of the connected part of each triangle, from 0
  int component_count = 0;
  bool turned = false;  ///< all triangles pointed inwards and were turned
};

/// What is wrong with a triangle soup that should bound a solid. docs/meshes.md.
struct MeshDefects {
  int boundary_edges = 0;       ///< edges with a triangle on one side only
  int inconsistent_edges = 0;   ///< edges whose two triangles are oriented against each other
  int branching_edges = 0;      ///< edges of three or more triangles that do not pair up
  int inverted_components = 0;  ///< closed parts inside out that lie in no other part
  std::array<Vec3, 2> where = {Vec3::Zero(), Vec3::Zero()};  ///< the first such edge [m]

  bool none() const {
    return boundary_edges + inconsistent_edges + branching_edges + inverted_components == 0;
  }
  /// One sentence: what, how many, where, and what to do.
  std::string message() const;
};

/// Welds equal vertices (and, where that leaves holes, those within 1e-7 of the size of each
/// other), drops triangles that lose a corner by it, pairs the edges and turns a surface that is
/// inside out as a whole. `topology` is usable when there are no defects. Throws
/// std::invalid_argument without triangles, on non-finite vertices and on indices out of
/// range.
MeshDefects make_topology(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                          MeshTopology& topology);

}  // namespace volcontact
