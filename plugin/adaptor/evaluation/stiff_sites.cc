// SPDX-License-Identifier: Apache-2.0
#include "adaptor/evaluation/stiff_sites.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "adaptor/mujoco/mjgeoms.h"
#include "adaptor/scene/pair_rates.h"
#include "volcontact/model/site_laws.h"

namespace volcontact::adaptor {
namespace {

// How much an impulse in a direction at a point changes the speed there of one body against the
// other, at the present pose [1/kg].
double mobility_along(const mjModel* m, mjData* d, const GeomPair& geoms, const Vec3& point,
                      const Vec3& direction, std::vector<double>& row) {
  const auto nv = static_cast<std::size_t>(m->nv);
  row.assign(2 * nv, 0.0);
  for (const int geom : {geoms.a, geoms.b}) {
    const double sign = geom == geoms.a ? 1.0 : -1.0;
    int body = m->geom_bodyid[geom];
    while (body > 0 && m->body_dofnum[body] == 0) body = m->body_parentid[body];
    if (body == 0) continue;
    const Vec3 offset = point - vec3_at(d->subtree_com, m->body_rootid[body]);
    int dof = m->body_dofadr[body] + m->body_dofnum[body] - 1;
    for (; dof >= 0; dof = m->dof_parentid[dof]) {
      const Vec3 angular = vec3_at(d->cdof, 2 * dof);
      const Vec3 way = vec3_at(d->cdof, 2 * dof + 1) + angular.cross(offset);
      row[static_cast<std::size_t>(dof)] += sign * direction.dot(way);
    }
  }
  mj_solveM(m, d, row.data() + nv, row.data(), 1);
  return std::inner_product(row.begin(), row.begin() + m->nv, row.begin() + m->nv, 0.0);
}

// The same in the direction of slip, or of friction before there is any.
double mobility_across(const mjModel* m, mjData* d, const GeomPair& geoms, const SiteReport& site,
                       std::vector<double>& row) {
  const Vec3 across = site.force_on_A - site.normal_force * site.normal;
  const Vec3& way = site.slip.isZero(0.0) ? across : site.slip;
  if (way.isZero(0.0)) return 0.0;
  return mobility_along(m, d, geoms, site.metrics.centroid, way.normalized(), row);
}

// Whether nothing moves at a site but by rounding: neither friction nor the change of the normal
// force over the step is more than noise beside that force. Solids that lie still have no ratio of
// friction and slip.
bool lies_still(const SiteReport& site, const SiteInputs& inputs, double h) {
  constexpr double kNoFriction = 1e-12, kNoChange = 1e-9;  // of the normal force
  const VolumeMetrics& metrics = site.metrics;
  const double force = site.normal_force;
  const double stiffness = inputs.normal_out.elastic / metrics.volume * metrics.area_vector.norm();
  const double damping = inputs.normal_out.rolling_damping * metrics.volume;
  if ((h * stiffness + damping) * std::abs(site.approach_speed) > kNoChange * force) return false;
  const double arm = std::sqrt(0.5 * metrics.inertia.trace() / metrics.volume);
  return (site.force_on_A - force * site.normal).norm() <= kNoFriction * force &&
         std::abs(site.torque_on_A.dot(site.normal)) <= kNoFriction * arm * force;
}

// Whether friction without memory would throw the bodies back in an explicit step, faster than they
// slide or spin now: h c > 2 m, with c the friction per slip. Once the slip is so small they would
// chatter for ever.
bool reverses_slip(const SiteReport& site, const InverseMass& inverse, double sliding, double h) {
  const double across = (site.force_on_A - site.normal_force * site.normal).norm();
  if (h * across * sliding > kEulerDamper * site.slip.norm()) return true;
  const double torque = std::abs(site.torque_on_A.dot(site.normal));
  return h * torque * inverse.about > kEulerDamper * std::abs(site.spin);
}

// Whether friction that follows the patch shakes the bodies in an explicit step, where it could
// stop them in it: what slides faster is slowed by what friction can hold, whatever holds it.
bool shakes(const PairContact& pair, ContactReport& report, std::size_t site,
            const InverseMass& inverse, double sliding, double h) {
  const SiteReport& at = report.sites[site];
  const double slip = at.slip.norm(), spin = std::abs(at.spin);
  if (slip == 0.0 && spin == 0.0 && at.bristle_energy.sum() == 0.0) return false;
  const FrictionSlope slope =
      SiteLaws(pair.model, report, site).friction_slope(at.normal_force, at.slip, at.spin);
  if (!(h * slope.strength * sliding > kEulerDamper * slip ||
        h * slope.strength * slope.lever * inverse.about > kEulerDamper * spin)) {
    return false;
  }
  return h * (h * slope.stiffness + 2.0 * slope.damping) * sliding > kEulerSpring;
}

}  // namespace

bool is_stiff(const mjModel* m, mjData* d, const PairContact& pair, ContactReport& report,
              std::size_t site, ExplicitBounds most, EvaluationScratch& scratch) {
  const double h = m->opt.timestep;
  const InverseMass inverse = inverse_mass(m, pair.geoms);
  const Friction* friction = pair.model.laws().friction.get();
  const bool may_rub = friction && !most.friction_is_explicit;
  const bool rubs = may_rub && !lies_still(report.sites[site], report.inputs[site], h);
  const auto throws_back = [&](double sliding) {
    if (friction->states().empty() && reverses_slip(report.sites[site], inverse, sliding, h)) {
      return true;
    }
    return pair.friction_follows_patch && shakes(pair, report, site, inverse, sliding, h);
  };
  // Bodies yield by turning, too.
  if (may_rub && shakes_at_rest(pair, h)) return true;
  if (rubs && throws_back(kBall * inverse.along)) return true;
  const VolumeMetrics& metrics = report.sites[site].metrics;
  const SiteInputs& inputs = report.inputs[site];
  const double spread = 0.5 * metrics.inertia.trace() / metrics.volume;
  const double mobility = inverse.along + spread * inverse.about;
  // Volume times k_v a: the damper, also where it is cut off because the bodies part.
  const double damper = h * inputs.normal_out.rolling_damping * metrics.volume;
  const double spring =
      h * h * inputs.normal_out.elastic / metrics.volume * metrics.area_vector.norm();
  if (damper * mobility > most.damper) return true;
  const bool possible = h * h * pair.largest_rate >= kPossibleNumber;
  if (possible && spring * mobility > most.spring) return true;
  // What hangs on joints may give way more easily than its masses say.
  if (!pair.is_jointed) return false;
  const SiteReport& at = report.sites[site];
  if (rubs && throws_back(mobility_across(m, d, pair.geoms, at, scratch.row))) return true;
  constexpr double kMuchMore = 1e3;
  const double number = std::max(damper * mobility / most.damper, spring * mobility / most.spring);
  if (number * kMuchMore < 1.0) return false;
  const double along = mobility_along(m, d, pair.geoms, metrics.centroid, at.normal, scratch.row);
  return damper * along > most.damper || spring * along > most.spring;
}

bool find_stiff_sites(const SceneContact& contact, const mjModel* m, mjData* d,
                      EvaluationScratch& scratch) {
  const bool all = contact.options().implicit == Implicit::kAlways;
  const auto most = ExplicitBounds::of(m->opt.integrator == mjINT_RK4);
  scratch.stiff.clear();
  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    const PairContact& pair = scratch.pair(k);
    ContactReport& report = scratch.reports[k];
    for (std::size_t i = 0; i < report.sites.size(); ++i) {
      scratch.stiff.push_back(all || is_stiff(m, d, pair, report, i, most, scratch) ? 1 : 0);
    }
  }
  return std::find(scratch.stiff.begin(), scratch.stiff.end(), 1) != scratch.stiff.end();
}

}  // namespace volcontact::adaptor
