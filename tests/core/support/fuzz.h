// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/support/contact_poses.h"
#include "volcontact/pair/interference.h"

namespace volcontact::test {

/// What a search for failures does.
struct FuzzPlan {
  int random_poses = 0;       ///< any overlap, and shallow ones of depth 1e-6 to 0.1 of the size
  int degenerate_poses = 0;   ///< coplanar, coaxial, contained, touching, identical, flush
  double octree_share = 1.0;  ///< of the poses of pairs that the octree serves, or may have to: a
                              ///< composed solid can be beyond lines in some poses; 0: none
  double octree_tolerance = 1e-2;
  double reference_share = 1.0;  ///< of the overlaps, compared with the reference; all are with the
                                 ///< other order of the pair, and all that seem apart
  std::uint64_t seed = 1;
  std::string only = {};  ///< "a-b" for one pair, empty for all
};

struct FuzzFailure {
  std::string a, b, what;
  Engine engine;
  Pose X_AB;
  double volume, expected;
};

/// Of one kind of pair: served by exact engines, by lines, by the octree.
struct FuzzCount {
  Engine engine = Engine::kAuto;
  int poses = 0, overlapping = 0;
  std::vector<float> errors;  ///< relative, of V, of every overlap the reference found
};

struct FuzzReport {
  std::vector<FuzzCount> counts;  ///< by engine
  std::vector<FuzzFailure> failures;
  int undecided = 0;  ///< overlaps on which the reference disagrees with itself
};

/// Runs `auto` over all ordered pairs of examples() in turn.
FuzzReport fuzz(const FuzzPlan& plan);

/// The pose as a C++ literal.
std::string literal(const Pose& pose);

}  // namespace volcontact::test
