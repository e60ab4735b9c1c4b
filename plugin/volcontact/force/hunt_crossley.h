// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>

#include "volcontact/base/fields.h"
#include "volcontact/force/normal_force.h"

namespace volcontact {

/// Volumetric spring with Hunt-Crossley damping: f = k V (1 + a v), never negative.
/// docs/theory.md, "Normal force"; Gonthier et al. Throws std::invalid_argument on values out of
/// range.
class HuntCrossley final : public NormalForce {
 public:
  static constexpr const char* kName = "hunt_crossley";
  struct Params {
    double stiffness = 1e7;
    double damping = 0.0;
  };
  static constexpr std::array kFields{
      Field<Params>{"stiffness", "N/m^3", &Params::stiffness, kPositive,
                    "k_v, force per interference volume"},
      Field<Params>{"damping", "s/m", &Params::damping, kNonNegative,
                    "a, relative rise of the force per approach speed"}};

  explicit HuntCrossley(const Params& params) : p_(validated<HuntCrossley>(params)) {}
  const Params& params() const { return p_; }
  const char* name() const noexcept override { return kName; }

  NormalOutput evaluate(const NormalInput& in, const LawState&) const noexcept override {
    const double elastic = p_.stiffness * in.volume;
    const double force = elastic * std::max(0.0, 1.0 + p_.damping * in.approach_speed);
    return {force, elastic, p_.stiffness * in.depth_moment, p_.stiffness * p_.damping};
  }

 private:
  Params p_;
};

}  // namespace volcontact
