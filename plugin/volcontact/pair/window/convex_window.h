// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/base/simd.h"
#include "volcontact/pair/convex/convex_view.h"

namespace volcontact {

/// Where two solids overlap.
struct LinesWindow {
  enum class Kind {
    kApart,    ///< they certainly share no volume
    kOverlap,  ///< they share volume around `center`
    kAInB,     ///< A is inside of B
    kBInA,     ///< B is inside of A
  };
  Kind kind = Kind::kApart;
  Vec3 center;    ///< a place well inside of the overlap, about its centroid [m]
  Mat3 spread;    ///< maps the unit ball to an ellipsoid about as long and wide as the overlap [m]
  double volume;  ///< a first estimate [m^3]
  Vec3 area_vector;    ///< a first estimate of S [m^2]
  double area;         ///< and of A's surface inside B and B's inside A together [m^2]
  bool strip = false;  ///< far longer than deep, along an edge or the wall of a cylinder or cone
};

/// normal . (x - c) <= gap, seen from a point c.
struct ChordPlane {
  double n[3], gap;
  int owner;
};

/// Faces of the pair in A's frame, as the window left them.
struct LinesFaces {
  FaceSet active;                ///< those that can bound the overlap
  std::vector<PlaneFace> idle;   ///< planes that the other solid does not reach
  std::vector<ChordPlane> seen;  ///< memory of the search
  std::vector<Vec3> near;        ///< memory of the search
};

/// Finds where A and B overlap, from support functions, which bound a convex solid in any
/// direction: a face plane that one solid does not reach is idle, a direction in which their bounds
/// do not meet proves them apart (the method of Gilbert, Johnson and Keerthi). From a common point,
/// chords of the overlap in 16 directions then give its place, size and shape; directions are taken
/// in the frame that the last chords made, until the overlap looks round from the inside.
/// A solid inside the other is reported as such, or with `look_inside` as an overlap like any
/// other. docs/theory.md, "Lines".
LinesWindow find_lines_window(const ConvexView& a, const ConvexView& b, const Pose& X_AB,
                              SimdPath path, bool look_inside, LinesFaces& faces);

}  // namespace volcontact
