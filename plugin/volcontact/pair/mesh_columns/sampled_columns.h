// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/metrics/volume_metrics.h"
#include "volcontact/pair/mesh_columns/column_cells.h"
#include "volcontact/pair/mesh_columns/surface_view.h"

namespace volcontact {

/// Memory of the sampled columns.
struct SampledScratch {
  std::vector<ColumnHit> hits;
};

/// The overlap from a fixed number of columns along z of C: at a bounded cost whatever the shapes,
/// to about a per cent, with Status::kApproximate. `volume_error` is an estimate: twice the
/// difference between the two halves of the columns. In C's frame.
VolumeMetrics sampled_columns(const SurfaceView& a, const Pose& X_CA, const SurfaceView& b,
                              const Pose& X_CB, CellScratch& cells, SampledScratch& scratch);

}  // namespace volcontact
