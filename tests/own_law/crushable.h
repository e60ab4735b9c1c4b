// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/force/own_law.h"

/// A layer that gives back less than it took: f = k V (V / V_max)^loss while it springs back, where
/// the impact was faster than `yield_speed`.
struct Crushable final : volcontact::OwnNormalLaw<Crushable> {
  static constexpr const char* kName = "crushable";
  struct Params {
    double stiffness = 1e7, loss = 1.0, yield_speed = 0.0;
  };
  static constexpr std::array kFields{
      volcontact::Field<Params>{"stiffness", "N/m^3", &Params::stiffness, volcontact::kPositive,
                                "k_v, force per interference volume"},
      volcontact::Field<Params>{"loss", "-", &Params::loss, volcontact::kNonNegative,
                                "power of the share of the largest volume"},
      volcontact::Field<Params>{"yield_speed", "m/s", &Params::yield_speed,
                                volcontact::kNonNegative, "slower impacts lose nothing"}};
  static constexpr std::array kStates{
      volcontact::StateField{"largest_volume", "m^3", volcontact::Keeping::kAmount, "V_max so far"},
      volcontact::StateField{"impact_speed", "m/s", volcontact::Keeping::kValue,
                             "at first touch, then left alone"}};

  explicit Crushable(const Params& params) : p(volcontact::validated<Crushable>(params)) {}

  volcontact::NormalOutput evaluate(const volcontact::NormalInput& in,
                                    const volcontact::LawState& state) const noexcept override {
    const bool is_new = state.committed[0] == 0.0;
    const double largest = state.pending[0] = std::max(state.committed[0], in.volume);
    const double impact = state.pending[1] = is_new ? in.approach_speed : state.committed[1];
    const double elastic = p.stiffness * in.volume;
    const double share = impact > p.yield_speed ? std::pow(in.volume / largest, p.loss) : 1.0;
    return {elastic * share, elastic, p.stiffness * in.depth_moment, 0.0};
  }

  Params p;
};
