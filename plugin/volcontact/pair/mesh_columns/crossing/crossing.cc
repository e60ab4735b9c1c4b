// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/crossing/crossing.h"

#include <algorithm>
#include <cmath>

#include "volcontact/base/fields.h"
#include "volcontact/pair/mesh_columns/crossing/leaf_cache.h"

namespace volcontact {
namespace {

// Names an edge of one surface that passes through a triangle of the other one.
std::uint64_t key_of(const ObbTree& tree, int slot, int edge, int other_slot, bool of_b) {
  const int half_edge = 3 * slot + edge;
  const auto lower = static_cast<std::uint64_t>(std::min(half_edge, tree.twins[half_edge]));
  return (lower << 32 | static_cast<std::uint64_t>(other_slot)) << 1 | (of_b ? 1u : 0u);
}

}  // namespace
}  // namespace volcontact

#define VOLCONTACT_SIMD_KERNEL "volcontact/pair/mesh_columns/crossing/crossing_kernel.inc"
#include "volcontact/base/simd_paths.inc"
#undef VOLCONTACT_SIMD_KERNEL

namespace volcontact {

bool find_contacts(const ObbTree& a, const ObbTree& b, const Pose& X_BA, double reach, int most,
                   CrossingScratch& scratch) {
  return VOLCONTACT_SIMD_CALL(scratch.path, find_contacts_wide, a, b, X_BA, reach, most, scratch);
}

}  // namespace volcontact
