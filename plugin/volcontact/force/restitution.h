// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace volcontact {

// The coefficient of restitution e of a free impact at the speed v_i, under the damping a with the
// number A = a v_i:  ln((1 + A) / (1 - e A)) = A (1 + e).  docs/theory.md, "Restitution".

/// e [-] of A >= 0 [-], to 1e-10.
inline double restitution_of(double damping_number) {
  const double A = damping_number;
  constexpr double kSlow = 1e-5;  // where the next term of the series is below rounding
  if (A < kSlow) return 1.0 - 2.0 / 3.0 * A;
  // With e A = 1 - exp(-c) the relation is c - (1 - exp(-c)) = A - ln(1 + A), whose left side rises
  // and is convex: Newton from above cannot fail.
  const double wanted = A - std::log1p(A);
  double c = wanted + std::sqrt(2.0 * wanted);
  for (int i = 0; i < 50; ++i) {
    const double gone = -std::expm1(-c);
    const double step = (c - gone - wanted) / gone;
    c -= step;
    if (!(step > 1e-15 * c)) break;
  }
  return -std::expm1(-c) / A;
}

/// A [-] of 0 < e <= 1 [-].
inline double damping_number_of(double restitution) {
  if (restitution >= 1.0) return 0.0;
  double low = 0.0, high = 1.0 / restitution;  // always e A < 1
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (restitution_of(middle) > restitution ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace volcontact
