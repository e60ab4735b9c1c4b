// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "cgal/soup.h"

namespace volcontact_cgal {

struct RepairOptions {
  double weld = 0.0;  ///< points nearer than this along each axis become one [m]
  bool fill = true;   ///< close holes by triangles
};

/// A hole as it was before it was closed, or left open.
struct Hole {
  std::size_t edges = 0;
  Point low{};   ///< of its bounding box [m]
  Point high{};  ///< [m]
  bool filled = false;
};

/// What a repair did.
struct RepairReport {
  Cleaning cleaning;
  std::size_t points_doubled = 0;  ///< where the faces were no surface
  std::size_t faces_turned = 0;    ///< to agree with their neighbours
  std::size_t edges_stitched = 0;  ///< pairs of equal open edges that became one
  std::vector<Hole> holes;
  bool turned = false;  ///< faces were turned so that parts bound a volume
};

/// Repairs a soup in place: weld, clean, orient, stitch, fill, orient outward. What comes out may
/// still bound no volume: judge it.
RepairReport repair(Soup& soup, const RepairOptions& options);

}  // namespace volcontact_cgal
