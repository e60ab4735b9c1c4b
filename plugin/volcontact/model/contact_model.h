// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "volcontact/force/friction.h"
#include "volcontact/force/normal_force.h"
#include "volcontact/model/contact_report.h"
#include "volcontact/pair/geometric_pair.h"

namespace volcontact {

/// How bodies stand and move: poses and twists of the two body frames in the world.
struct BodyMotion {
  Pose X_WA;
  Pose X_WB;
  Twist V_WA;
  Twist V_WB;
};

/// The laws of a contact and how it is integrated.
struct ContactLaws {
  std::shared_ptr<const NormalForce> normal;
  std::shared_ptr<const Friction> friction;  ///< null: frictionless
  bool rolling = true;                       ///< rolling resistance, where the normal law damps
};

/// Forces of one contact site from its metrics (world frame) and the motion of the bodies.
/// docs/theory.md, "From metrics to wrench".
SiteReport evaluate_site(const VolumeMetrics& metrics_W, const BodyMotion& motion,
                         const ContactLaws& laws, const LawState& state) noexcept;

/// The contact model container of the CSA paper: geometric pairs x normal law x friction law.
/// Const once made; state is owned by the caller, an array of state_size() doubles.
class ContactModel {
 public:
  /// Scratch memory; one per thread, reused from call to call.
  struct Workspace {
    InterferenceWorkspace engines;
    Interference interference;
  };

  /// Throws std::invalid_argument without pairs or normal law, or when a forced engine does not
  /// serve a pair.
  ContactModel(std::vector<GeometricPair> pairs, ContactLaws laws,
               InterferenceOptions options = {});

  const std::vector<GeometricPair>& pairs() const { return pairs_; }
  const ContactLaws& laws() const { return laws_; }
  const InterferenceOptions& options() const { return options_; }

  /// Doubles of state: for every pair, its site's normal law first, then its friction law.
  int state_size() const { return static_cast<int>(pairs_.size()) * site_state_size_; }

  /// Evaluates all pairs. `state` is as in LawState, with arrays of state_size(); a pair that is
  /// apart has its pending state zeroed. Throws nothing, allocates nothing when warm.
  void evaluate(const BodyMotion& motion, const LawState& state, Workspace& workspace,
                ContactReport& report) const noexcept;

 private:
  std::vector<GeometricPair> pairs_;
  ContactLaws laws_;
  InterferenceOptions options_;
  int site_state_size_;
};

}  // namespace volcontact
