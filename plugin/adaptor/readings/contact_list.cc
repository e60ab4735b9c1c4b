// SPDX-License-Identifier: Apache-2.0
#include "adaptor/readings/contact_list.h"

#include <algorithm>

#include "adaptor/mujoco/mjgeoms.h"
#include "adaptor/mujoco/mujoco_compat.h"
#include "adaptor/readings/last_evaluation.h"

namespace volcontact::adaptor {
namespace {

SceneForce native_force(const mjModel* m, const mjData* d, int index) {
  const mjContact& contact = d->contact[index];
  SceneForce out;
  out.geom_a = contact.geom1;
  out.geom_b = contact.geom2;
  out.is_native = true;
  out.position = vec3_at(contact.pos, 0);
  // Its rows are the axes of the contact; the first is the normal, from geom 1 to geom 2.
  const Mat3 axes = Mat3::from_rows(contact.frame);
  double on_2[6] = {};
  mj_contactForce(m, d, index, on_2);
  out.normal = -axes.row(0);
  out.force = -(axes.transpose() * vec3_at(on_2, 0));
  out.torque = -(axes.transpose() * vec3_at(on_2, 1));
  out.normal_force = on_2[0];
  return out;
}

// What a site sensor's zone gets of a contact [N].
double in_zone(const mjModel* m, const mjData* d, int site, const SceneForce& force) {
  const int body = m->site_bodyid[site];
  const auto is_of = [&](int geom) { return geom >= 0 && m->geom_bodyid[geom] == body; };
  if (!is_of(force.geom_a) && !is_of(force.geom_b)) return 0.0;
  if (!(force.normal_force > 0.0)) return 0.0;
  const Vec3 outward = is_of(force.geom_b) ? force.normal : Vec3(-force.normal);
  const double distance =
      ray_to_zone(d->site_xpos + 3 * site, d->site_xmat + 9 * site, m->site_size + 3 * site,
                  force.position.data(), outward.data(), m->site_type[site]);
  return distance >= 0.0 ? force.normal_force : 0.0;
}

}  // namespace

void list_contacts(const SceneContact& contact, const mjModel* m, const mjData* d,
                   EvaluationScratch& scratch, std::vector<SceneForce>& out) {
  out.clear();
  if (revisit(contact, m, d, scratch)) {
    for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
      for (std::size_t i = 0; i < scratch.reports[k].sites.size(); ++i) {
        const SiteReport& site = scratch.reports[k].sites[i];
        const GeomPair& geoms = scratch.geoms_of_site(contact, k, i);
        const auto [a, b] = std::minmax(geoms.a, geoms.b);
        const double sign = a == geoms.a ? 1.0 : -1.0;  // of what is told of a
        out.push_back({a, b, false, site.metrics.centroid, sign * site.normal,
                       sign * site.force_on_A, sign * site.torque_on_A, site.normal_force});
      }
    }
  }
  for (int i = 0; i < d->ncon; ++i) {
    if (d->contact[i].efc_address >= 0) out.push_back(native_force(m, d, i));
  }
}

void update_touch_sensors(const SceneContact& contact, const mjModel* m, mjData* d,
                          EvaluationScratch& scratch) {
  std::vector<SceneForce> forces;
  list_contacts(contact, m, d, scratch, forces);
  for (int i = 0; i < m->nsensor; ++i) {
    if (m->sensor_type[i] != mjSENS_TOUCH) continue;
    double sum = 0.0;
    for (const SceneForce& force : forces) sum += in_zone(m, d, m->sensor_objid[i], force);
    const double cutoff = m->sensor_cutoff[i];
    d->sensordata[m->sensor_adr[i]] = cutoff > 0.0 ? std::min(sum, cutoff) : sum;
  }
}

}  // namespace volcontact::adaptor
