// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "volcontact/pair/mesh_columns/column_cells.h"

namespace volcontact {

/// The region that the two faces of a cell belong to; -1: the face is not surface of the overlap
/// there, and what it adds cancels out.
struct CellRegion {
  int of_f, of_g;
  int of_wall_f, of_wall_g;  ///< of the upright faces on edges of f and of g
  bool through = true;       ///< all of the column between the two faces is overlap
};

/// Memory of the search for regions.
struct RegionScratch {
  std::vector<std::uint64_t> keys;  ///< hash table: slots of f and g
  std::vector<int> cell_at;
  std::vector<int> parent;  ///< of the A side (2 i) and the B side (2 i + 1) of cell i
  std::vector<std::uint64_t> keys_of_faces;
  std::vector<int> order;
  std::vector<int> number;  ///< of each root
  struct Wall {
    int slot, element;
    bool of_a;
  };
  std::vector<Wall> walls;
  std::vector<unsigned char> solid;
  std::vector<CellRegion> region_of;
  std::vector<int> cell_of_slot;  ///< -1 between uses
  double left_out = 0.0;  ///< net area of the faces whose cells nearly cancel each other [m^2]
};

/// Parts the cells into the connected regions of the overlap and marks the edges of cells across
/// which there is no cell. By `rounding` corners of cells are off [m]. Returns the number of
/// regions; `scratch.region_of` has one entry per cell. docs/theory.md, "Columns".
int find_regions(const ObbTree& a, const ObbTree* b, double rounding,
                 std::vector<ColumnCell>& cells, RegionScratch& scratch);

/// Whether the cells are stacked: a column passes through more than one face of A or of B.
bool is_layered(const std::vector<ColumnCell>& cells);

}  // namespace volcontact
