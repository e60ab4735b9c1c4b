// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/base/fields.h"
#include "volcontact/base/simd.h"
#include "volcontact/base/types.h"
#include "volcontact/pair/mesh_columns/surface_view.h"
#include "volcontact/shape/mesh/obb_tree.h"

namespace volcontact {

/// A face of A below a face of B in the column frame C, whose columns run along z: the part of
/// their common projection where B's face is the higher one. docs/theory.md, "Columns".
struct ColumnCell {
  ColumnCell() {}  // its arrays are filled as far as they are used

  int f, g;            ///< slots of A's and B's trees; g is -1 for a half-space
  signed char sign_f;  ///< of the z component of f's outward normal
  signed char sign_g;
  signed char count;            ///< corners of the polygon, counterclockwise
  unsigned char labels;         ///< bit l is set where some edge has the label l
  unsigned char walls;          ///< bit l is set where no cell lies across the edges of label l
  signed char label[kLanes];    ///< of the edge that begins at each corner: half-edge i of f, 3 + i
                                ///< of g, 6 where the two faces cross
  double x[kLanes], y[kLanes];  ///< corners [m]
  double middle[kLanes];        ///< height half way between the faces [m]
  double delta[kLanes];         ///< height of g above f [m]
  double slope_f[2], slope_g[2];  ///< of the faces' heights along x and y
  double area;                    ///< of the polygon [m^2]

  /// Whether a point lies in the polygon, or off it by no more than a fraction of its edges.
  bool covers(double px, double py, double slack = 0.0) const {
    for (int i = 0; i < count; ++i) {
      const int j = i + 1 == count ? 0 : i + 1;
      const double dx = x[j] - x[i], dy = y[j] - y[i];
      const double side = dx * (py - y[i]) - dy * (px - x[i]);
      if (side < -slack * (dx * dx + dy * dy)) return false;
    }
    return true;
  }
  double height_of_f(double px, double py) const {
    return middle[0] - 0.5 * delta[0] + slope_f[0] * (px - x[0]) + slope_f[1] * (py - y[0]);
  }
  double height_of_g(double px, double py) const {
    return middle[0] + 0.5 * delta[0] + slope_g[0] * (px - x[0]) + slope_g[1] * (py - y[0]);
  }
};

inline constexpr int kCrossing = 6;  ///< label of an edge where the two faces cross

/// Part of the column frame that is looked at: the faces of A that reach above `low.z`, those of B
/// that reach below `high.z`, both over the rectangle.
struct ColumnWindow {
  Vec3 low = Vec3::Constant(-kInfinity);
  Vec3 high = Vec3::Constant(kInfinity);
};

/// Memory of the search for cells.
struct CellScratch {
  SimdPath path = best_simd_path();
  std::vector<NodePair> stack;
  std::vector<int> leaf_pairs;  ///< leaf of A, leaf of B, ...
  std::vector<ColumnCell> cells;
  bool upright = false;  ///< some triangle in the window has no projection
  struct Share {
    std::vector<ColumnCell> cells;
    bool upright;
  };
  std::vector<Share> shares;  ///< of several threads
};

/// Lists the pairs of leaves that may hold cells; false when there are more than `most`.
bool find_leaf_pairs(const ObbTree& a, const Pose& X_CA, const ObbTree& b, const Pose& X_CB,
                     const ColumnWindow& window, int most, CellScratch& scratch);

/// Makes the cells of those pairs, in a fixed order whatever the number of threads.
void make_cells(const ObbTree& a, const Pose& X_CA, const ObbTree& b, const Pose& X_CB,
                const ColumnWindow& window, int threads, CellScratch& scratch);

/// The cells of A with the half-space z < 0 of C.
void make_cells_below(const ObbTree& a, const Pose& X_CA, CellScratch& scratch);

/// One face of a convex solid, on the plane z = 0 of C with the solid below it.
struct ColumnPrism {
  ColumnWindow bounds;              ///< of the solid
  std::vector<SurfacePlane> sides;  ///< its other faces
  double margin = 0.0;              ///< nearer to a side, nobody knows on which side of it [m]
};

/// The cells of A with a convex solid whose other faces A's surface does not meet: those of the
/// triangles within it. False when it meets one of them.
bool make_cells_in_prism(const ObbTree& a, const Pose& X_CA, const ColumnPrism& prism,
                         CellScratch& scratch);

/// Whether some triangle meets the rectangle of the window at height z.
bool meets_level(const ObbTree& tree, const Pose& X_CM, const ColumnWindow& window, double z,
                 CellScratch& scratch);

/// How many times the surface winds around the origin of C: the sum over the triangles above it on
/// the z axis. False when the axis passes too near an edge to say.
bool winding(const ObbTree& tree, const Pose& X_CM, CellScratch& scratch, int& number);

/// Where a line parallel to z passes through a surface.
struct ColumnHit {
  double z;
  double slope[2];  ///< of the face
  int side;         ///< 0: of A, 1: of B
  int sign;         ///< +1 where the line leaves the solid upwards
};

/// Appends the hits of the surface on the line above (x, y) in C, as those of `side`.
void add_hits(const ObbTree& tree, const Pose& X_CM, double x, double y, int side,
              CellScratch& scratch, std::vector<ColumnHit>& hits);

}  // namespace volcontact
