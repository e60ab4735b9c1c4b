// SPDX-License-Identifier: Apache-2.0
#include "volcontact/model/site_laws.h"

namespace volcontact {

SiteLaws::SiteLaws(const ContactModel& model, ContactReport& report, std::size_t site) noexcept
    : laws_(model.laws()), site_(report.sites[site]), inputs_(report.inputs[site]) {
  if (model.row_size() == 0) return;
  const std::size_t states = static_cast<std::size_t>(model.state_size());
  const std::size_t row = static_cast<std::size_t>(model.row_size());
  normal_state_ = {&report.committed[site * states], &report.memory[site * row + kSiteHead],
                   report.elapsed};
  const int own = laws_.normal->state_size();
  friction_state_ = {normal_state_.committed + own, normal_state_.pending + own, report.elapsed};
}

NormalSlope SiteLaws::normal_slope() const noexcept {
  return laws_.normal->slope(inputs_.normal_in, normal_state_);
}

FrictionOutput SiteLaws::friction(double normal_force, const Vec3& slip,
                                  double spin) const noexcept {
  return laws_.friction->evaluate(friction_input(site_, inputs_, normal_force, slip, spin),
                                  friction_state_);
}

void SiteLaws::hold_under(double normal_force) const noexcept {
  if (!has_friction()) return;
  const FrictionOutput held = friction(normal_force, site_.slip, site_.spin);
  site_.bristle_energy.slide = held.slide_energy;
  site_.bristle_energy.spin = held.spin_energy;
  site_.elastic_energy = inputs_.normal_out.elastic_energy + site_.bristle_energy.sum();
}

FrictionSlope SiteLaws::friction_slope(double normal_force, const Vec3& slip,
                                       double spin) const noexcept {
  return laws_.friction->slope(friction_input(site_, inputs_, normal_force, slip, spin),
                               friction_state_);
}

SiteTangent SiteLaws::tangent() const noexcept {
  const double rolling = laws_.rolling ? inputs_.normal_out.rolling_damping : 0.0;
  const FrictionSlope friction =
      has_friction() ? friction_slope(site_.normal_force, site_.slip, site_.spin) : FrictionSlope{};
  return site_tangent(site_.metrics, basis_with_z(site_.normal), normal_slope(), rolling, friction);
}

}  // namespace volcontact
