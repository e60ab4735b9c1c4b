// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adaptor/geoms/pair_rules.h"
#include "volcontact/model/contact_model.h"

namespace volcontact::adaptor {

/// The contact model of one pair of geoms.
struct PairContact {
  GeomPair geoms;
  Engine engine;  ///< asked for, or the first that serves the pair at any pose
  ContactModel model;
  double stiffness = 0.0;  ///< PairLaws::stiffness [N/m^3]
  /// k/m of a patch as large as the smaller solid's box against a displacement [1/s^2].
  double largest_rate = 0.0;
  /// The same of friction with a memory against sliding, 0 without one [1/s^2].
  double friction_rate = 0.0;
  double friction_damping_rate = 0.0;   ///< and of its damping [1/s]
  bool friction_follows_patch = false;  ///< then both are 0, and each site has its own
  bool is_jointed = false;              ///< whether one of the bodies hangs on joints
  /// Geoms whose frames are body A and body B: those of `geoms`, but of flush solids.
  int frame_a = 0, frame_b = 0;
  PairId family = -1;  ///< FlushGroups::Family::number
};

}  // namespace volcontact::adaptor
