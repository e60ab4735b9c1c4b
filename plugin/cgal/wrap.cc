// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/wrap.h"

#include <stdexcept>

#if __has_include(<CGAL/alpha_wrap_3.h>)
#include <CGAL/alpha_wrap_3.h>

#include <vector>

#include "cgal/surface.h"

namespace volcontact_cgal {

Soup wrap(const Soup& soup, double alpha, double offset) {
  std::vector<Kernel::Point_3> points;
  for (const Point& p : soup.points) points.emplace_back(p[0], p[1], p[2]);
  Surface surface;
  CGAL::alpha_wrap_3(points, soup.faces, alpha, offset, surface);
  return soup_of(surface);
}

}  // namespace volcontact_cgal

#else

namespace volcontact_cgal {

Soup wrap(const Soup&, double, double) {
  throw std::runtime_error("this CGAL is older than 5.5 and cannot wrap");
}

}  // namespace volcontact_cgal

#endif
