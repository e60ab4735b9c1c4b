// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "volcontact/base/fields.h"
#include "volcontact/force/material_rule.h"
#include "volcontact/force/normal_force.h"

namespace volcontact {

/// Winkler foundation without damping: f = k V, energy k int L^2/2 dA.
/// docs/theory.md, "Normal force". Throws std::invalid_argument on values out of range.
class VolumeSpring final : public NormalForce {
 public:
  static constexpr const char* kName = "volume_spring";
  struct Params {
    double stiffness = 1e7;
  };
  static constexpr std::array kFields{Field<Params>{"stiffness", "N/m^3", &Params::stiffness,
                                                    kPositive, "k_v, force per interference volume",
                                                    &rules::kStiffness}};

  explicit VolumeSpring(const Params& params) : p_(validated<VolumeSpring>(params)) {}
  const Params& params() const { return p_; }
  const char* name() const noexcept override { return kName; }

  NormalOutput evaluate(const NormalInput& in, const LawState&) const noexcept override {
    const double force = p_.stiffness * in.volume;
    return {force, force, p_.stiffness * in.depth_moment, 0.0};
  }
  NormalSlope slope(const NormalInput&, const LawState&) const noexcept override {
    return {p_.stiffness, 0.0};
  }

 private:
  Params p_;
};

}  // namespace volcontact
