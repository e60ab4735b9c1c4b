// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace volcontact {

/// Seven points in a triangle, exact to degree 5: Radon, "Zur mechanischen Kubatur", Monatshefte
/// fuer Mathematik 52, 1948. The middle, and two times three points, each given by the share of
/// each of the other two corners and that of its own one. Beside it the middle and the outer three
/// alone, exact to degree 2.
namespace triangle_rule {

inline constexpr double kOuter = 0.10128650732345633, kOuterCorner = 1.0 - 3.0 * kOuter;
inline constexpr double kInner = 0.47014206410511505, kInnerCorner = 1.0 - 3.0 * kInner;
inline constexpr double kMiddleWeight = 0.225, kOuterWeight = 0.12593918054482717,
                        kInnerWeight = 0.13239415278850619;
inline constexpr double kOuterSquare =
    (1.0 - 2.0 * kOuter) * (1.0 - 2.0 * kOuter) + 2.0 * kOuter * kOuter;
inline constexpr double kRoughOuterWeight = (1.0 / 18.0) / (kOuterSquare / 3.0 - 1.0 / 9.0) / 3.0;
inline constexpr double kRoughMiddleWeight = 1.0 - 3.0 * kRoughOuterWeight;
/// The rule of degree 5 is better than that of degree 2 by what makes the latter good, nearly.
inline constexpr double kGain = 10.0;
/// The share of a parabola's area that its chord's middle stands for, where what is integrated
/// falls evenly to nought at the arc.
inline constexpr double kSliverShare = 0.4;

}  // namespace triangle_rule
}  // namespace volcontact
