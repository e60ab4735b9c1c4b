// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "volcontact/force/own_law.h"

/// Friction that sticks on springs: F = -k z, where the deflection z follows the way and is no
/// longer than mu f_n / k.
struct Springs final : volcontact::OwnFrictionLaw<Springs> {
  static constexpr const char* kName = "springs";
  struct Params {
    double friction = 0.3, shear_stiffness = 1e5;
  };
  /// The springs of two materials lie in series.
  static constexpr volcontact::MaterialRule kSeries{.combination = &volcontact::kInSeries};
  static constexpr std::array kFields{
      volcontact::Field<Params>{"friction", "-", &Params::friction, volcontact::kNonNegative, "mu"},
      volcontact::Field<Params>{"shear_stiffness", "N/m", &Params::shear_stiffness,
                                volcontact::kPositive, "k, of a contact site", &kSeries}};
  static constexpr std::array kStates{volcontact::StateField{
      "deflection", "m", volcontact::Keeping::kVector, "of the springs along the plane"}};

  explicit Springs(const Params& params) : p(volcontact::validated<Springs>(params)) {}

  volcontact::FrictionOutput evaluate(const volcontact::FrictionInput& in,
                                      const volcontact::LawState& state) const noexcept override {
    volcontact::Vec3 z(state.committed[0], state.committed[1], state.committed[2]);
    z += in.travel;
    const double most = p.friction * in.normal_force / p.shear_stiffness;
    const bool slides = z.norm() > most;
    if (slides) z *= most / z.norm();
    for (int i = 0; i < 3; ++i) state.pending[i] = z[i];
    volcontact::FrictionOutput out;
    out.force = -p.shear_stiffness * z;
    out.slide_energy = 0.5 * p.shear_stiffness * z.squaredNorm();
    out.slide_power = slides ? std::max(0.0, -out.force.dot(in.slip)) : 0.0;
    return out;
  }

  Params p;
};
