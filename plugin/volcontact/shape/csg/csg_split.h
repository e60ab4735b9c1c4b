// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "volcontact/shape/csg/csg_faces.h"

namespace volcontact {

/// A convex simple shape in its place.
struct PosedShape {
  SimpleShape shape;
  Pose X_SM;
};

/// What a plane leaves of a body on either side.
struct Split {
  std::optional<PosedShape> inside;  ///< normal . x <= offset
  std::optional<PosedShape> outside;
  bool possible = true;  ///< false where a side would be no simple shape
};

/// Cuts a body by a plane: boxes and polytopes by any plane, cylinders and frusta by planes across
/// their axis, all others only if the plane does not reach them. `size` [m] is that of the solid.
Split split(const PosedShape& body, const MemberFace& plane, double size);

/// Whether what a round face holds of the body lies within another round face; false when that is
/// not proven. For tubes and cones about parallel axes, and balls in each other and in tubes.
bool holds_within(const MemberFace& inner, const MemberFace& outer, const PartHull& body,
                  double size);

}  // namespace volcontact
