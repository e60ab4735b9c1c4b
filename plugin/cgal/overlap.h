// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "cgal/moments.h"
#include "cgal/soup.h"

namespace volcontact_cgal {

/// The common part of two solids.
struct Overlap {
  Moments moments;
  std::size_t faces = 0;  ///< of its surface
  std::size_t parts = 0;  ///< of its surface
};

/// The overlap by corefinement with exact numbers: only the moments of the exact result are
/// rounded, to about 1e-15 of the overlap's own size. Both soups must bound a volume. Throws
/// std::invalid_argument if one does not, std::runtime_error if their overlap is no surface.
Overlap overlap(Soup a, Soup b);

}  // namespace volcontact_cgal
