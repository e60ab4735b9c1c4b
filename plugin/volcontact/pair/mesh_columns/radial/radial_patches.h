// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/pair/mesh_columns/face_patches.h"
#include "volcontact/pair/mesh_columns/radial/radial_cut.h"
#include "volcontact/pair/mesh_columns/radial/radial_search.h"
#include "volcontact/pair/overlap.h"

namespace volcontact {

/// A connected part of a mesh's surface in a solid with a radial wall, and the lines from it to the
/// wall: in Q, about its origin.
struct RadialPatch {
  RadialSum sum;
  bool at_wall = false;   ///< the wall passes through it
  bool at_other = false;  ///< another bore does
  int first, last;        ///< its faces, in RadialScratch::face_order
};

/// Memory of radial_patches().
struct RadialScratch {
  RadialSearchScratch search;
  std::vector<int> slot_of_face;
  std::vector<RadialPart> parts, parts_here, divided;
  std::vector<char> meets_other;  ///< of each face
  FacePatchScratch joining;
  std::vector<int> patch_of_face, face_order, part_order, starts;
  std::vector<double> doubts;
  RadialPieces pieces;
  std::vector<RadialPatch> patches;
};

enum class RadialReach {
  kDone,    ///< `scratch.patches` holds all
  kBeside,  ///< the surface also passes through faces of the body to which lines do not run
  kBudget   ///< more parts than `options.most_cells`
};

/// The patches of a mesh posed in Q. docs/theory.md, "Columns to a bore and to a torus".
RadialReach radial_patches(const SurfaceView& a, const Pose& X_QA, const RadialSolid& solid,
                           const InterferenceOptions& options, RadialScratch& scratch);

}  // namespace volcontact
