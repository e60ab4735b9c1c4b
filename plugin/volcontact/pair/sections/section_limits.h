// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/quadrature/gauss.h"

namespace volcontact {

/// Of the sections in "section_slices.inc".
namespace section_limits {
inline constexpr double kFar = 1e30;  ///< stands for "no bound"
inline constexpr double kOnFace =
    1e-9;  ///< a crossing this close to the envelope counts, per height
inline constexpr double kOneRoot = 1e-12;   ///< of a square: less is rounding
inline constexpr int kKnotParts = 3;        ///< of a section, each with one knot of two round faces
inline constexpr int kMoreKnotParts = 24;   ///< the same where a knot is known to be overlooked
inline constexpr int kDipSteps = 10;        ///< of the search for two knots between two places
inline constexpr double kDipBeside = 0.25;  ///< of a step, that a dip may lie beside where it looks
inline constexpr double kDipMargin = 0.5;   ///< of the bend, that a dip may go lower than it looks
inline constexpr double kNearMeeting = 0.25;     ///< of a lead: less at an end is a meeting there
inline constexpr double kNextToEnd = 1.0 / 256;  ///< of a part, to the place next to an end
inline constexpr int kApexKnots = 7;             ///< about the sharp bend of a cone near its apex
inline constexpr double kSharpBend = 0.25;       ///< length of a bend that is one, of a section
inline constexpr int kRootSteps = 8;             ///< at most; each of them squares the error
/// Relative error of V from which on a piece of a section has eight nodes.
inline constexpr double kFineTolerance = 3e-5;

/// Gauss rule on each piece of a section.
struct InnerRule {
  int count;
  const double *nodes, *weights;
};
inline InnerRule inner_rule(bool fine) {
  if (fine) return {8, GaussRule<8>::kNodes, GaussRule<8>::kWeights};
  return {5, GaussRule<5>::kNodes, GaussRule<5>::kWeights};
}
}  // namespace section_limits

}  // namespace volcontact
