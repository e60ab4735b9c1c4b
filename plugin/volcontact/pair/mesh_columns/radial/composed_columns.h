// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/pair/mesh_columns/in_round/round_columns.h"
#include "volcontact/pair/mesh_columns/mesh_columns.h"
#include "volcontact/pair/mesh_columns/radial/radial_patches.h"
#include "volcontact/shape/csg/csg.h"

namespace volcontact {

/// Memory of composed_columns(), reused from call to call; no value depends on it.
struct ComposedColumnsScratch {
  RadialScratch radial;
  RadialSolid solid;
  FaceSet faces;
  std::vector<Bore> bores;  ///< that the mesh reaches, in the solid's frame
  Interference part, whole;
  struct Site {
    VolumeMetrics metrics;  ///< in A's frame
    int piece;
  };
  std::vector<Site> sites;
  std::vector<int> site_of;
};

/// Whether a composed solid has pieces for this engine.
bool has_columns_pieces(const Csg& solid);

/// Interference of a closed triangle mesh and a composed solid, piece by piece: the columns of the
/// piece's body, or, where the mesh reaches a bore, lines from its triangles to the exact wall.
/// Metrics in A's frame about A's origin; `counter_area` counts seams too. False when the pose is
/// beyond the method. docs/theory.md, "Columns to a bore and to a torus".
bool composed_columns(const SurfaceView& a, const Csg& b, const Pose& X_AB,
                      const InterferenceOptions& options, ColumnsScratch& columns,
                      RoundColumnsScratch& round, ComposedColumnsScratch& scratch,
                      Interference& out);

}  // namespace volcontact
