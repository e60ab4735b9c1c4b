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
inline constexpr int kNodes = 5;           ///< Gauss nodes on each piece of a section
using InnerRule = GaussRule<kNodes>;
}  // namespace fan_limits

}  // namespace volcontact
