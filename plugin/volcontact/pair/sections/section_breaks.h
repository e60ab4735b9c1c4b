// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/pair/sections/section.h"

namespace volcontact {

/// Where a half-plane that turns about the axis of a set of sections meets something new.
struct SectionBreaks {
  std::vector<Vec2> directions;  ///< (u, v) in the frame of the sections, unit length, any order
  bool complete;                 ///< false when there are too many faces to look for all
  std::vector<Vec3> places;      ///< corners and tops, from the center of the sections

  void clear();
};

/// Finds the directions in which the section of a half-plane with the overlap changes its make-up:
/// at corners, where three faces meet, and where the half-plane touches an edge from the side.
/// Between them the section is a smooth function of the direction. An edge between two round faces
/// of different solids is not searched for touches. Also notes the places of least and greatest
/// height on faces and on edges with a plane face.
void find_breaks(const FaceSet& faces, const SectionFrame& frame, double tolerance,
                 SectionBreaks& breaks);

/// Adds the places that lie farthest along the unit vector `n` or against it, of each round face
/// and of its edges with plane faces, to those which find_breaks found for the same sections.
void find_tops(const FaceSet& faces, const SectionFrame& frame, const Vec3& n, double tolerance,
               SectionBreaks& breaks);

}  // namespace volcontact
