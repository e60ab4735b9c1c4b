// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "core/search/contact_poses.h"
#include "volcontact/pair/interference.h"

namespace volcontact::test {

/// How much a pair costs, which decides how often it is tried.
enum class Cost : int {
  kLow = 0,     ///< simple convex solids: microseconds
  kMiddle = 1,  ///< meshes, and composed solids with bores: now and then left to the octree
  kHigh = 2,    ///< composed solids with meshes, tori or cones: at length
};
Cost cost_of(const Example& a, const Example& b);

/// What a search for failures does. Every pose is answered in both orders of the pair and both
/// answers are checked by themselves and against each other (overlap_checks.h). Every pose whose
/// answer is "apart" and a share of the others are integrated by the reference.
struct FuzzPlan {
  int random_poses = 0;      ///< any overlap, and shallow ones of depth 1e-6 to 0.1 of the size
  int degenerate_poses = 0;  ///< coplanar, coaxial, vertex on face, contained, touching,
                             ///< identical, flush, solids of no volume, poses that are no numbers
  double weights[3] = {1.0, 1.0, 1.0};    ///< of a pair of each Cost, against each other
  double reference[3] = {1.0, 1.0, 1.0};  ///< share of the overlaps that the reference integrates
  double octree_tolerance = 1e-2;         ///< asked of pairs of high cost
  std::uint64_t seed = 1;
  std::string only = {};  ///< "a-b" for one pair, empty for all
};

struct FuzzFailure {
  std::string a, b, what;
  Engine engine;
  Pose X_AB;
  double volume, expected;
};

/// Of one engine and one kind of poses.
struct FuzzCount {
  Engine engine = Engine::kAuto;
  bool degenerate = false;
  int poses = 0, overlapping = 0;
  std::vector<float> errors;  ///< relative, of V, of overlaps that the reference integrated
};

struct FuzzReport {
  std::vector<FuzzCount> counts;
  std::vector<FuzzFailure> failures;
  int undecided = 0;  ///< overlaps on which the reference disagrees with itself
};

/// Runs `auto` over all ordered pairs of examples() in turn.
FuzzReport fuzz(const FuzzPlan& plan);

/// One of every kind with a size of zero.
const std::vector<Shape>& flat_solids();

/// The pose as a C++ literal.
std::string literal(const Pose& pose);

}  // namespace volcontact::test
