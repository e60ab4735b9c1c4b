// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

namespace volcontact {

/// How the numbers of two materials become the one of a pair: docs/theory.md, "Materials".
struct Combination {
  const char* text;  ///< as descriptions begin: "in series: "
  /// Of the numbers of A and B, and the stiffnesses of the two, 1 where the law has none.
  double (*of)(double a, double b, double stiffness_a, double stiffness_b);
};

extern const Combination kLarger;
extern const Combination kInSeries;
extern const Combination kByCompliance;
/// A restitution: what damps it is weighted by compliance.
extern const Combination kRestitutionByCompliance;

/// What MuJoCo itself knows of a geom, for a material that gives no number.
enum class NativeValue : int { kNone, kSlidingFriction };

/// How a scene finds a law's parameter from the materials of two bodies: the part of a field table
/// that fields share under all laws. A field that names none has the rule of the first law of the
/// library with a field of its name, else the larger number of two holds.
struct MaterialRule {
  const Combination* combination = &kLarger;
  /// Of a material that does not give it; NaN: as in the law's `Params`.
  double usual = std::numeric_limits<double>::quiet_NaN();
  NativeValue native = NativeValue::kNone;  ///< in place of `usual`
  /// Field whose number this one has where a material gives none, and is never below.
  const char* at_least = nullptr;
  /// Field that this one replaces where it is given: of the two, the one not in force has its
  /// number in `Params`. Given by one material alone, it holds for both.
  const char* in_place_of = nullptr;
  bool is_stiffness = false;  ///< the one by which sides share the deformation
};

namespace rules {
inline constexpr MaterialRule kLargerOfTwo{};
inline constexpr MaterialRule kStiffness{.combination = &kInSeries, .is_stiffness = true};
/// 1 s/m: a resting contact settles within 1 / (g a).
inline constexpr MaterialRule kDamping{.combination = &kByCompliance, .usual = 1.0};
inline constexpr MaterialRule kRestitution{.combination = &kRestitutionByCompliance,
                                           .in_place_of = "damping"};
inline constexpr MaterialRule kFriction{.native = NativeValue::kSlidingFriction};
inline constexpr MaterialRule kStaticFriction{.native = NativeValue::kSlidingFriction,
                                              .at_least = "friction"};
}  // namespace rules

}  // namespace volcontact
