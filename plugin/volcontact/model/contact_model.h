// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "volcontact/force/friction.h"
#include "volcontact/force/normal_force.h"
#include "volcontact/model/contact_report.h"
#include "volcontact/model/site_memory.h"
#include "volcontact/pair/geometric_pair.h"

namespace volcontact {

/// The laws of a contact and how it is integrated.
struct ContactLaws {
  std::shared_ptr<const NormalForce> normal;
  std::shared_ptr<const Friction> friction;  ///< null: frictionless
  bool rolling = true;                       ///< rolling resistance, where the normal law damps
};

/// Forces of one contact site from its metrics (world frame), the motion of the bodies, and what
/// was carried over. `state` has the numbers of both laws. docs/theory.md, "From metrics to
/// wrench".
SiteReport evaluate_site(const VolumeMetrics& metrics_W, const BodyMotion& motion,
                         const ContactLaws& laws, const CarriedSite& carried,
                         const LawState& state) noexcept;

/// The contact model container of the CSA paper: geometric pairs x normal law x friction law.
/// Const once made; what lasts from one evaluation to the next is in rows that the caller keeps.
class ContactModel {
 public:
  /// Scratch memory; one per thread, reused from call to call.
  struct Workspace {
    InterferenceWorkspace engines;
    Interference interference;
    SiteCarrier carrier;
  };

  /// Throws std::invalid_argument without pairs or normal law, or when a forced engine does not
  /// serve a pair.
  ContactModel(std::vector<GeometricPair> pairs, ContactLaws laws,
               InterferenceOptions options = {});

  const std::vector<GeometricPair>& pairs() const { return pairs_; }
  const ContactLaws& laws() const { return laws_; }
  const InterferenceOptions& options() const { return options_; }

  /// Numbers kept for each contact site; 0 when the laws keep nothing.
  int row_size() const { return row_size_; }

  /// Evaluates all pairs. `memory` has the rows that an earlier evaluation left in its report; none
  /// for bodies that were apart. Throws nothing, allocates nothing when warm.
  void evaluate(const BodyMotion& motion, const SiteMemory& memory, Workspace& workspace,
                ContactReport& report) const noexcept;

 private:
  double* new_row(int pair, const VolumeMetrics& metrics_W, const BodyMotion& motion,
                  ContactReport& report) const;

  std::vector<GeometricPair> pairs_;
  ContactLaws laws_;
  InterferenceOptions options_;
  std::vector<StateField> states_;  // of the normal law, then of the friction law
  int row_size_;
};

}  // namespace volcontact
