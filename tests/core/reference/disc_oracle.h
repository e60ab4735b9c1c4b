// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "volcontact/base/types.h"

namespace volcontact::test {

/// Integrals of a body of revolution, stacked of discs along its axis, in extended precision by a
/// Gauss rule that is exact for the polynomials of balls: an oracle that shares no formula with the
/// closed forms.
struct DiscSum {
  long double volume = 0, first = 0, axial = 0, lateral = 0;  ///< int 1, z, z^2, x^2 dV

  /// Adds the discs from z = `from` to `to` of a ball that reaches from `bottom` to `top`.
  void add_ball(long double bottom, long double top, long double from, long double to) {
    constexpr long double kNodes[] = {0.0L, 0.5384693101056830910363L, 0.9061798459386639927976L};
    constexpr long double kWeights[] = {0.5688888888888888888889L, 0.4786286704993664680413L,
                                        0.2369268850561890875143L};
    const long double pi = 3.14159265358979323846264338L, half = (to - from) / 2;
    for (int i = -2; i <= 2; ++i) {
      const int k = std::abs(i);
      const long double z = from + half * (1 + (i < 0 ? -kNodes[k] : kNodes[k]));
      const long double square = (z - bottom) * (top - z);
      const long double area = half * kWeights[k] * pi * square;
      volume += area;
      first += area * z;
      axial += area * z * z;
      lateral += area * square / 4;
    }
  }
  /// About the centroid.
  long double axial_second() const { return axial - first * first / volume; }
};

}  // namespace volcontact::test
