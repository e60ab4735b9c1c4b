// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/model/contact_report.h"

namespace volcontact::adaptor {

/// The sums of a report whose sites have changed.
inline void total_up(ContactReport& report) noexcept {
  report.elastic_energy = 0.0;
  report.bristle_energy = {};
  report.power = {};
  report.taken = {};
  for (const SiteReport& site : report.sites) {
    report.elastic_energy += site.elastic_energy;
    report.bristle_energy += site.bristle_energy;
    report.power += site.power;
    report.taken += site.taken;
  }
}

/// A share of all that acts at the sites.
inline void take_share(double share, ContactReport& report) noexcept {
  for (SiteReport& site : report.sites) {
    site.normal_force *= share;
    site.force_on_A *= share;
    site.torque_on_A *= share;
    for (ByChannel* power : {&site.power, &site.taken}) {
      for (double* x : {&power->normal, &power->roll, &power->slide, &power->spin}) *x *= share;
    }
  }
  total_up(report);
}

}  // namespace volcontact::adaptor
