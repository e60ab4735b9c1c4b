// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/repair.h"

#define CGAL_HOLE_FILLING_DO_NOT_USE_CDT2  // it would double the time to compile this file
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/boost/graph/helpers.h>

#include <algorithm>
#include <iterator>

#include "cgal/surface.h"

namespace volcontact_cgal {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;

Hole measure(const Surface& surface, Surface::Halfedge_index start) {
  Hole hole;
  for (const auto h : halfedges_around_face(start, surface)) {
    const Kernel::Point_3& p = surface.point(surface.target(h));
    for (int i = 0; i < 3; ++i) {
      hole.low[i] = hole.edges == 0 ? p[i] : std::min(hole.low[i], p[i]);
      hole.high[i] = hole.edges == 0 ? p[i] : std::max(hole.high[i], p[i]);
    }
    ++hole.edges;
  }
  return hole;
}

std::vector<Hole> close_holes(Surface& surface, bool fill) {
  std::vector<Surface::Halfedge_index> starts;
  pmp::extract_boundary_cycles(surface, std::back_inserter(starts));
  std::vector<Hole> holes;
  for (const auto start : starts) {
    Hole hole = measure(surface, start);
    if (fill) {
      std::vector<Surface::Face_index> patch;
      pmp::triangulate_hole(surface, start, std::back_inserter(patch));
      hole.filled = !patch.empty();
    }
    holes.push_back(hole);
  }
  return holes;
}

/// Turns parts outward, and parts inside others so that they are hollows. Crossing parts are only
/// turned outward one by one: which is inside which is not defined then.
bool turn_outward(Surface& surface) {
  if (!CGAL::is_closed(surface)) return false;
  if (pmp::does_self_intersect(faces_with_area(surface), surface)) {
    if (pmp::is_outward_oriented(surface)) return false;
    pmp::orient(surface);
    return true;
  }
  if (pmp::does_bound_a_volume(surface)) {
    if (pmp::is_outward_oriented(surface)) return false;
    pmp::reverse_face_orientations(surface);
    return true;
  }
  pmp::orient_to_bound_a_volume(surface);
  return true;
}

}  // namespace

RepairReport repair(Soup& soup, const RepairOptions& options) {
  RepairReport report;
  report.cleaning = clean(soup, options.weld);
  if (soup.faces.empty()) return report;

  Surface surface = surface_of(soup);
  report.points_doubled = surface.number_of_vertices() - soup.points.size();
  report.faces_turned = count_turned(soup, surface);
  report.edges_stitched = pmp::stitch_borders(surface);
  report.holes = close_holes(surface, options.fill);
  report.turned = turn_outward(surface);
  surface.collect_garbage();
  soup = soup_of(surface);
  return report;
}

}  // namespace volcontact_cgal
