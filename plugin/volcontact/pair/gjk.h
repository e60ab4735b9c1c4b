// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/pair/convex_view.h"

namespace volcontact {

/// Finds a common point of two bounded convex solids, in A's frame, or proves by a direction in
/// which their support functions do not meet that there is none. A point of bare touch may be
/// reported either way. Method of Gilbert, Johnson and Keerthi, IEEE J. Robotics and Automation
/// 4(2), 1988.
bool find_common_point(const ConvexView& a, const ConvexView& b, const Pose& X_AB,
                       Vec3& point) noexcept;

/// The point of the convex hull of some points (at least one) nearest the origin.
Vec3 nearest_in_hull(const std::vector<Vec3>& points) noexcept;

}  // namespace volcontact
