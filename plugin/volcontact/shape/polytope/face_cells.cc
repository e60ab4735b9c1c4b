// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/polytope/face_cells.h"

#include <stdexcept>
#include <utility>

#include "volcontact/shape/polytope/cut_polytope.h"

namespace volcontact {
namespace {

constexpr double kSpeck = 1e-14;  // of the volume, or of the size for a plane's height
constexpr double kParallel = 1e-13;

// The corners of what is nearest to face f; none where nothing is.
std::vector<Vec3> corners_of_cell(const ConvexPolytope& solid, std::size_t f, CutPolytope& cut) {
  const PolytopeGraph& graph = solid.graph();
  const std::vector<ConvexPolytope::Face>& faces = solid.faces();
  cut.start(graph);
  const std::span<Vec3> points = cut.points();
  for (std::size_t v = 0; v < points.size(); ++v) {
    points[v] = solid.vertices()[static_cast<std::size_t>(graph.corner[v])];
  }
  for (std::size_t g = 0; g < faces.size(); ++g) {
    if (g == f) continue;
    // Depth under f over the depth under g.
    const Vec3 slope = faces[g].normal - faces[f].normal;
    const double at_origin = faces[f].offset - faces[g].offset, steepness = slope.norm();
    if (steepness < kParallel) {
      if (at_origin > 0.0 || (at_origin == 0.0 && g < f)) return {};
      continue;
    }
    const auto height = [&](const Vec3& x) { return (at_origin + slope.dot(x)) / steepness; };
    if (!cut.cut(height, static_cast<int>(faces.size() + g), 0.0)) return {};
  }
  const std::span<const Vec3> left = std::as_const(cut).points();
  return {left.begin(), left.end()};
}

}  // namespace

std::vector<FaceCell> make_face_cells(const ConvexPolytope& solid) {
  std::vector<FaceCell> cells;
  CutPolytope cut;
  for (std::size_t f = 0; f < solid.faces().size(); ++f) {
    const std::vector<Vec3> corners = corners_of_cell(solid, f, cut);
    if (corners.size() < 4) continue;
    try {
      FaceCell cell{static_cast<int>(f), ConvexPolytope(corners)};
      if (cell.solid.own_metrics().volume > kSpeck * solid.own_metrics().volume) {
        cells.push_back(std::move(cell));
      }
    } catch (const std::invalid_argument&) {
      // Flat: a face that is nowhere the nearest one by more than rounding.
    }
  }
  return cells;
}

}  // namespace volcontact
