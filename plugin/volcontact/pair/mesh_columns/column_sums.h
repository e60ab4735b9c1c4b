// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/metrics/volume_metrics.h"
#include "volcontact/pair/mesh_columns/column_regions.h"

namespace volcontact {

/// Sums over the cells of one region, about the origin of C: int x^i y^j z^k dz dx dy, with z from
/// A's face to B's.
struct CellSum {
  MomentSum moments;                   ///< with the area vector and moment of A's surface
  Vec3 counter_vector = Vec3::Zero();  ///< area vector of B's surface: the two close the region
  double energy = 0.0;                 ///< int delta^2/2 over the cells [m^4]
  double depth = 0.0;                  ///< length of the longest column that is all overlap [m]
  double absolute = 0.0;  ///< sum of the magnitudes of what was added to the volume [m^3]
  double seen = 0.0;      ///< area of the faces in the cells [m^2]: by so much rounding counts

  CellSum& operator+=(const CellSum& other);
};

/// A surface in C, for the walls that no cell shows.
struct ColumnSurface {
  const ObbTree* tree;
  const Pose* X_CM;
};

/// Sums of one region.
CellSum sum_region(int region, const std::vector<ColumnCell>& cells,
                   const std::vector<CellRegion>& region_of, const ColumnSurface& a,
                   const ColumnSurface& b, SimdPath path);

/// int delta^2/2 over all cells, with their signs: the work of the volume against a shift of A
/// along z. Where cells are layered it cannot be told apart by region.
double energy_of(const std::vector<ColumnCell>& cells);

}  // namespace volcontact
