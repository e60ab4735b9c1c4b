// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/mesh_columns/column_cells.h"
#include "volcontact/pair/mesh_columns/radial/radial_patches.h"
#include "volcontact/shape/torus.h"

namespace volcontact {

/// Memory of torus_columns(), reused from call to call; no value depends on it.
struct TorusColumnsScratch {
  RadialScratch radial;
  CellScratch cells;
  struct Crossing {
    double angle;
    bool enters;  ///< the mesh, by rising angle
  };
  std::vector<Crossing> crossings;
};

/// Interference of a closed triangle mesh and a torus, by lines from the triangles inside of the
/// torus to its exact surface: metrics in A's frame about A's origin. False when the pose is beyond
/// the method. docs/theory.md, "Columns to a bore and to a torus".
bool torus_columns(const SurfaceView& a, const Torus& b, const Pose& X_AB,
                   const InterferenceOptions& options, TorusColumnsScratch& scratch,
                   Interference& out);

}  // namespace volcontact
