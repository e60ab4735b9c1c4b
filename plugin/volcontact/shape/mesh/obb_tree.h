// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/base/simd.h"
#include "volcontact/base/types.h"
#include "volcontact/shape/mesh/mesh_topology.h"

namespace volcontact {

/// Oriented boxes around the triangles of a surface, kLanes wide: a node holds up to eight boxes
/// side by side, so that one sequence of vector operations tests them all. Oriented, because the
/// thickness of a box along a smooth surface falls with the square of its width.
///
/// The triangles are renumbered: slot 8 l + i is lane i of leaf l. An unused lane repeats a corner
/// of lane 0 three times.
struct ObbTree {
  /// A box is thinnest along this axis.
  static constexpr int kFlatAxis = 2;

  /// In floats: a box need not be exact, only around its triangles.
  struct alignas(64) Node {
    float center[3][kLanes];   ///< in the frame of the mesh
    float axis[3][3][kLanes];  ///< axis[k] is the unit vector of half size k
    float half[3][kLanes];     ///< half sizes, padded by rounding
    int child[kLanes];         ///< a node, or the complement (~) of a leaf
    int count = 0;             ///< lanes in use, the first ones
  };
  struct alignas(64) Leaf {
    double corner[3][3][kLanes];  ///< corner[i][axis]
    int count = 0;
  };

  /// How far arithmetic in floats with boxes may be off, by the size of what it is done with.
  static constexpr double kRounding = 2e-6;
  /// How far its boxes may be off in a frame where the tree is moved by a translation [m].
  double slack(const Vec3& translation) const {
    return kRounding * (size + translation.cwiseAbs().sum());
  }

  std::vector<Node> nodes;  ///< the root is the first
  double size = 0.0;        ///< sum over the axes of the largest |coordinate| [m]
  std::vector<Leaf> leaves;
  std::vector<int> triangle_of_slot;  ///< -1 in an unused lane
  /// Half-edge 3 s + i of slot s: the half-edge on the other side.
  std::vector<int> twins;

  Vec3 corner(int slot, int i) const {
    const auto& c = leaves[static_cast<std::size_t>(slot / kLanes)].corner[i];
    const int lane = slot % kLanes;
    return {c[0][lane], c[1][lane], c[2][lane]};
  }
};

/// A pose for the boxes of a tree.
struct BoxPose {
  explicit BoxPose(const Pose& X) {
    for (int i = 0; i < 3; ++i) {
      translation[i] = static_cast<float>(X.translation[i]);
      for (int j = 0; j < 3; ++j) rotation[i][j] = static_cast<float>(X.rotation(i, j));
    }
  }
  float rotation[3][3], translation[3];
};

/// Two nodes of trees, and their lanes that a search through both has yet to compare.
struct NodePair {
  int node_a, node_b;
  unsigned lanes_a, lanes_b;
  int around_b = -1;  ///< the box around node_b: lane + kLanes times the number of its node
};

ObbTree make_obb_tree(const MeshTopology& topology);

}  // namespace volcontact
