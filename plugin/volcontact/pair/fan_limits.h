// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/gauss.h"

namespace volcontact {

/// Of the sections in "fan_slices.inc".
namespace fan_limits {
inline constexpr double kFar = 1e30;  ///< stands for "no bound"
inline constexpr double kOnFace =
    1e-9;  ///< a crossing this close to the envelope counts, per height
inline constexpr double kOneRoot = 1e-12;  ///< of a square: less is rounding
inline constexpr int kKnotParts = 3;       ///< of a section, each with one knot of two round faces
inline constexpr int kRootSteps = 8;       ///< at most; each of them squares the error
/// Relative error of V from which on a piece of a section has eight nodes.
inline constexpr double kFineTolerance = 1e-5;

/// Gauss rule on each piece of a section.
struct InnerRule {
  int count;
  const double *nodes, *weights;
};
inline InnerRule inner_rule(bool fine) {
  if (fine) return {8, GaussRule<8>::kNodes, GaussRule<8>::kWeights};
  return {5, GaussRule<5>::kNodes, GaussRule<5>::kWeights};
}
}  // namespace fan_limits

}  // namespace volcontact
