// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/pair/convex/convex_view.h"
#include "volcontact/pair/mesh_columns/in_round/round_pieces.h"

namespace volcontact {

/// Of five points spread in a convex solid the one farthest from the edges of triangles: a thin
/// part of their surface may hold any one of the points, and a thin hole of it too. In Q.
Vec3 point_off_edges(const ConvexView& solid, const Pose& X_QB,
                     const std::vector<RoundPieces::Triangle>& triangles);

/// Of fifteen points spread in a convex solid the one farthest from triangles. In Q.
Vec3 point_off_faces(const ConvexView& solid, const Pose& X_QB,
                     const std::vector<RoundPieces::Triangle>& triangles);

}  // namespace volcontact
