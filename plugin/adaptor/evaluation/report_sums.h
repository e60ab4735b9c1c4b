// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/model/contact_model.h"
#include "volcontact/model/site_laws.h"

namespace volcontact::adaptor {

/// The sums of a report whose sites have changed.
inline void total_up(ContactReport& report) {
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

/// A share of all that acts at the sites of a report that keeps its inputs. Friction keeps what it
/// holds under what presses then.
inline void take_share(double share, const ContactModel& model, ContactReport& report) {
  for (std::size_t i = 0; i < report.sites.size(); ++i) {
    SiteReport& site = report.sites[i];
    site.normal_force *= share;
    SiteLaws(model, report, i).hold_under(site.normal_force);
    site.force_on_A *= share;
    site.torque_on_A *= share;
    for (ByChannel* power : {&site.power, &site.taken}) {
      for (double* x : {&power->normal, &power->roll, &power->slide, &power->spin}) *x *= share;
    }
  }
  total_up(report);
}

}  // namespace volcontact::adaptor
