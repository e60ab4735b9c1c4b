// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "volcontact/metrics/volume_metrics.h"
#include "volcontact/shape/shapes.h"

namespace volcontact {

/// The shape of a contact site, for pictures: columns along the contact normal, from where they
/// enter the overlap to where they leave it, joined into triangles. No force comes from it.
struct OverlapSurface {
  struct Column {
    Vec3 low;   ///< the end against the normal [m]
    Vec3 high;  ///< the end along the normal [m]
  };
  std::vector<Column> columns;
  std::vector<std::array<int, 3>> triangles;  ///< counterclockwise seen against the normal
  std::vector<std::array<int, 2>> rim;        ///< lines around it, the overlap to the left
};

/// Surface of one site of A and B. Where a column crosses the overlap twice, it spans both. Empty
/// where the site has no volume, or where it is thinner than the columns are apart.
/// `site`: its metrics in W and about W's origin. `resolution`: columns across the site.
OverlapSurface overlap_surface(const Shape& a, const Pose& X_WA, const Shape& b, const Pose& X_WB,
                               const VolumeMetrics& site, int resolution);

}  // namespace volcontact
