// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace volcontact {

/// An explicit step holds a spring up to h^2 k/m = 4, and keeps its energy where this is small:
/// `auto` makes implicit what lies above this bound.
inline constexpr double kStiffNumber = 0.05;

/// An explicit step holds a damper up to h c/m = 2, and reverses the motion from 1 on: `auto` makes
/// implicit what lies above this bound.
inline constexpr double kStiffDamper = 0.5;

/// Pairs whose patch, were it as large as the smaller solid, stays below this are always left to
/// the explicit force.
inline constexpr double kPossibleNumber = 0.5;

/// What a step holds of explicit forces, with room to spare: h^2 k/m of a spring, h c/m of a
/// damper.
struct ExplicitBounds {
  double spring, damper;
  /// Whether friction that is too stiff makes no pair implicit. Runge-Kutta goes on to be of fourth
  /// order where the slip reverses in an impact that it resolves, and may chatter at rest.
  bool friction_is_explicit;

  static constexpr ExplicitBounds of(bool is_rk4) {
    return is_rk4 ? ExplicitBounds{0.5, 1.4, true}
                  : ExplicitBounds{kStiffNumber, kStiffDamper, false};
  }
  /// Of the later stages of Runge-Kutta, for what the first of them held.
  static constexpr ExplicitBounds of_stage() { return {1.0, 2.0, true}; }
};

}  // namespace volcontact
