// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "volcontact/force/friction.h"
#include "volcontact/force/normal_force.h"
#include "volcontact/model/contact_report.h"
#include "volcontact/model/site_memory.h"
#include "volcontact/pair/geometric_pair.h"
#include "volcontact/pair/pressure/pressure_field.h"

namespace volcontact {

/// What carries the normal force, with the same parameters. docs/theory.md, "From metrics to
/// wrench" and "The potential formulation".
enum class Formulation : int {
  kGonthier = 0,   ///< f = k V along the area vector, at the centroid of the volume
  kPotential = 1,  ///< wrench = -grad U, U = int min(p_A, p_B) dV: conservative for every pair
};
inline constexpr const char* kFormulationWords[] = {"gonthier", "potential"};

/// Throws std::invalid_argument naming the valid words and the nearest of them.
Formulation formulation_from(std::string_view word);

/// The laws of a contact and how it is integrated.
struct ContactLaws {
  std::shared_ptr<const NormalForce> normal;
  std::shared_ptr<const Friction> friction;  ///< null: frictionless
  bool rolling = true;                       ///< rolling resistance, where the normal law damps
  Formulation formulation = Formulation::kGonthier;
  /// Of `potential`: share of the compliance 1/k_v that is A's layer, from 0 (A rigid) to 1 [-].
  double share_of_a = 0.5;
  double mass = 0.0;  ///< reduced mass of the two bodies, 1 / (1/m_A + 1/m_B); 0: not known [kg]
};

/// What the friction law of a site is asked, under a normal force [N], at a slip [m/s] and a spin
/// [rad/s].
FrictionInput friction_input(const SiteReport& site, const SiteInputs& inputs, double normal_force,
                             const Vec3& slip, double spin) noexcept;

/// Forces of one contact site from its metrics (world frame), the motion of the bodies, and what
/// was carried over, into a `site` that is new; and the inputs of the laws. `state` has the numbers
/// of both. docs/theory.md, "From metrics to wrench". Under `potential`, `field_W` is the pressure
/// field of the site, in the world frame; else it is null.
void evaluate_site(const VolumeMetrics& metrics_W, const BodyMotion& motion,
                   const ContactLaws& laws, const CarriedSite& carried, const LawState& state,
                   const PressureField* field_W, SiteReport& site, SiteInputs& inputs) noexcept;

/// The contact model container of the CSA paper: geometric pairs x normal law x friction law.
/// Const once made; what lasts from one evaluation to the next is in rows that the caller keeps.
class ContactModel {
 public:
  /// Scratch memory; one per thread, reused from call to call.
  struct Workspace {
    InterferenceWorkspace engines;
    Interference interference;
    SiteCarrier carrier;
    PressureScratch pressure;
    std::vector<VolumeMetrics> sites_a;  ///< of a pair, in the frame of its solid on A
  };

  /// Throws std::invalid_argument without pairs or normal law, or when a forced engine does not
  /// serve a pair or a pair has no pressure field for `potential`.
  ContactModel(std::vector<GeometricPair> pairs, ContactLaws laws,
               InterferenceOptions options = {});

  const std::vector<GeometricPair>& pairs() const { return pairs_; }
  const ContactLaws& laws() const { return laws_; }
  const InterferenceOptions& options() const { return options_; }

  /// Numbers kept for each contact site; 0 when the laws keep nothing.
  int row_size() const { return row_size_; }

  /// Law states in a row.
  int state_size() const { return row_size_ > 0 ? row_size_ - kSiteHead : 0; }

  /// Evaluates all pairs. `memory` has the rows that an earlier evaluation left in its report; none
  /// for bodies that were apart. Allocates nothing when warm; throws
  /// std::bad_alloc where it has to and cannot, and nothing else.
  void evaluate(const BodyMotion& motion, const SiteMemory& memory, Workspace& workspace,
                ContactReport& report) const {
    evaluate(pairs_, motion, memory, workspace, report);
  }
  /// The same of other pairs by the laws and options of this model, which serve them.
  void evaluate(std::span<const GeometricPair> pairs, const BodyMotion& motion,
                const SiteMemory& memory, Workspace& workspace, ContactReport& report) const;

 private:
  double* new_row(int pair, const VolumeMetrics& metrics_W, const BodyMotion& motion,
                  ContactReport& report) const;
  PressureField field_of(const GeometricPair& pair, const BodyMotion& motion, std::size_t site,
                         Workspace& workspace) const;

  std::vector<GeometricPair> pairs_;
  ContactLaws laws_;
  InterferenceOptions options_;
  std::vector<StateField> states_;  // of the normal law, then of the friction law
  int row_size_;
};

}  // namespace volcontact
