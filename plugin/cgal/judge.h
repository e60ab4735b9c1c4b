// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "cgal/moments.h"
#include "cgal/soup.h"

namespace volcontact_cgal {

/// Two faces that have more in common than an edge or a corner.
struct Crossing {
  std::size_t face_a = 0;
  std::size_t face_b = 0;
  Point place{};  ///< a point where they meet, rounded [m]
};

/// What CGAL says of a soup.
struct Judgement {
  Cleaning cleaning;        ///< what was left out before judging
  bool is_surface = false;  ///< every edge has at most two faces, turned alike; no pinched corner
  bool closed = false;      ///< no edge has one face alone, once points are doubled to be a surface
  bool oriented = false;    ///< no face had to be turned for that
  bool outward = false;     ///< the faces show outwards, of a closed and oriented surface
  bool bounds_volume =
      false;  ///< closed, oriented, free of crossings, parts turned as nested solids need
  std::size_t parts = 0;  ///< faces connected across edges
  std::size_t crossings = 0;
  std::vector<Crossing> shown;  ///< the first of them
  Moments moments;              ///< of a closed and oriented surface
};

/// Judges a soup and shows at most `most` crossings, lowest faces first.
Judgement judge(Soup soup, std::size_t most);

}  // namespace volcontact_cgal
