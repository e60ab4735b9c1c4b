// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/base/types.h"

namespace volcontact {

/// The contact patch as a friction law sees it: what the volume metrics say of it.
struct Patch {
  double gyration_radius = 0.0;       ///< r_g = sqrt(J_nn / V), weighted by the pressure [m]
  double volume = 0.0;                ///< V [m^3]
  double area = 0.0;                  ///< |S|, projected along the normal [m^2]
  Mat3 second_moment = Mat3::Zero();  ///< int r r^T dV about the centroid [m^5]
};

}  // namespace volcontact
