// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "volcontact/base/types.h"
#include "volcontact/shape/mesh/obb_tree.h"

namespace volcontact {

/// A triangle of A and one of B that meet. Positions in B's frame.
struct TriangleContact {
  int f, g;                    ///< slots of A's and B's trees
  bool proper;                 ///< they cross in the segment p q; else they only touch, within p q
  Vec3 p, q;                   ///< ends of the segment, along n_f x n_g; or corners of a box
  Vec3 normal_f, normal_g;     ///< of any length
  std::uint64_t key_p, key_q;  ///< name the edge and the face that meet there: equal where the
                               ///< segments of neighbouring triangles join
};

/// Memory of the search for contacts.
struct CrossingScratch {
  SimdPath path = best_simd_path();
  std::vector<NodePair> stack;
  std::vector<int> leaf_pairs;  ///< leaf of A, leaf of B, ...
  std::vector<TriangleContact> contacts;
};

/// All pairs of triangles of A and B that meet, or come nearer than `reach` [m], in a fixed order.
/// `X_BA` is the pose of A in B. Stops after `most` contacts and returns false.
bool find_contacts(const ObbTree& a, const ObbTree& b, const Pose& X_BA, double reach, int most,
                   CrossingScratch& scratch);

}  // namespace volcontact
