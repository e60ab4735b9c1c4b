// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/reference/reference_solid.h"
#include "volcontact/metrics/volume_metrics.h"

namespace volcontact::test {

// The integral that every engine is judged by. Composed solids are first written as a sum of
// intersections, plus and minus, so that all that is integrated is convex (or has a torus), has one
// region, and a point of it is known: none can be overlooked. Lines in three orthogonal directions
// cut such an overlap of two ReferenceSolids in exact intervals. They are summed by nested Gauss
// quadrature between all places where the faces that bound them change: there the integrands are
// smooth but for their ends, whose square roots a change of variable takes out. Each direction
// gives V, centroid and inertia; how well the three agree is the error, and errors of terms add up.
// A direction e gives int x (n . e) dS as a sum of signs, without a division by n . e: the three
// together give the area vector and its moment.

/// Where to look. Any frame gives the same numbers; one whose z axis is the contact normal and
/// whose origin lies in the overlap finds thin overlaps too.
struct Lookout {
  Pose X_AF;                ///< of the frame of the lines in A
  double half_range;        ///< the smaller solid lies within this distance of its origin [m]
  bool all_axes = true;     ///< false: lines along z alone; no area vector and no error
  double tolerance = 1e-8;  ///< of V, of each stretch; coarser than 1e-6: fewer lines look
};

struct Reference {
  VolumeMetrics metrics;      ///< in A's frame about A's origin; no depth fields
  double volume_error = 0.0;  ///< of V: between the directions that agree best [m^3]
  double worst_error = 0.0;   ///< of V: of the worst direction. The areas need all three [m^3]
  double shared_area = 0.0;   ///< of faces of A and B in one place that look the same way: there V
                              ///< has a kink, and A's share of the area is a convention [m^2]
};

/// Integral over A and B, posed at X_AB. Refines once where the directions disagree.
Reference reference_integral(const ReferenceSolid& a, const ReferenceSolid& b, const Pose& X_AB,
                             const Lookout& lookout);

}  // namespace volcontact::test
