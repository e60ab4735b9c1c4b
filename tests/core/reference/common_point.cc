// SPDX-License-Identifier: Apache-2.0
#include "core/reference/common_point.h"

#include <cmath>

namespace volcontact::test {
namespace {

// The ellipsoid method: every cut through the middle keeps all of the common part, and leaves
// e^(-1/8) of the volume or less. The point is at least `margin` behind every face.
bool find_point_behind_faces(const ReferenceSolid& a, const ReferenceSolid& b, double range,
                             double margin, Vec3& x) {
  constexpr int kCuts = 300;
  x = Vec3::Zero();
  Mat3 shape = 3.0 * range * range * Mat3::Identity();
  for (int i = 0; i < kCuts; ++i) {
    double worst = -margin;
    Vec3 g = Vec3::Zero();
    a.cut_at(x, worst, g);
    b.cut_at(x, worst, g);
    if (worst == -margin) return true;
    const Vec3 way = shape * g / std::sqrt(g.dot(shape * g));
    if (!way.allFinite()) return false;
    x -= 0.25 * way;
    shape = 9.0 / 8.0 * (shape - 0.5 * outer(way, way));
  }
  return false;
}

// The middles of chords lead away from the faces. False where the first chord is none.
bool move_from_faces(const ReferenceSolid& a, const ReferenceSolid& b, Vec3& x) {
  constexpr int kRounds = 4;
  for (int round = 0; round < kRounds; ++round) {
    for (int axis = 0; axis < 3; ++axis) {
      // Of a frame with its z axis along the axis.
      const Mat3 r = Mat3::with_columns(Vec3::Unit((axis + 1) % 3), Vec3::Unit((axis + 2) % 3),
                                        Vec3::Unit(axis));
      const Pose X_LW{r.transpose(), -(r.transpose() * x)};
      const ReferenceSpans spans =
          both(a.posed(X_LW).column(0.0, 0.0), b.posed(X_LW).column(0.0, 0.0));
      if (spans.size() == 0) return round > 0 || axis > 0;
      const double middle = 0.5 * (spans[0].enter + spans[0].leave);
      if (std::isfinite(middle)) x += middle * Vec3::Unit(axis);
    }
  }
  return true;
}

}  // namespace

// A point in a face belongs to both, and no chord goes through it: first one inside is looked for.
bool find_common_point(const ReferenceSolid& a, const ReferenceSolid& b, double range, Vec3& x) {
  constexpr double kInside = 1e-9;  // of the range
  if (a.has_torus() || b.has_torus()) return false;
  for (const double margin : {kInside * range, 0.0}) {
    if (find_point_behind_faces(a, b, range, margin, x) && move_from_faces(a, b, x)) return true;
  }
  return false;
}

}  // namespace volcontact::test
