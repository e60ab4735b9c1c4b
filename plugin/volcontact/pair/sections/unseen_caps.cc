// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/unseen_caps.h"

#include <algorithm>

#include "volcontact/pair/quadrature/outer_rule.h"

namespace volcontact {
namespace {

constexpr double kLargestCap = 0.1;  // of V, as a cap that stands out unseen
constexpr int kClimbs = 4;           // to where a solid is farthest out of a face

bool within_others(const FaceSet& faces, const RoundFace& face, const Vec3& x, double slack) {
  return std::all_of(faces.planes.begin(), faces.planes.end(),
                     [&](const PlaneFace& p) { return p.normal.dot(x) <= p.offset + slack; }) &&
         std::all_of(faces.rounds.begin(), faces.rounds.end(), [&](const RoundFace& f) {
           return &f == &face || f.part != CapsulePart::kNone ||
                  f(x) <= 4.0 * slack * f.half_gradient(x).norm();
         });
}

}  // namespace

double unseen_caps(const ConvexView& a, const ConvexView& b, const Pose& X_AB, const FaceSet& faces,
                   const Sections& sections, const SectionFrame& frame, double reach,
                   std::vector<Vec2>* directions) {
  const double volume = sections.total().moments[0];
  double largest = 0.0;
  for (std::size_t i = 0; i < faces.rounds.size(); ++i) {
    const RoundFace& face = faces.rounds[i];
    if (face.part != CapsulePart::kNone || sections.total().rounds[i].area > 0.0) continue;
    const ConvexView& other = face.owner == Owner::kA ? b : a;
    const Pose X = face.owner == Owner::kA ? X_AB : Pose{};
    for (const Vec3& axis : {frame.u, frame.v, frame.t}) {
      for (const double side : {1.0, -1.0}) {
        Vec3 x = other.support(X, side * axis);
        for (int k = 0; k < kClimbs; ++k) x = other.support(X, face.half_gradient(x));
        const double slope = face.half_gradient(x).norm();
        const double out = slope > 0.0 ? 0.5 * face(x) / slope : 0.0;
        const double cap = kPi * out * out * reach;
        if (!(out > 0.0 && cap > outer_rule::kInnerError * volume)) continue;
        if (cap > kLargestCap * volume) continue;  // no columns miss that: it lies elsewhere
        if (!within_others(faces, face, x, out)) continue;
        largest = std::max(largest, 2.0 * cap);  // they come in pairs
        const Vec3 way = x - frame.center;
        const Vec2 direction(way.dot(frame.u), way.dot(frame.v));
        if (directions && direction.norm() > 0.0) directions->push_back(direction.normalized());
      }
    }
  }
  return largest;
}

}  // namespace volcontact
