// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "volcontact/pair/mesh_columns/crossing/crossing.h"
#include "volcontact/shape/solid.h"

namespace volcontact {

/// What a curve in which the surfaces cross says of A's surface inside of B, by Stokes' theorem:
/// S = 1/2 loop integral of x cross dl. In B's frame.
struct CurveFlux {
  Vec3 area_vector = Vec3::Zero();  ///< S, right when the curve is closed
  bool closed = false;
  double length = 0.0;
  Vec3 toward_a = Vec3::Zero();  ///< unit vector from B to A: -S/|S|, or from the normals of the
                                 ///< faces where that is not closed or vanishes; zero at a loss
};

/// A part of the curve in which the surfaces of A and B cross: where a region of the overlap is.
struct ContactPatch {
  CurveFlux flux;
  Vec3 low, high;   ///< bounds of the curve in B's frame [m]
  int first, last;  ///< its contacts, in PatchScratch::order
  bool one_curve;   ///< certainly
};

/// Memory of the search for patches.
struct PatchScratch {
  std::vector<std::uint64_t> keys;  ///< hash table of the ends of segments
  std::vector<int> contact_at;
  std::vector<int> parent;
  std::vector<int> order;     ///< contacts, patch by patch
  std::vector<int> number;    ///< of each root
  std::vector<int> starts;    ///< of each patch in `order`
  std::vector<char> several;  ///< of each root: whether patches were joined to it
  std::vector<ContactPatch> patches;
};

/// Joins contacts whose segments meet to patches, and patches whose bounds come nearer than their
/// smaller width. False when there are too many for that to be quick, as where surfaces coincide.
bool find_patches(const std::vector<TriangleContact>& contacts, PatchScratch& scratch);

/// Bounds in a frame C of the curve of a patch.
Aabb bounds_of(const std::vector<TriangleContact>& contacts, const PatchScratch& scratch,
               const ContactPatch& patch, const Pose& X_CB);

/// Axes of the columns through a patch, in B's frame: z towards A, x along the patch, so that a
/// window around it is no wider than it must be.
Mat3 columns_along(const std::vector<TriangleContact>& contacts, const PatchScratch& scratch,
                   const ContactPatch& patch);

CurveFlux flux_of(const std::vector<TriangleContact>& contacts, const int* first, const int* last);

}  // namespace volcontact
