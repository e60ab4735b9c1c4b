// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <type_traits>

#include "volcontact/pair/closed_form/closed_form.h"
#include "volcontact/pair/closed_form/faces_met.h"
#include "volcontact/shape/box.h"
#include "volcontact/shape/polytope/convex_polytope.h"

namespace volcontact {

/// A round solid that is cut by one face of a box or polytope alone: a ball on a table, a finger on
/// the face of a block.
struct OneFace : EngineBase {
  static constexpr Engine kWord = Engine::kClosedForm;
  using Scratch = TypeList<>;
  static constexpr bool kByFormula = true, kSomePoses = true;

  template <typename A, typename B>
  static constexpr bool serves() {
    return (std::is_same_v<B, Box> || std::is_same_v<B, ConvexPolytope>) &&
           (ClosedForm::serves<A, HalfSpace>() || ClosedForm::serves<HalfSpace, A>());
  }
  /// Of many small faces more than one are met as a rule.
  template <typename A, typename B>
  static bool reaches(const A&, const B& b) noexcept {
    constexpr std::size_t kMostFaces = 64;
    if constexpr (std::is_same_v<B, ConvexPolytope>) return b.faces().size() <= kMostFaces;
    return true;
  }
  template <typename A, typename B>
  static Answer run(const Question<A, B>& q, Interference& out) {
    out.total = VolumeMetrics{};
    out.sites.clear();
    const Pose X_BA = q.X_AB.inverse();
    FacesMet<A> faces(q.a, X_BA);
    q.b.write_faces(faces);
    if (faces.is_apart()) return Answer::kGiven;
    Pose X_AH;
    if (!faces.find(X_AH)) return Answer::kBeyond;
    const HalfSpace half_space;
    if constexpr (ClosedForm::serves<A, HalfSpace>()) {
      out.total = closed_form(q.a, half_space, X_AH);
    } else {
      const VolumeMetrics in_face = closed_form(half_space, q.a, X_AH.inverse());
      if (in_face.touching()) out.total = reversed(transformed(in_face, X_AH));
    }
    // What is within but for rounding has no normal in B, and no depth either.
    if (out.total.status == Status::kContained) return Answer::kBeyond;
    if (out.total.touching()) out.sites.push_back(out.total);
    return Answer::kGiven;
  }
};

}  // namespace volcontact
