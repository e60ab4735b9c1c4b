// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace volcontact_cgal {

using Point = std::array<double, 3>;
using Face = std::array<std::size_t, 3>;

/// Triangles as a file has them: nothing is known of how they hang together.
struct Soup {
  std::vector<Point> points;  ///< [m], or the unit of the file
  std::vector<Face> faces;    ///< indices into `points`, counter-clockwise seen from outside
};

/// What was taken out of a soup, and the faces that stayed.
struct Cleaning {
  std::size_t points_welded = 0;
  std::size_t faces_folded = 0;  ///< with a corner twice
  std::size_t faces_twice = 0;
  std::vector<std::size_t> kept;  ///< for each face that stayed, its index before
};

/// Welds points no farther apart than `tolerance` along each axis (0: equal ones), and takes out
/// faces that have a corner twice. Of faces with the same three corners those turned against each
/// other go in pairs, and of the rest one stays. Faces of three points in a line stay: they hold
/// the others together.
Cleaning clean(Soup& soup, double tolerance);

}  // namespace volcontact_cgal
