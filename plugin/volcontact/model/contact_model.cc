// SPDX-License-Identifier: Apache-2.0
#include "volcontact/model/contact_model.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "volcontact/base/check.h"
#include "volcontact/force/rolling.h"

namespace volcontact {
namespace {

LawState slice(const LawState& state, int offset) {
  if (!state.pending) return state;
  return {state.committed + offset, state.pending + offset, state.elapsed};
}

std::vector<StateField> states_of(const ContactLaws& laws) {
  std::vector<StateField> states(laws.normal->states().begin(), laws.normal->states().end());
  if (laws.friction) {
    const auto more = laws.friction->states();
    states.insert(states.end(), more.begin(), more.end());
  }
  return states;
}

// The relative motion of A against B at the centroid, split along and across the normal.
void split_motion(const BodyMotion& motion, SiteReport& site) {
  const Vec3& c = site.metrics.centroid;
  const Vec3 velocity =
      motion.V_WA.at(c - motion.X_WA.translation) - motion.V_WB.at(c - motion.X_WB.translation);
  site.approach_speed = -velocity.dot(site.normal);
  site.slip = velocity + site.approach_speed * site.normal;
}

Patch patch_of(const VolumeMetrics& metrics, const Vec3& normal) {
  const double polar = std::max(0.0, normal.dot(metrics.inertia * normal));
  return {std::sqrt(polar / metrics.volume), metrics.volume, metrics.area_vector.norm(),
          metrics.second_moment()};
}

void add_friction(const ContactLaws& laws, const CarriedSite& carried, const LawState& state,
                  SiteReport& site) {
  const Vec3& n = site.normal;
  const FrictionOutput friction = laws.friction->evaluate(
      {site.normal_force, n, site.slip, site.spin, carried.travel - carried.travel.dot(n) * n,
       carried.rotation.dot(n), patch_of(site.metrics, n)},
      state);
  site.force_on_A += friction.force;
  site.torque_on_A += friction.torque * n;
  site.bristle_energy.slide = friction.slide_energy;
  site.bristle_energy.spin = friction.spin_energy;
  site.elastic_energy += site.bristle_energy.sum();
  site.power.slide = friction.slide_power;
  site.power.spin = friction.spin_power;
  site.taken.slide = -friction.force.dot(site.slip);
  site.taken.spin = -friction.torque * site.spin;
}

void add_site(SiteReport&& site, int pair, const BodyMotion& motion, ContactReport& report) {
  site.pair = pair;
  const Wrench on_A{site.torque_on_A, site.force_on_A};
  const Wrench on_B{-site.torque_on_A, -site.force_on_A};
  report.wrench_on_A += on_A.about(motion.X_WA.translation - site.metrics.centroid);
  report.wrench_on_B += on_B.about(motion.X_WB.translation - site.metrics.centroid);
  report.elastic_energy += site.elastic_energy;
  report.bristle_energy += site.bristle_energy;
  report.power += site.power;
  report.taken += site.taken;
  report.sites.push_back(site);
}

}  // namespace

SiteReport evaluate_site(const VolumeMetrics& metrics_W, const BodyMotion& motion,
                         const ContactLaws& laws, const CarriedSite& carried,
                         const LawState& state) noexcept {
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

  if (laws.rolling) {
    const Vec3 rolling = rotation - site.spin * site.normal;
    site.torque_on_A = rolling_torque({normal.rolling_damping, normal.magnitude, metrics_W.volume,
                                       site.normal, metrics_W.second_moment(), rolling});
    site.power.roll = -site.torque_on_A.dot(rolling);
  }
  site.power.normal = (normal.magnitude - normal.elastic) * site.approach_speed;
  site.taken = site.power;
  if (laws.friction) add_friction(laws, carried, slice(state, laws.normal->state_size()), site);
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
  states_ = states_of(laws_);
  row_size_ = states_.empty() ? 0 : kSiteHead + size_of(states_);
}

void ContactModel::evaluate(const BodyMotion& motion, const SiteMemory& memory,
                            Workspace& workspace, ContactReport& report) const noexcept {
  report.sites.clear();
  report.memory.clear();
  report.wrench_on_A = {};
  report.wrench_on_B = {};
  report.elastic_energy = 0.0;
  report.bristle_energy = {};
  report.power = {};
  report.taken = {};
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    interference_W(pairs_[i], motion.X_WA, motion.X_WB, options_, workspace.engines,
                   workspace.interference);
    const std::vector<VolumeMetrics>& sites_W = workspace.interference.sites;
    const int pair = static_cast<int>(i);
    if (row_size_ > 0) workspace.carrier.carry(memory, pair, sites_W, motion, states_);
    for (std::size_t k = 0; k < sites_W.size(); ++k) {
      CarriedSite carried;
      LawState state;
      if (row_size_ > 0) {
        carried = workspace.carrier.site(k);
        state = {workspace.carrier.states(k), new_row(pair, sites_W[k], motion, report),
                 memory.elapsed};
      }
      add_site(evaluate_site(sites_W[k], motion, laws_, carried, state), pair, motion, report);
    }
  }
}

// The states of a new row of the report, as they are carried over; its head is filled in.
double* ContactModel::new_row(int pair, const VolumeMetrics& metrics_W, const BodyMotion& motion,
                              ContactReport& report) const {
  const std::size_t start = report.memory.size();
  report.memory.resize(start + static_cast<std::size_t>(row_size_), 0.0);
  const SiteHead head = site_head(pair, metrics_W, motion);
  std::memcpy(&report.memory[start], &head, sizeof head);
  return &report.memory[start + kSiteHead];
}

}  // namespace volcontact
