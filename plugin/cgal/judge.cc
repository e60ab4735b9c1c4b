// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/judge.h"

#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/boost/graph/helpers.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "cgal/surface.h"

namespace volcontact_cgal {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;

using Triangle = std::array<Point, 3>;

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Triangle triangle(const Soup& soup, std::size_t face) {
  const Face& f = soup.faces[face];
  return {soup.points[f[0]], soup.points[f[1]], soup.points[f[2]]};
}

/// Where the edge from p to q passes through the triangle, if it does.
std::optional<Point> passage(const Point& p, const Point& q, const Triangle& t) {
  const Point normal = cross(minus(t[1], t[0]), minus(t[2], t[0]));
  const double at_p = dot(normal, minus(p, t[0]));
  const double at_q = dot(normal, minus(q, t[0]));
  if (at_p == at_q || (at_p > 0.0) == (at_q > 0.0)) return std::nullopt;
  const double s = at_p / (at_p - at_q);
  const Point x = {p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1]), p[2] + s * (q[2] - p[2])};
  for (int i = 0; i < 3; ++i) {
    const Point& a = t[i];
    if (dot(normal, cross(minus(t[(i + 1) % 3], a), minus(x, a))) < 0.0) return std::nullopt;
  }
  return x;
}

/// A point for a person to look at: the middle of the passages of edges, else of the corners.
Point meeting_place(const Triangle& a, const Triangle& b) {
  std::vector<Point> found;
  for (const auto& [edges, other] : {std::pair{a, b}, std::pair{b, a}}) {
    for (int i = 0; i < 3; ++i) {
      if (const auto x = passage(edges[i], edges[(i + 1) % 3], other)) found.push_back(*x);
    }
  }
  if (found.empty()) {
    found.assign(a.begin(), a.end());
    found.insert(found.end(), b.begin(), b.end());
  }
  Point middle{};
  for (const Point& x : found) {
    for (int i = 0; i < 3; ++i) middle[i] += x[i] / static_cast<double>(found.size());
  }
  return middle;
}

Moments moments_of(const Soup& soup) {
  MomentSum sum;
  const Point origin = soup.points.front();
  const auto corner = [&](std::size_t i) -> MomentSum::Corner {
    const Point& p = soup.points[i];
    return {static_cast<long double>(p[0]) - origin[0], static_cast<long double>(p[1]) - origin[1],
            static_cast<long double>(p[2]) - origin[2]};
  };
  for (const Face& f : soup.faces) sum.add(corner(f[0]), corner(f[1]), corner(f[2]));
  return sum.result(origin);
}

/// Whether two faces that CGAL took for strangers meet elsewhere than in corners that they share.
bool meet_elsewhere(const Soup& soup, std::size_t a, std::size_t b) {
  const auto point = [&](std::size_t i) {
    const Point& p = soup.points[i];
    return Kernel::Point_3(p[0], p[1], p[2]);
  };
  Face f = soup.faces[a];
  Face g = soup.faces[b];
  // Shared corners to the front, in the same order.
  std::size_t shared = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto twin = std::find(g.begin() + shared, g.end(), f[i]);
    if (twin == g.end()) continue;
    std::iter_swap(twin, g.begin() + shared);
    std::swap(f[i], f[shared]);
    ++shared;
  }
  if (shared == 0 || shared == 3) return true;
  const Kernel::Point_3 p = point(f[0]), q = point(f[1]), r = point(f[2]);
  const Kernel::Point_3 s = point(g[1]), t = point(g[2]);
  if (shared == 2) {  // an edge: they overlap if they lie flat on the same side of it
    return CGAL::coplanar(p, q, r, t) && CGAL::coplanar_orientation(p, q, r, t) == CGAL::POSITIVE;
  }
  return CGAL::do_intersect(Kernel::Triangle_3(p, q, r), Kernel::Segment_3(s, t)) ||
         CGAL::do_intersect(Kernel::Triangle_3(p, s, t), Kernel::Segment_3(q, r));
}

void find_crossings(const Surface& surface, const Soup& soup, std::size_t most, Judgement& out) {
  std::vector<std::pair<Surface::Face_index, Surface::Face_index>> pairs;
  pmp::self_intersections(faces_with_area(surface), surface, std::back_inserter(pairs));
  if (!out.is_surface) {  // a doubled point is no crossing
    std::erase_if(pairs, [&](const auto& p) { return !meet_elsewhere(soup, p.first, p.second); });
  }
  out.crossings = pairs.size();
  for (auto& [a, b] : pairs) {
    if (b < a) std::swap(a, b);
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.resize(std::min(pairs.size(), most));
  for (const auto& [a, b] : pairs) {
    out.shown.push_back({out.cleaning.kept[a], out.cleaning.kept[b],
                         meeting_place(triangle(soup, a), triangle(soup, b))});
  }
}

}  // namespace

Judgement judge(Soup soup, std::size_t most) {
  Judgement out;
  out.cleaning = clean(soup, 0.0);
  if (soup.faces.empty()) return out;

  std::vector<std::vector<std::size_t>> faces;
  for (const Face& face : soup.faces) faces.emplace_back(face.begin(), face.end());
  out.is_surface = pmp::is_polygon_soup_a_polygon_mesh(faces);
  Surface surface = surface_of(soup);
  auto part = surface.add_property_map<Surface::Face_index, std::size_t>("f:part").first;
  out.parts = pmp::connected_components(surface, part);
  out.closed = CGAL::is_closed(surface);
  out.oriented = count_turned(soup, surface) == 0;
  find_crossings(surface, soup, most, out);
  if (out.closed && out.oriented) {
    out.moments = moments_of(soup);
    out.outward = pmp::is_outward_oriented(surface);
    out.bounds_volume = out.crossings == 0 && pmp::does_bound_a_volume(surface);
  }
  return out;
}

}  // namespace volcontact_cgal
