// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "volcontact/base/types.h"

namespace volcontact {

/// Triangles of the convex hull of `points`, as indices into it, counterclockwise seen from
/// outside. Quickhull whose side tests are exact, so its topology is that of a sphere for every
/// input (of coordinates to 1e-105 of the largest; finer ones are rounded to that); points on the
/// hull but not at a corner may be left out. Throws std::invalid_argument on fewer than four
/// points, on non-finite ones and on points that lie in a plane (to 1e-12 of their extent).
std::vector<std::array<int, 3>> convex_hull(const std::vector<Vec3>& points);

/// Sign of det(b - a, c - a, d - a), exact as long as no product of three coordinates underflows:
/// +1 when d lies on the side to which the triangle a b c turns counterclockwise, 0 when the four
/// points are coplanar.
int side_of_plane(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace volcontact
