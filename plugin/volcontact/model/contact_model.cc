// SPDX-License-Identifier: Apache-2.0
#include "volcontact/model/contact_model.h"

#include <algorithm>
#include <utility>

#include "volcontact/base/check.h"
#include "volcontact/force/rolling.h"

namespace volcontact {
namespace {

int site_state_size(const ContactLaws& laws) {
  return laws.normal->state_size() + (laws.friction ? laws.friction->state_size() : 0);
}

LawState slice(const LawState& state, int offset) {
  if (!state.pending) return state;
  return {state.committed + offset, state.pending + offset, state.elapsed};
}

// The relative motion of A against B at the centroid, split along and across the normal.
void split_motion(const BodyMotion& motion, SiteReport& site) {
  const Vec3& c = site.metrics.centroid;
  const Vec3 velocity =
      motion.V_WA.at(c - motion.X_WA.translation) - motion.V_WB.at(c - motion.X_WB.translation);
  site.approach_speed = -velocity.dot(site.normal);
  site.slip = velocity + site.approach_speed * site.normal;
}

}  // namespace

SiteReport evaluate_site(const VolumeMetrics& metrics_W, const BodyMotion& motion,
                         const ContactLaws& laws, const LawState& state) noexcept {
  SiteReport site;
  site.metrics = metrics_W;
  site.normal = metrics_W.normal();
  // A contained body has no direction to be pushed in: reported, but without a force.
  if (site.normal.isZero(0.0)) return site;
  split_motion(motion, site);
  const Vec3 rotation = motion.V_WA.angular - motion.V_WB.angular;
  site.spin = rotation.dot(site.normal);

  const NormalOutput normal = laws.normal->evaluate(
      {metrics_W.volume, metrics_W.depth_moment, site.approach_speed}, slice(state, 0));
  site.normal_force = normal.magnitude;
  site.force_on_A = normal.magnitude * site.normal;
  site.elastic_energy = normal.elastic_energy;
  site.power.normal = (normal.magnitude - normal.elastic) * site.approach_speed;

  if (laws.rolling) {
    const Vec3 rolling = rotation - site.spin * site.normal;
    site.torque_on_A = rolling_torque({normal.rolling_damping, normal.magnitude, metrics_W.volume,
                                       site.normal, metrics_W.second_moment(), rolling});
    site.power.roll = -site.torque_on_A.dot(rolling);
  }
  if (laws.friction) {
    const double polar = std::max(0.0, site.normal.dot(metrics_W.inertia * site.normal));
    const FrictionOutput friction = laws.friction->evaluate(
        {normal.magnitude, site.normal, site.slip, site.spin, std::sqrt(polar / metrics_W.volume)},
        slice(state, laws.normal->state_size()));
    site.force_on_A += friction.force;
    site.torque_on_A += friction.torque * site.normal;
    site.elastic_energy += friction.elastic_energy;
    site.power.slide = friction.slide_power;
    site.power.spin = friction.spin_power;
  }
  return site;
}

ContactModel::ContactModel(std::vector<GeometricPair> pairs, ContactLaws laws,
                           InterferenceOptions options)
    : pairs_(std::move(pairs)), laws_(std::move(laws)), options_(options) {
  require(!pairs_.empty(), "contact_model: needs at least one geometric pair");
  require(laws_.normal != nullptr, "contact_model: needs a normal law");
  for (const GeometricPair& pair : pairs_) {
    require(serves(options_.engine, pair.a, pair.b),
            std::string("engine ") + to_string(options_.engine) + " does not serve the pair " +
                name_of(pair.a) + " - " + name_of(pair.b) + "; use auto or octree");
  }
  site_state_size_ = site_state_size(laws_);
}

void ContactModel::evaluate(const BodyMotion& motion, const LawState& state, Workspace& workspace,
                            ContactReport& report) const noexcept {
  report.sites.clear();
  report.wrench_on_A = {};
  report.wrench_on_B = {};
  report.elastic_energy = 0.0;
  report.power = {};
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const LawState site_state = slice(state, static_cast<int>(i) * site_state_size_);
    interference_W(pairs_[i], motion.X_WA, motion.X_WB, options_, workspace.engines,
                   workspace.interference);
    if (!workspace.interference.total.touching() && site_state.pending) {
      std::fill_n(site_state.pending, site_state_size_, 0.0);
    }
    for (const VolumeMetrics& metrics : workspace.interference.sites) {
      SiteReport site = evaluate_site(metrics, motion, laws_, site_state);
      site.pair = static_cast<int>(i);
      const Wrench on_A{site.torque_on_A, site.force_on_A};
      const Wrench on_B{-site.torque_on_A, -site.force_on_A};
      report.wrench_on_A += on_A.about(motion.X_WA.translation - metrics.centroid);
      report.wrench_on_B += on_B.about(motion.X_WB.translation - metrics.centroid);
      report.elastic_energy += site.elastic_energy;
      report.power += site.power;
      report.sites.push_back(site);
    }
  }
}

}  // namespace volcontact
