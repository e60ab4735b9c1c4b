// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/pair/sections/section.h"
#include "volcontact/pair/window/convex_window.h"

namespace volcontact {

/// Half-planes may all miss a small cap that stands out through a round face, and on both sides
/// alike: neither the columns nor the check of the surface know of that face then. Returns about
/// the volume of the largest two such caps [m^3]: where the other solid is farthest out of a face
/// that no column ends at. Adds the ways there, in the frame of the sections, to `directions` if
/// there are such. `reach` is how far from the origins places lie [m].
double unseen_caps(const ConvexView& a, const ConvexView& b, const Pose& X_AB, const FaceSet& faces,
                   const Sections& sections, const SectionFrame& frame, double reach,
                   std::vector<Vec2>* directions);

}  // namespace volcontact
