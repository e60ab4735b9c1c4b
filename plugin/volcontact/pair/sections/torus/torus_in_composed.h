// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/sections/bore/composed_sections.h"
#include "volcontact/pair/sections/torus/torus_sections.h"

namespace volcontact {

/// Interference of a torus with a composed solid, of which `scratch.pieces[1]` are the pieces:
/// metrics in the frame of the torus. Regions that share a seam are one contact site. False when
/// the torus reaches a bore. docs/theory.md, "Tori".
bool torus_in_composed(const Torus& torus, const Pose& X_AB, const InterferenceOptions& options,
                       TorusSectionsScratch& ring, ComposedScratch& scratch, Interference& out);

}  // namespace volcontact
