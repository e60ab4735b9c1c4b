// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/overlap.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/helpers.h>

#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace volcontact_cgal {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;

using Exact = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactSurface = CGAL::Surface_mesh<Exact::Point_3>;

ExactSurface exact_surface(Soup soup, const char* name) {
  clean(soup, 0.0);
  std::vector<Exact::Point_3> points;
  for (const Point& p : soup.points) points.emplace_back(p[0], p[1], p[2]);
  std::vector<std::vector<std::size_t>> faces;
  for (const Face& face : soup.faces) {
    if (CGAL::collinear(points[face[0]], points[face[1]], points[face[2]])) {
      throw std::invalid_argument(std::string(name) + " has a face without area");
    }
    faces.emplace_back(face.begin(), face.end());
  }
  ExactSurface surface;
  if (faces.empty() || !pmp::is_polygon_soup_a_polygon_mesh(faces)) {
    throw std::invalid_argument(std::string(name) + " is no surface");
  }
  pmp::polygon_soup_to_polygon_mesh(points, faces, surface);
  if (!CGAL::is_closed(surface)) throw std::invalid_argument(std::string(name) + " is open");
  return surface;
}

/// An exact number as an unevaluated sum of two doubles.
long double rounded(const Exact::FT& number) {
  const auto& exact = CGAL::exact(number);
  const double high = CGAL::to_double(exact);
  using Number = std::decay_t<decltype(exact)>;
  const Number rest = exact - Number(high);
  return static_cast<long double>(high) + CGAL::to_double(rest);
}

Moments moments_of(const ExactSurface& surface) {
  const Exact::Point_3& first = surface.point(*surface.vertices().begin());
  const Point origin = {CGAL::to_double(first.x()), CGAL::to_double(first.y()),
                        CGAL::to_double(first.z())};
  std::vector<MomentSum::Corner> corners(surface.num_vertices());
  for (const auto v : surface.vertices()) {
    const Exact::Point_3& p = surface.point(v);
    for (int i = 0; i < 3; ++i) corners[v][i] = rounded(p[i] - Exact::FT(origin[i]));
  }
  MomentSum sum;
  for (const auto f : surface.faces()) {
    const auto h = surface.halfedge(f);
    sum.add(corners[surface.source(h)], corners[surface.target(h)],
            corners[surface.target(surface.next(h))]);
  }
  return sum.result(origin);
}

}  // namespace

Overlap overlap(Soup a, Soup b) {
  ExactSurface surface_a = exact_surface(std::move(a), "the first mesh");
  ExactSurface surface_b = exact_surface(std::move(b), "the second mesh");
  ExactSurface common;
  if (!pmp::corefine_and_compute_intersection(surface_a, surface_b, common)) {
    throw std::runtime_error("the overlap is no surface: solids touch along an edge or a corner");
  }
  common.collect_garbage();
  Overlap out;
  out.faces = common.number_of_faces();
  if (out.faces == 0) return out;
  auto part = common.add_property_map<ExactSurface::Face_index, std::size_t>("f:part").first;
  out.parts = pmp::connected_components(common, part);
  out.moments = moments_of(common);
  return out;
}

}  // namespace volcontact_cgal
