// SPDX-License-Identifier: Apache-2.0
#include "core/reference/line_lattice.h"

namespace volcontact::test {
namespace {

constexpr int kSets = 16;
constexpr double kStandardErrors = 5.0;

double fraction(double x) { return x - std::floor(x); }

// Of one direction.
double volume_along_z(const ReferenceSolid& a, const ReferenceSolid& b, double half_x,
                      double half_y, int lines, Random& random) {
  // Powers of 1 / 1.3247..., the root of x^3 = x + 1: the most even two-dimensional lattice.
  constexpr double kFirst = 0.7548776662466927, kSecond = 0.5698402909980532;
  const double x0 = random.uniform(), y0 = random.uniform();
  double sum = 0.0;
  for (int i = 0; i < lines; ++i) {
    const double u = half_x * (2.0 * fraction(x0 + i * kFirst) - 1.0);
    const double v = half_y * (2.0 * fraction(y0 + i * kSecond) - 1.0);
    const ReferenceSpans in_a = a.column(u, v);
    if (in_a.size() == 0) continue;
    const ReferenceSpans spans = both(in_a, b.column(u, v));
    for (int k = 0; k < spans.size(); ++k) sum += spans[k].leave - spans[k].enter;
  }
  return 4.0 * half_x * half_y * sum / lines;
}

}  // namespace

LatticeVolume lattice_volume(const ReferenceSolid& a, const ReferenceSolid& b, const Pose& X_AB,
                             const Aabb& box, int lines, Random& random) {
  double sum = 0.0, squares = 0.0;
  for (int set = 0; set < kSets; ++set) {
    const Mat3 r = random.rotation();
    const Pose X_FA{r, -(r * box.center())};
    ReferenceSolid a_F = a.posed(X_FA), b_F = b.posed(X_FA * X_AB);
    b_F.number_faces(a_F.number_faces(0));
    const Vec3 half = r.cwiseAbs() * box.half_sizes();
    const double volume = volume_along_z(a_F, b_F, half.x(), half.y(), lines, random);
    sum += volume;
    squares += volume * volume;
  }
  const double mean = sum / kSets;
  const double variance = std::max(0.0, squares / kSets - mean * mean) / (kSets - 1);
  return {mean, kStandardErrors * std::sqrt(variance)};
}

}  // namespace volcontact::test
