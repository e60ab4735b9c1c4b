// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "volcontact/base/simd.h"
#include "volcontact/pair/mesh_columns/face_patches.h"
#include "volcontact/pair/mesh_columns/in_round/round_solid.h"
#include "volcontact/pair/overlap.h"
#include "volcontact/shape/mesh/obb_tree.h"

namespace volcontact {

/// The part of a surface inside of a round solid, in pieces. Positions in Q.
struct RoundPieces {
  /// A triangle inside, counterclockwise seen from outside of A.
  struct Triangle {
    Vec3 corner[3];
    int face;  ///< number of the triangle of A it is part of

    /// Cut in four through the middles of its sides.
    std::array<Triangle, 4> quarters() const {
      const Vec3 &a = corner[0], &b = corner[1], &c = corner[2];
      const Vec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
      return {Triangle{{a, ab, ca}, face}, Triangle{{ab, b, bc}, face}, Triangle{{ca, bc, c}, face},
              Triangle{{ab, bc, ca}, face}};
    }
  };
  /// What lies between a chord and the arc in which the face leaves the solid. The columns there
  /// get evenly shorter, or longer, from the `middle` of the chord to the arc.
  struct Sliver {
    Vec3 middle;
    Vec3 area_vector;  ///< of A
    Vec3 tip;          ///< on the arc
    int face;
  };
  std::vector<Triangle> triangles;
  std::vector<Sliver> slivers;
  std::vector<int> slot_of_face;
  std::vector<int> patch_of_face;  ///< connected part of the surface inside
  int patch_count = 0;
  bool whole = false;  ///< the surface lies inside, uncut
};

/// Memory of find_round_pieces().
struct RoundSearchScratch {
  struct Found {
    int slot;
    bool inside;
    bool deep;  ///< no corner is on the round face
  };
  SimdPath path = best_simd_path();
  std::vector<int> stack;
  std::vector<Found> found;
  FacePatchScratch joining;
  std::vector<Vec3> corners;  ///< of the polygon at hand
};

/// Cuts the triangles of a tree, whose frame is that of Q but for an origin at -`origin`, by a
/// round solid. False when there are more pieces than `options.most_cells`.
bool find_round_pieces(const ObbTree& tree, const Vec3& origin, const RoundSolid& solid,
                       const InterferenceOptions& options, RoundSearchScratch& scratch,
                       RoundPieces& pieces);

}  // namespace volcontact
