// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "volcontact/pair/engine_interface.h"
#include "volcontact/pair/octree/octree.h"

namespace volcontact {
namespace octree_work {

/// A look at a solid, in looks at a simple one: what it costs to know how far its surface is. Of a
/// mesh about 15 were measured; more stand here, since large meshes cost more.
inline constexpr int kOfMesh = 24;
inline constexpr int kLeastCells = 1500;  ///< whatever a look costs

template <typename S>
int of(const S&) {
  return std::is_same_v<S, Mesh> ? kOfMesh : 1;
}
inline int of(const Csg& solid) { return std::max(1, static_cast<int>(solid.members().size())); }

}  // namespace octree_work

/// Any two solids of which one is bounded, to a bound of the error.
struct Octree : EngineBase {
  static constexpr Engine kWord = Engine::kOctree;
  using Scratch = TypeList<OctreeScratch>;
  static constexpr bool kHasBounds = true;
  static constexpr bool stands_in_for(Engine) { return true; }

  template <typename A, typename B>
  static constexpr bool serves() {
    return !(std::is_same_v<A, HalfSpace> && std::is_same_v<B, HalfSpace>);
  }
  template <typename A, typename B>
  static Answer run(const Question<A, B>& q, OctreeScratch& scratch, Interference& out) {
    InterferenceOptions options = q.options;
    // Where others are beyond, the budget is one of time. Who asks for this engine has it all.
    if (options.engine != Engine::kOctree) {
      const int work = std::max(octree_work::of(q.a), octree_work::of(q.b));
      options.most_cells = std::min(options.most_cells,
                                    std::max(octree_work::kLeastCells, options.most_cells / work));
    }
    octree_interference(q.shape_a, q.shape_b, q.X_AB, options, scratch, out);
    return Answer::kGiven;
  }
};

}  // namespace volcontact
