// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/base/simd.h"
#include "volcontact/pair/convex/face_set.h"
#include "volcontact/pair/mesh_columns/radial/radial_wall.h"
#include "volcontact/pair/mesh_columns/surface_view.h"

namespace volcontact {

/// A solid with a radial wall, in the frame Q of the wall: a torus, or a convex body less a bore.
struct RadialSolid {
  RadialWall wall;
  std::vector<SurfacePlane> planes;  ///< of the body; first those across the axis
  int planes_across = 0;
  std::vector<RoundFace> rounds;  ///< of the body
  std::vector<Bore> others;       ///< also cut out of the body
};

/// Memory of the search.
struct RadialSearchScratch {
  struct Found {
    int slot;
    bool inside;  ///< certainly, and away from all but the planes across the axis
  };
  SimdPath path = best_simd_path();
  std::vector<int> stack;
  std::vector<Found> found;  ///< the triangles that may reach into the solid, in fixed order
};

/// Fills `scratch.found`; `X_QM` is the pose of the mesh.
void find_triangles_at_wall(const ObbTree& tree, const Pose& X_QM, const RadialSolid& solid,
                            RadialSearchScratch& scratch);

}  // namespace volcontact
