// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/overlap.h"
#include "volcontact/pair/torus_pair/torus_flux.h"
#include "volcontact/pair/torus_pair/torus_patch.h"
#include "volcontact/shape/torus.h"

namespace volcontact {

/// Memory of the engine for two rings.
struct TorusPairScratch {
  TorusPatchScratch patch[2];  ///< of A and B
  std::vector<int> region_of;  ///< by chain, those of B after those of A
  struct Region {
    int chain;    ///< the first one
    Vec3 origin;  ///< near its middle
    double weight;
    double reach;  ///< farthest place of its surface
    double depth;
    TorusFlux flux[2];
  };
  std::vector<Region> regions;
};

/// Interference of two rings from the surface of their overlap: metrics in A's frame; every
/// connected region is a site. False when the surface found is not closed well enough.
/// docs/theory.md, "Two tori".
///
///   V = 1/3 int x . n dS,   dS = r (R + r cos theta) dtheta dphi,
/// over the arcs in theta of each ring's section circles, at the angle phi, that lie in the other
bool torus_pair(const Torus& a, const Torus& b, const Pose& X_AB,
                const InterferenceOptions& options, TorusPairScratch& scratch, Interference& out);

}  // namespace volcontact
