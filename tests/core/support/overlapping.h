// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/support/evaluated.h"
#include "core/support/random.h"

namespace volcontact::test {

/// A random turn of B, and B moved towards A's origin along a random direction until the two
/// overlap by `depth` [m]. Farther away than 1.5 m they must be apart.
inline Pose overlapping(const Shape& a, const Shape& b, Random& random, double depth) {
  Pose X_AB = random.pose(1.0);
  const Vec3 direction = X_AB.translation.normalized();
  double together = 0.0, apart = 1.5;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (together + apart);
    X_AB.translation = middle * direction;
    (evaluated(a, b, X_AB).total.touching() ? together : apart) = middle;
  }
  X_AB.translation = (together - depth) * direction;
  return X_AB;
}

}  // namespace volcontact::test
