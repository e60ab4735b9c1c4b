// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cgal/soup.h"

namespace volcontact_cgal {

/// A closed surface free of crossings around any soup, at most about `offset` away from it, blind
/// to holes narrower than `alpha` (both in the soup's unit). Everything grows by the offset. Throws
/// std::runtime_error where CGAL is older than 5.5, which brought it.
Soup wrap(const Soup& soup, double alpha, double offset);

}  // namespace volcontact_cgal
