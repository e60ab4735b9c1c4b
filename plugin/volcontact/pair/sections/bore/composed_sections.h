// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/sections/bore/bored_sections.h"
#include "volcontact/shape/csg/csg.h"

namespace volcontact {

/// One convex body of a solid and what is cut out of it. Refers to the solid.
struct LinesPiece {
  ConvexView body;
  Pose X_SB;                                 ///< of the body in the solid's frame
  const std::vector<Bore>* bores = nullptr;  ///< in the solid's frame; null for none
  const std::vector<Seam>* seams = nullptr;  ///< in the solid's frame; null for none
};

/// A plain convex solid as its own only piece.
template <HasFaces S>
void add_lines_pieces(const S& solid, std::vector<LinesPiece>& pieces) {
  pieces.push_back({ConvexView(solid), Pose{}});
}
void add_lines_pieces(const Csg& solid, std::vector<LinesPiece>& pieces);

/// Whether a solid has pieces for this engine.
template <HasFaces S>
bool has_lines_pieces(const S&) {
  return true;
}
bool has_lines_pieces(const Csg& solid);

/// Memory of the engine for composed solids.
struct ComposedScratch {
  std::vector<LinesPiece> pieces[2];  ///< by owner
  struct Reached {
    Bore bore;
    Owner owner;
  };
  std::vector<Reached> bores;
  LinesRegions regions;
  std::vector<int> site_of;
  BoreScratch bore;
};

/// Interference of two solids from the overlaps of their pieces (`scratch.pieces`, which the caller
/// has filled): metrics in A's frame about A's origin. Regions that share a seam are one contact
/// site. False when a pair of pieces is beyond this engine: more than one bore reached, or an
/// overlap that reaches past a bore sideways. docs/theory.md, "Bores".
bool composed_lines(const Pose& X_AB, const InterferenceOptions& options, LinesScratch& lines,
                    ComposedScratch& scratch, Interference& out);

}  // namespace volcontact
