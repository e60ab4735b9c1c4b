// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/radial/radial_search.h"

#include <cmath>

namespace volcontact {
namespace {

constexpr double kNearPole = 0.5;  // of the distance to the middle of a tube
constexpr double kOffPlane =
    1e-9;  // of its size: a triangle nearer to a plane is looked at closely

double size_of_plane(const SurfacePlane& plane) { return std::abs(plane.offset); }

}  // namespace
}  // namespace volcontact

#define VOLCONTACT_SIMD_KERNEL "volcontact/pair/mesh_columns/radial/radial_search_kernel.inc"
#include "volcontact/base/simd_paths.inc"
#undef VOLCONTACT_SIMD_KERNEL

namespace volcontact {

void find_triangles_at_wall(const ObbTree& tree, const Pose& X_QM, const RadialSolid& solid,
                            RadialSearchScratch& scratch) {
  VOLCONTACT_SIMD_CALL(scratch.path, find_at_wall_wide, tree, X_QM, solid, scratch);
}

}  // namespace volcontact
