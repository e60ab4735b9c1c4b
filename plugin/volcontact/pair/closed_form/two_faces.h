// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <type_traits>

#include "volcontact/pair/closed_form/capsule_at_edge.h"
#include "volcontact/pair/closed_form/faces_met.h"
#include "volcontact/pair/closed_form/one_face.h"
#include "volcontact/pair/engine_interface.h"
#include "volcontact/shape/capsule.h"
#include "volcontact/shape/polytope/convex_polytope.h"
#include "volcontact/shape/sphere.h"

namespace volcontact {

/// A ball or a capsule that is cut by two faces of a box or polytope alone, which meet in an edge
/// within it: a fingertip on the edge of a block.
struct TwoFaces : EngineBase {
  static constexpr Engine kWord = Engine::kClosedForm;
  using Scratch = TypeList<>;
  static constexpr bool kSomePoses = true;

  template <typename A, typename B>
  static constexpr bool serves() {
    return (std::is_same_v<A, Sphere> || std::is_same_v<A, Capsule>) && OneFace::serves<A, B>();
  }
  template <typename A, typename B>
  static bool reaches(const A& a, const B& b) noexcept {
    return OneFace::reaches(a, b);
  }
  template <typename A, typename B>
  static Answer run(const Question<A, B>& q, Interference& out) {
    const Pose X_BA = q.X_AB.inverse();
    FacesMet<A> faces(q.a, X_BA);
    q.b.write_faces(faces);
    if (faces.is_apart() || faces.too_many()) return Answer::kBeyond;
    double half_length = 0.0;
    if constexpr (std::is_same_v<A, Capsule>) half_length = q.a.half_length();
    for (std::size_t i = 0; i < faces.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        const CapsuleAtEdge cut(q.a.radius(), half_length, faces[k], faces[i]);
        if (!cut.is_cut() || !is_alone(cut, faces, k, i)) continue;
        out.total = cut.metrics();
        if (!out.total.touching()) return Answer::kBeyond;
        if constexpr (std::is_same_v<B, ConvexPolytope>) {
          // Of a box no other face rises along the normal.
          Roof roof{cut, faces[k], faces[i], X_BA, out.total.normal()};
          q.b.write_faces(roof);
          if (!roof.is_whole) return Answer::kBeyond;
        }
        out.sites.assign(1, out.total);
        return Answer::kGiven;
      }
    }
    return Answer::kBeyond;
  }

 private:
  // Whether no other face cuts what the two leave.
  template <typename A>
  static bool is_alone(const CapsuleAtEdge& cut, const FacesMet<A>& faces, std::size_t first,
                       std::size_t second) {
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (i == first || i == second) continue;
      if (faces[i].height + cut.reach(faces[i].normal) > 0.0) return false;
    }
    return true;
  }

  // Whether columns along the normal n end in the two faces first, of all that B writes.
  struct Roof {
    const CapsuleAtEdge& cut;
    const FaceMet &first, &second;
    const Pose& X_BA;
    Vec3 n;
    bool is_whole = true;

    void plane(const Vec3& normal, double offset) {
      const FaceMet other = FaceMet::of(normal, offset, X_BA);
      if (other == first || other == second) return;
      is_whole = is_whole && cut.is_roof_behind(other, n);
    }
  };
};

}  // namespace volcontact
