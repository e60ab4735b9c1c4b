// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/pair/torus_pair/circle_arcs.h"

namespace volcontact {

/// The part of the surface of one ring that lies in another: arcs of section circles, each for a
/// share `weight` [rad] of the turn. Arcs with one `chain` are next to each other without a gap.
struct TorusPatch {
  struct Arc {
    double low, high;
    int chain;
  };
  struct Slice {
    double angle, weight;
    int first, last;  ///< of the arcs
  };
  std::vector<Slice> slices;
  std::vector<Arc> arcs;
  /// Chains that touch where the circles change what they have in common with the ring.
  struct Joint {
    int one, other;
  };
  std::vector<Joint> joints;
  int chains = 0;
  std::vector<double> nearest;  ///< angles where the two rings are in touch most deeply
  double error = 0.0;           ///< estimate for V of what the slices leave out
  double volume_scale = 0.0;
  bool apart = false;       ///< the two rings have nothing in common
  bool incomplete = false;  ///< a part of the surface was given up
};

/// Memory of the search for a patch.
struct TorusPatchScratch {
  struct Sample {
    double angle;
    int count;  ///< of arcs; kWhole for all of a circle
  };
  std::vector<double> hints;  ///< angles to look at besides
  std::vector<Sample> samples;
  std::vector<double> events;
  TorusPatch patch;
};

/// How hard to look.
struct PatchEffort {
  double target;  ///< error of V, relative
  bool fine;
  int least_steps;  ///< in a range of circles
};

/// The patch of the surface of `ring`, posed at X in the frame of `other`, within `other`. Its
/// slices stand at Gauss nodes between the angles where arcs begin, end, merge and part, which are
/// square roots for the integrand. docs/theory.md, "Two tori".
void find_patch(const TorusSize& ring, const Pose& X, const TorusSize& other, PatchEffort effort,
                TorusPatchScratch& scratch);

}  // namespace volcontact
