// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/metrics/volume_metrics.h"
#include "volcontact/pair/mesh_columns/column_cells.h"
#include "volcontact/pair/mesh_columns/surface_view.h"

namespace volcontact {

/// How often the surface winds around p, in its frame: 0 outside.
int winding_around(const SurfaceView& solid, const Vec3& p, CellScratch& scratch);

/// What the overlap owes to those parts of the surfaces that cross nothing of the other solid: each
/// of them lies wholly inside of it, and bounds the overlap there, or wholly outside. `crossing_a`
/// and `crossing_b` list the parts that do cross, sorted. In A's frame; the volume is negative
/// where cavities take away more than there is.
VolumeMetrics contained_parts(const SurfaceView& a, const SurfaceView& b, const Pose& X_AB,
                              const std::vector<int>& crossing_a,
                              const std::vector<int>& crossing_b, CellScratch& scratch);

}  // namespace volcontact
