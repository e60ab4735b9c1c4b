// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/metrics/volume_metrics.h"
#include "volcontact/pair/clip/column_energy.h"
#include "volcontact/shape/box.h"
#include "volcontact/shape/half_space.h"
#include "volcontact/shape/polytope/convex_polytope.h"
#include "volcontact/shape/polytope/cut_polytope.h"

namespace volcontact {

/// Memory of clip(), reused from call to call.
struct ClipScratch {
  CutPolytope polytope;
  ColumnEnergy columns;
  std::vector<Vec3> in_columns, normals;  // of the polytope and its faces, along the columns
  std::vector<Vec2> outline;
  std::vector<int> neighbors;
  std::vector<Vec3> corners;
  std::vector<Vec3> part;
};

/// Exact interference of two convex solids with plane faces: B is cut by A's planes and summed face
/// by face. In A's frame and about its origin; one site. docs/theory.md, "Clipping".
///
///   V = 1/3 sum over faces of int x . n dS, with x from a point of the overlap; moments likewise
///
/// volume_error bounds the rounding; a volume below it is reported as none, with an error that
/// holds it. One solid inside the other, and a solid pierced so evenly that S is rounding noise: S
/// = 0, no normal, and no depth (but in a half-space depth is always along its axis). Faces of both
/// solids in one plane, facing the same way, count as B's.
VolumeMetrics clip(const HalfSpace& a, const Box& b, const Pose& X_AB, ClipScratch& scratch);
VolumeMetrics clip(const HalfSpace& a, const ConvexPolytope& b, const Pose& X_AB,
                   ClipScratch& scratch);
VolumeMetrics clip(const Box& a, const Box& b, const Pose& X_AB, ClipScratch& scratch);
VolumeMetrics clip(const Box& a, const ConvexPolytope& b, const Pose& X_AB, ClipScratch& scratch);
VolumeMetrics clip(const ConvexPolytope& a, const ConvexPolytope& b, const Pose& X_AB,
                   ClipScratch& scratch);

}  // namespace volcontact
