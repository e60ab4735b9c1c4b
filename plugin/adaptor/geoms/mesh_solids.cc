// SPDX-License-Identifier: Apache-2.0
#include "adaptor/geoms/mesh_solids.h"

#include <stdexcept>
#include <string>

namespace volcontact::adaptor {
namespace {

Shape make_solid(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                 MeshForm form) {
  if (form == MeshForm::kHull) return ConvexPolytope(vertices);
  try {
    return Mesh(vertices, triangles);
  } catch (const std::invalid_argument&) {
    if (form == MeshForm::kExact) throw;
  }
  return ConvexPolytope(vertices);
}

}  // namespace

Shape mesh_solid(const mjModel* m, int geom, MeshForm form) {
  const int mesh = m->geom_dataid[geom];
  std::vector<Vec3> vertices;
  const float* vertex = m->mesh_vert + 3 * m->mesh_vertadr[mesh];
  for (int i = 0; i < m->mesh_vertnum[mesh]; ++i, vertex += 3) {
    vertices.emplace_back(vertex[0], vertex[1], vertex[2]);
  }
  std::vector<Triangle> triangles;
  const int* face = m->mesh_face + 3 * m->mesh_faceadr[mesh];
  for (int i = 0; i < m->mesh_facenum[mesh]; ++i, face += 3) {
    // Files have faces without area; MuJoCo hands them on.
    const bool folded = face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
    if (!folded) triangles.push_back({face[0], face[1], face[2]});
  }
  try {
    return make_solid(vertices, triangles, form);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(
        "geom '" + label(m, mjOBJ_GEOM, geom) + "', mesh '" + label(m, mjOBJ_MESH, mesh) +
        "' (coordinates in the geom's frame): " + error.what() +
        (form != MeshForm::kExact
             ? ""
             : ". Look at the file with `volcontact mesh check`, mend it with `volcontact mesh "
               "repair`, or let the convex hull stand for it: "
               "volcontact/option/mesh/exact_or_hull, or for all meshes: "
               "volcontact/option/mesh/hull"));
  }
}

Shape height_field_solid(const mjModel* m, int geom) {
  const int field = m->geom_dataid[geom];
  const int rows = m->hfield_nrow[field], columns = m->hfield_ncol[field];
  const mjtNum* size = m->hfield_size + 4 * field;  // half x, half y, top, base
  const float* heights = m->hfield_data + m->hfield_adr[field];
  std::vector<Vec3> vertices;
  for (const bool top : {true, false}) {
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < columns; ++c) {
        vertices.emplace_back((2.0 * c / (columns - 1) - 1.0) * size[0],
                              (2.0 * r / (rows - 1) - 1.0) * size[1],
                              top ? size[2] * heights[r * columns + c] : -size[3]);
      }
    }
  }
  std::vector<Triangle> triangles;
  const auto at = [&](bool top, int r, int c) {
    return (top ? 0 : rows * columns) + r * columns + c;
  };
  for (int r = 0; r + 1 < rows; ++r) {
    for (int c = 0; c + 1 < columns; ++c) {
      // MuJoCo walks along a strip from (r + 1, c) to (r, c) to (r + 1, c + 1) and so on.
      triangles.push_back({at(true, r, c), at(true, r + 1, c + 1), at(true, r + 1, c)});
      triangles.push_back({at(true, r, c), at(true, r, c + 1), at(true, r + 1, c + 1)});
      triangles.push_back({at(false, r, c), at(false, r + 1, c), at(false, r + 1, c + 1)});
      triangles.push_back({at(false, r, c), at(false, r + 1, c + 1), at(false, r, c + 1)});
    }
  }
  const auto add_wall = [&](int r0, int c0, int r1, int c1) {  // outside to the right
    triangles.push_back({at(true, r0, c0), at(false, r0, c0), at(false, r1, c1)});
    triangles.push_back({at(true, r0, c0), at(false, r1, c1), at(true, r1, c1)});
  };
  for (int c = 0; c + 1 < columns; ++c) {
    add_wall(0, c, 0, c + 1);
    add_wall(rows - 1, c + 1, rows - 1, c);
  }
  for (int r = 0; r + 1 < rows; ++r) {
    add_wall(r, columns - 1, r + 1, columns - 1);
    add_wall(r + 1, 0, r, 0);
  }
  try {
    return Mesh(vertices, triangles);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("geom '" + label(m, mjOBJ_GEOM, geom) + "', height field '" +
                                label(m, mjOBJ_HFIELD, field) + "': " + error.what());
  }
}

}  // namespace volcontact::adaptor
