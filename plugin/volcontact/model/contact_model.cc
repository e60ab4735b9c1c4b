// SPDX-License-Identifier: Apache-2.0
#include "volcontact/model/contact_model.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "volcontact/base/check.h"
#include "volcontact/base/fields.h"
#include "volcontact/force/rolling.h"

namespace volcontact {

Formulation formulation_from(std::string_view word) {
  const std::vector<std::string> words(std::begin(kFormulationWords), std::end(kFormulationWords));
  const auto found = std::find(words.begin(), words.end(), word);
  require(found != words.end(), unknown_word_message("formulation", word, words));
  return static_cast<Formulation>(found - words.begin());
}

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

// What pushes the bodies apart, per k_v: V along the area vector at the centroid, or the gradient
// of the potential there.
struct Push {
  double size = 0.0;           // [m^3]
  double energy = 0.0;         // [m^4]
  Vec3 couple = Vec3::Zero();  // about the centroid [m^4]
};

// Sets the normal of the site.
Push push_of(const PressureField* field_W, SiteReport& site) {
  const VolumeMetrics& metrics = site.metrics;
  if (!field_W) {
    site.normal = metrics.normal();
    return {metrics.volume, metrics.depth_moment, Vec3::Zero()};
  }
  const double size = field_W->force.norm();
  if (size > 0.0) site.normal = field_W->force / size;
  return {size, field_W->energy, field_W->couple};
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

void add_friction(const ContactLaws& laws, const SiteInputs& inputs, const LawState& state,
                  SiteReport& site) {
  const FrictionInput in = friction_input(site, inputs, site.normal_force, site.slip, site.spin);
  const FrictionOutput friction = laws.friction->evaluate(in, state);
  site.force_on_A += friction.force;
  site.torque_on_A += friction.torque * site.normal;
  site.bristle_energy.slide = friction.slide_energy;
  site.bristle_energy.spin = friction.spin_energy;
  site.elastic_energy += site.bristle_energy.sum();
  site.power.slide = friction.slide_power;
  site.power.spin = friction.spin_power;
  site.taken.slide = -friction.force.dot(site.slip);
  site.taken.spin = -friction.torque * site.spin;
}

void add_up(const SiteReport& site, ContactReport& report) {
  report.elastic_energy += site.elastic_energy;
  report.bristle_energy += site.bristle_energy;
  report.power += site.power;
  report.taken += site.taken;
}

}  // namespace

FrictionInput friction_input(const SiteReport& site, const SiteInputs& inputs, double normal_force,
                             const Vec3& slip, double spin) noexcept {
  const Vec3& n = site.normal;
  const double size = inputs.normal_in.volume;
  FrictionInput in;
  in.normal_force = normal_force;
  in.normal = n;
  in.slip = slip;
  in.spin = spin;
  in.travel = inputs.travel - inputs.travel.dot(n) * n;
  in.turn = inputs.rotation.dot(n);
  in.patch = inputs.patch;
  if (size > 0.0) in.normal_stiffness = inputs.normal_out.elastic / size * in.patch.area;
  in.mass = inputs.normal_in.mass;
  return in;
}

void evaluate_site(const VolumeMetrics& metrics_W, const BodyMotion& motion,
                   const ContactLaws& laws, const CarriedSite& carried, const LawState& state,
                   const PressureField* field_W, SiteReport& site, SiteInputs& inputs) noexcept {
  site.metrics = metrics_W;
  const Push push = push_of(field_W, site);
  // A contained body has no direction to be pushed in: reported, but without a force.
  if (site.normal.isZero(0.0)) return;
  split_motion(motion, site);
  const Vec3 rotation = motion.V_WA.angular - motion.V_WB.angular;
  site.spin = rotation.dot(site.normal);

  const NormalInput normal_in{push.size, push.energy, site.approach_speed, laws.mass};
  const NormalOutput normal = laws.normal->evaluate(normal_in, slice(state, 0));
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
  // The couple of a potential is elastic like the elastic part of the force.
  Vec3 elastic_torque = Vec3::Zero();
  if (push.size > 0.0) elastic_torque = normal.elastic / push.size * push.couple;
  if (push.size > 0.0) site.torque_on_A += elastic_torque;
  inputs.normal_in = normal_in;
  inputs.normal_out = normal;
  inputs.elastic_torque = elastic_torque;
  inputs.travel = carried.travel;
  inputs.rotation = carried.rotation;
  if (!laws.friction) return;
  inputs.patch = patch_of(metrics_W, site.normal);
  add_friction(laws, inputs, slice(state, laws.normal->state_size()), site);
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
    if (laws_.formulation != Formulation::kPotential) continue;
    const std::string reason = why_no_pressure_field(pair.a, pair.b, options_.engine);
    require(reason.empty(), std::string("formulation potential does not serve the pair ") +
                                name_of(pair.a) + " - " + name_of(pair.b) + ": " + reason +
                                "; or use gonthier");
  }
  require(laws_.share_of_a >= 0.0 && laws_.share_of_a <= 1.0,
          "contact_model: share_of_a = " + std::to_string(laws_.share_of_a) + " must be 0 to 1");
  require(laws_.mass >= 0.0 && laws_.mass - laws_.mass == 0.0,
          "contact_model: mass = " + std::to_string(laws_.mass) +
              " [kg] must be >= 0; 0 where it is not known");
  states_ = states_of(laws_);
  row_size_ = states_.empty() ? 0 : kSiteHead + size_of(states_);
}

