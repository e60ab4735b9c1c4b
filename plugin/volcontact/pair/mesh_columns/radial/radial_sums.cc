// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/radial/radial_sums.h"

#include <cmath>

#include "volcontact/base/fields.h"
#include "volcontact/pair/quadrature/triangle_rule.h"

namespace volcontact {
namespace {

using namespace triangle_rule;

constexpr double kSliverDoubt = 0.25;    // of what it adds
constexpr double kLeastVolume = 1e-300;  // to divide by
constexpr double kLeastRadius = 1e-12;   // of the wall's size: on the axis, or in a tube's middle

}  // namespace
}  // namespace volcontact

#define VOLCONTACT_SIMD_KERNEL "volcontact/pair/mesh_columns/radial/radial_sums_kernel.inc"
#include "volcontact/base/simd_paths.inc"
#undef VOLCONTACT_SIMD_KERNEL

namespace volcontact {

void RadialPieces::clear() {
  for (auto& of_corner : corner) {
    for (auto& values : of_corner) values.clear();
  }
  for (int k = 0; k < 3; ++k) middle[k].clear(), normal[k].clear();
  area.clear();
  part_of_triangle.clear();
  part_of_sliver.clear();
  triangles = slivers = 0;
}

void RadialPieces::add_triangle(const Vec3& a, const Vec3& b, const Vec3& c, int part) {
  for (int k = 0; k < 3; ++k) {
    corner[0][k].push_back(a[k]);
    corner[1][k].push_back(b[k]);
    corner[2][k].push_back(c[k]);
  }
  part_of_triangle.push_back(part);
  ++triangles;
}

void RadialPieces::add_sliver(const Vec3& chord_middle, const Vec3& unit_normal, double signed_area,
                              int part) {
  for (int k = 0; k < 3; ++k) {
    middle[k].push_back(chord_middle[k]);
    normal[k].push_back(unit_normal[k]);
  }
  area.push_back(signed_area);
  part_of_sliver.push_back(part);
  ++slivers;
}

void RadialPieces::end() {
  while (part_of_triangle.size() % kLanes != 0) {
    const std::size_t last = part_of_triangle.size() - 1;
    const Vec3 p(corner[0][0][last], corner[0][1][last], corner[0][2][last]);
    add_triangle(p, p, p, part_of_triangle[last]);
    --triangles;
  }
  while (part_of_sliver.size() % kLanes != 0) {
    const std::size_t last = part_of_sliver.size() - 1;
    add_sliver(Vec3(middle[0][last], middle[1][last], middle[2][last]), Vec3::Zero(), 0.0,
               part_of_sliver[last]);
    --slivers;
  }
}

RadialSum sum_radial_columns(const RadialWall& wall, const RadialPieces& pieces, SimdPath path,
                             std::vector<double>& doubt_of_part) {
  if (wall.torus) {
    return VOLCONTACT_SIMD_CALL(path, sum_radial_wide<true>, wall, pieces, doubt_of_part);
  }
  return VOLCONTACT_SIMD_CALL(path, sum_radial_wide<false>, wall, pieces, doubt_of_part);
}

}  // namespace volcontact
