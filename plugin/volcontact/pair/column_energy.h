// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "volcontact/base/types.h"

namespace volcontact {

/// A linear function of the place (u, v) across the columns: a height, or the side of a line.
struct HeightPlane {
  double at_origin = 0.0;
  double per_u = 0.0;
  double per_v = 0.0;

  double operator()(double u, double v) const { return at_origin + per_u * u + per_v * v; }
  HeightPlane operator-(const HeightPlane& other) const {
    return {at_origin - other.at_origin, per_u - other.per_u, per_v - other.per_v};
  }
};

/// A face of the region seen along the columns.
struct ColumnFace {
  int first;  ///< of its outline, in ColumnScene::outlines
  int count;
  HeightPlane height;
  bool overhang;  ///< belongs to the solid that should be on the other side
  Eigen::Vector2d min, max;  ///< of the outline
};

/// A convex region between upper and lower faces, of two solids pressed together along the columns:
/// the upper faces should belong to the lower solid (its top, inside the upper one) and vice versa.
struct ColumnScene {
  std::vector<Eigen::Vector2d> outlines;  ///< counterclockwise seen from above
  std::vector<ColumnFace> upper;
  std::vector<ColumnFace> lower;
  std::vector<HeightPlane> ceiling;  ///< planes over the lower solid; its top is their minimum
  std::vector<HeightPlane> floor;    ///< planes under the upper solid; its bottom is their maximum
  std::vector<Eigen::Vector2d> work[3];

  void clear();
  void add_face(bool is_upper, const HeightPlane& height, bool overhang,
                std::span<const Eigen::Vector2d> outline);
};

/// int [L^2/2 + L (overhang)] du dv over the columns of the region: L is the column's length, the
/// overhang how far the lower solid reaches over the column's top and the upper solid under its
/// bottom. Without overhang this is int L^2/2; its derivative along the columns is V always, so it
/// is the potential of f = V. docs/theory.md, "Depth moment".
double column_energy(ColumnScene& scene);

}  // namespace volcontact
