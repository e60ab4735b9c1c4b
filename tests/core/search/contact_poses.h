// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/reference/reference_integral.h"
#include "core/support/random.h"

namespace volcontact::test {

/// A solid that stands for its kind in tables and in the search for failures.
struct Example {
  std::string name;
  Shape shape;
  ReferenceSolid reference;
  Aabb bounds;        ///< of half-spaces: of a part of the plane
  double size;        ///< half the diagonal of the bounds [m]
  double own_volume;  ///< infinite for half-spaces [m^3]
};

/// One of every kind, a few tenths of a metre large.
const std::vector<Example>& examples();

/// Whether the two make a pair of the tables: not two half-spaces, which overlap without end, and
/// no mesh with what the octree alone serves.
bool is_pair(const Example& a, const Example& b);

/// A pose of B in A, and where the overlap is to be looked for.
struct ContactPose {
  Pose X_AB;
  Lookout lookout;
};

/// A point inside A and a point inside B coincide; any rotation.
ContactPose random_overlap(const Example& a, const Example& b, Random& random);

/// A point of B's surface lies under a point of A's surface, their normals opposed but for `tilt`
/// [rad]. Faces are then flush, round bodies touch at a point.
ContactPose shallow_overlap(const Example& a, const Example& b, double depth, double tilt,
                            Random& random);

/// Axes along axes, and a corner, edge, face or the middle of the bounds of B on one of A: coaxial,
/// coplanar, contained, identical and touching poses.
ContactPose aligned_overlap(const Example& a, const Example& b, Random& random);

}  // namespace volcontact::test
