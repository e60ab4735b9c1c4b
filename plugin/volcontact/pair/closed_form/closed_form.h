// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/closed_form/half_space_capsule.h"
#include "volcontact/pair/closed_form/half_space_ellipsoid.h"
#include "volcontact/pair/closed_form/half_space_frustum.h"
#include "volcontact/pair/closed_form/half_space_sphere.h"
#include "volcontact/pair/closed_form/half_space_torus.h"
#include "volcontact/pair/closed_form/sphere_sphere.h"
#include "volcontact/pair/engine_interface.h"

namespace volcontact {

/// The pairs for which there is a formula: closed_form(a, b, X_AB) is found by overload.
struct ClosedForm : EngineBase {
  static constexpr Engine kWord = Engine::kClosedForm;
  using Scratch = TypeList<>;
  static constexpr bool kByFormula = true, kOneSite = true;

  template <typename A, typename B>
  static constexpr bool serves() {
    return requires(const A& a, const B& b, const Pose& X_AB) { closed_form(a, b, X_AB); };
  }
  template <typename A, typename B>
  static Answer run(const Question<A, B>& q, Interference& out) {
    out.total = closed_form(q.a, q.b, q.X_AB);
    return Answer::kGiven;
  }
};

}  // namespace volcontact
