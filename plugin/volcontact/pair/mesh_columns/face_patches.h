// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "volcontact/base/disjoint_sets.h"
#include "volcontact/shape/mesh/obb_tree.h"

namespace volcontact {

/// Memory of join_faces().
struct FacePatchScratch {
  std::vector<int> face_of_slot;  ///< -1 between uses
  std::vector<int> parent;
};

/// Faces of a mesh that share an edge of which some part lies in a solid belong to one patch.
/// `edge_inside(slot, i)`: whether some part of the edge from corner i to corner i + 1 does. Writes
/// the number of the patch of each face, in the order of their first faces; returns how many there
/// are.
template <typename EdgeInside>
int join_faces(const ObbTree& tree, const std::vector<int>& slot_of_face,
               const EdgeInside& edge_inside, FacePatchScratch& scratch,
               std::vector<int>& patch_of_face) {
  const int count = static_cast<int>(slot_of_face.size());
  std::vector<int>& of_slot = scratch.face_of_slot;
  if (of_slot.size() < tree.triangle_of_slot.size()) {
    of_slot.resize(tree.triangle_of_slot.size(), -1);
  }
  for (int i = 0; i < count; ++i) of_slot[slot_of_face[i]] = i;
  std::vector<int>& parent = scratch.parent;
  make_sets(parent, slot_of_face.size());
  for (int i = 0; i < count; ++i) {
    const int slot = slot_of_face[i];
    for (int e = 0; e < 3; ++e) {
      const int other = of_slot[tree.twins[3 * slot + e] / 3];
      if (other < 0 || other > i || root_of(parent, i) == root_of(parent, other)) continue;
      if (edge_inside(slot, e)) join_sets(parent, i, other);
    }
  }
  patch_of_face.resize(slot_of_face.size());
  int patches = 0;
  for (int i = 0; i < count; ++i) {
    const int root = root_of(parent, i);
    patch_of_face[i] = root == i ? patches++ : patch_of_face[root];
  }
  for (const int slot : slot_of_face) of_slot[slot] = -1;
  return patches;
}

}  // namespace volcontact
