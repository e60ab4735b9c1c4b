// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/model/contact_model.h"
#include "volcontact/model/site_tangent.h"

namespace volcontact {

/// The laws of one site of a report that keeps its inputs, to be asked again. What they keep for
/// the next evaluation goes to the site's row of the report, so the last question counts.
class SiteLaws {
 public:
  SiteLaws(const ContactModel& model, ContactReport& report, std::size_t site) noexcept;

  NormalSlope normal_slope() const noexcept;

  /// Friction under the normal force `normal_force` [N] at a slip and a spin as asked.
  bool has_friction() const noexcept { return laws_.friction != nullptr; }
  /// Whether it depends on what was before, not on the motion of now alone.
  bool friction_keeps() const noexcept { return !laws_.friction->states().empty(); }
  FrictionOutput friction(double normal_force, const Vec3& slip, double spin) const noexcept;
  /// Friction keeps, and the report says it stores, what it holds under that normal force [N].
  void hold_under(double normal_force) const noexcept;
  FrictionSlope friction_slope(double normal_force, const Vec3& slip, double spin) const noexcept;

  /// Stiffness and damping of the site. docs/theory.md, "Stiffness of a site".
  SiteTangent tangent() const noexcept;

 private:
  const ContactLaws& laws_;
  SiteReport& site_;
  const SiteInputs& inputs_;
  LawState normal_state_;
  LawState friction_state_;
};

}  // namespace volcontact
