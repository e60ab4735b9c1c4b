// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <vector>

#include "cgal/soup.h"

namespace volcontact_cgal {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

/// A surface whose face i is face i of the soup, perhaps turned. Points at which it is no surface
/// are doubled. The soup must be clean.
inline Surface surface_of(const Soup& soup) {
  namespace pmp = CGAL::Polygon_mesh_processing;
  std::vector<Kernel::Point_3> points;
  points.reserve(soup.points.size());
  for (const Point& p : soup.points) points.emplace_back(p[0], p[1], p[2]);
  std::vector<std::vector<std::size_t>> faces;
  faces.reserve(soup.faces.size());
  for (const Face& face : soup.faces) faces.emplace_back(face.begin(), face.end());
  if (!pmp::is_polygon_soup_a_polygon_mesh(faces)) pmp::orient_polygon_soup(points, faces);
  Surface surface;
  pmp::polygon_soup_to_polygon_mesh(points, faces, surface);
  return surface;
}

/// Faces that run the other way round than in the soup of which `surface_of` made them.
inline std::size_t count_turned(const Soup& soup, const Surface& surface) {
  std::size_t turned = 0;
  for (std::size_t i = 0; i < soup.faces.size(); ++i) {
    const auto corner = [&](std::size_t k) {  // a doubled point has equal coordinates
      const Point& p = soup.points[soup.faces[i][k]];
      return Kernel::Point_3(p[0], p[1], p[2]);
    };
    auto h = surface.halfedge(Surface::Face_index(static_cast<Surface::size_type>(i)));
    while (surface.point(surface.source(h)) != corner(0)) h = surface.next(h);
    turned += surface.point(surface.target(h)) != corner(1);
  }
  return turned;
}

/// The faces with an area: tests for crossings want no others.
inline std::vector<Surface::Face_index> faces_with_area(const Surface& surface) {
  std::vector<Surface::Face_index> faces;
  for (const auto f : surface.faces()) {
    const auto h = surface.halfedge(f);
    if (!CGAL::collinear(surface.point(surface.source(h)), surface.point(surface.target(h)),
                         surface.point(surface.target(surface.next(h))))) {
      faces.push_back(f);
    }
  }
  return faces;
}

/// The triangles of a surface without removed elements.
inline Soup soup_of(const Surface& surface) {
  Soup soup;
  soup.points.reserve(surface.number_of_vertices());
  for (const auto v : surface.vertices()) {
    const Kernel::Point_3& p = surface.point(v);
    soup.points.push_back({p.x(), p.y(), p.z()});
  }
  soup.faces.reserve(surface.number_of_faces());
  for (const auto f : surface.faces()) {
    Face face{};
    std::size_t i = 0;
    for (const auto v : vertices_around_face(surface.halfedge(f), surface)) {
      if (i < 3) face[i++] = v;
    }
    soup.faces.push_back(face);
  }
  return soup;
}

}  // namespace volcontact_cgal
