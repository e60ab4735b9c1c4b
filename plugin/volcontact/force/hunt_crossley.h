// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>

#include "volcontact/base/fields.h"
#include "volcontact/force/material_rule.h"
#include "volcontact/force/normal_force.h"
#include "volcontact/force/restitution.h"

namespace volcontact {

/// Volumetric spring with Hunt-Crossley damping: f = k V (1 + a v), never negative. The damping is
/// a constant, or such that a blow has the coefficient of restitution asked for: then a follows
/// from its speed, the largest at which the bodies approached since they last parted.
/// docs/theory.md, "Normal force" and "Restitution"; Gonthier et al. Throws std::invalid_argument
/// on values out of range and where both are given.
class HuntCrossley final : public NormalForce {
 public:
  static constexpr const char* kName = "hunt_crossley";
  struct Params {
    double stiffness = 1e7;
    double damping = 0.0;
    double restitution = 1.0;
    double restitution_speed_floor = 1e-2;
  };
  static constexpr Range kRestitution{0.0, 1.0, true, false, "> 0 and <= 1"};
  static constexpr std::array kFields{
      Field<Params>{"stiffness", "N/m^3", &Params::stiffness, kPositive,
                    "k_v, force per interference volume", &rules::kStiffness},
      Field<Params>{"damping", "s/m", &Params::damping, kNonNegative,
                    "a, relative rise of the force per approach speed", &rules::kDamping},
      Field<Params>{"restitution", "-", &Params::restitution, kRestitution,
                    "e, instead of damping: a then follows from the impact speed",
                    &rules::kRestitution},
      Field<Params>{"restitution_speed_floor", "m/s", &Params::restitution_speed_floor, kPositive,
                    "slower impacts are damped as if they had this speed", &rules::kLargerOfTwo}};
  static constexpr std::array kStates{
      StateField{"impact_speed", "m/s", Keeping::kValue,
                 "of the last impact, negative once the bodies part, 0 before the first"}};

  explicit HuntCrossley(const Params& params)
      : p_(validated<HuntCrossley>(params)), damping_number_(damping_number_of(p_.restitution)) {
    require(p_.damping == 0.0 || p_.restitution == 1.0,
            "hunt_crossley: damping and restitution exclude each other");
  }
  const Params& params() const { return p_; }
  const char* name() const noexcept override { return kName; }
  std::span<const StateField> states() const noexcept override {
    return latches() ? std::span<const StateField>(kStates) : std::span<const StateField>();
  }

  NormalOutput evaluate(const NormalInput& in, const LawState& state) const noexcept override {
    const double damping = latches() ? latched_damping(in, state) : p_.damping;
    const double elastic = p_.stiffness * in.volume;
    const double force = elastic * std::max(0.0, 1.0 + damping * in.approach_speed);
    return {force, elastic, p_.stiffness * in.depth_moment, p_.stiffness * damping};
  }
  NormalSlope slope(const NormalInput& in, const LawState& state) const noexcept override {
    const double damping = latches() ? latched_damping(in, state) : p_.damping;
    const double raised = 1.0 + damping * in.approach_speed;
    if (!(raised > 0.0)) return {};  // comes away faster than the layer follows
    const bool is_bounded = latches() && parts_faster(in, std::abs(state.pending[0]));
    return {p_.stiffness * raised, is_bounded ? 0.0 : p_.stiffness * in.volume * damping};
  }

 private:
  bool latches() const { return damping_number_ > 0.0; }

  // Whether the bodies part faster than after a blow of this speed: something else drives them.
  bool parts_faster(const NormalInput& in, double blow) const {
    return -in.approach_speed > p_.restitution * blow;
  }

  double latched_damping(const NormalInput& in, const LawState& state) const {
    const double known = state.committed[0];
    if (in.approach_speed > 0.0) {  // a blow begins where the bodies had parted
      const double blow = std::max({known, in.approach_speed, p_.restitution_speed_floor});
      state.pending[0] = blow;
      return damping_number_ / blow;
    }
    const double blow = std::max(std::abs(known), p_.restitution_speed_floor);
    state.pending[0] = -blow;
    if (!parts_faster(in, blow)) return damping_number_ / blow;
    return damping_number_ * p_.restitution / -in.approach_speed;
  }

  Params p_;
  double damping_number_;  // a v_i that gives the restitution
};

}  // namespace volcontact