void ContactModel::evaluate(std::span<const GeometricPair> pairs, const BodyMotion& motion,
                            const SiteMemory& memory, Workspace& workspace,
                            ContactReport& report) const try {
  report.sites.clear();
  report.memory.clear();
  report.p_WA = motion.X_WA.translation;
  report.p_WB = motion.X_WB.translation;
  report.elastic_energy = 0.0;
  report.bristle_energy = {};
  report.power = {};
  report.taken = {};
  report.inputs.clear();
  report.committed.clear();
  report.elapsed = memory.elapsed;
  SiteInputs unused;  // where the report keeps none
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    interference_W(pairs[i], motion.X_WA, motion.X_WB, options_, workspace.engines,
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
      PressureField field_W;
      const bool potential = laws_.formulation == Formulation::kPotential;
      if (potential) field_W = field_of(pairs[i], motion, k, workspace);
      if (report.keeps_inputs && row_size_ > 0) {
        report.committed.insert(report.committed.end(), state.committed,
                                state.committed + state_size());
      }
      SiteInputs& inputs = report.keeps_inputs ? report.inputs.emplace_back() : unused;
      SiteReport& site = report.sites.emplace_back();
      site.pair = pair;
      evaluate_site(sites_W[k], motion, laws_, carried, state, potential ? &field_W : nullptr, site,
                    inputs);
      if (field_W.error > options_.tolerance * field_W.force.norm()) {
        site.metrics.status = std::max(site.metrics.status, Status::kApproximate);
      }
      add_up(site, report);
    }
  }
} catch (...) {  // half done: nothing of it is to be found
  workspace.carrier = SiteCarrier();
  workspace.pressure = PressureScratch();
  report.sites.clear();
  report.memory.clear();
  throw;
}

PressureField ContactModel::field_of(const GeometricPair& pair, const BodyMotion& motion,
                                     std::size_t site, Workspace& workspace) const {
  const Pose X_Wa = motion.X_WA * pair.X_Aa, X_aW = X_Wa.inverse();
  std::vector<VolumeMetrics>& sites_a = workspace.sites_a;
  if (site == 0) {
    sites_a.clear();
    for (const VolumeMetrics& site_W : workspace.interference.sites) {
      sites_a.push_back(transformed(site_W, X_aW));
    }
  }
  const PressureField field =
      pressure_field(pair.a, pair.b, X_aW * (motion.X_WB * pair.X_Bb),
                     {sites_a, site, laws_.share_of_a, options_}, workspace.pressure);
  return {field.energy, X_Wa.rotation * field.force, X_Wa.rotation * field.couple, field.error};
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
