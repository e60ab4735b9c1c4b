// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace volcontact {

/// What a law keeps from one step to the next, for one contact site: integrated states (a bristle's
/// deflection) and internal parameters (the speed at impact). The array belongs to the caller.
///
/// A law reads `committed`, the values at the last accepted time, and writes to `pending` the
/// values `elapsed` seconds later. It may be called any number of times for one step (Runge-Kutta
/// stages, finite differences): the caller commits when time has moved on. Both arrays have the
/// law's state_size(); a site that just began has all zeros in `committed`.
struct LawState {
  const double* committed = nullptr;
  double* pending = nullptr;
  double elapsed = 0.0;  ///< [s], >= 0
};

}  // namespace volcontact
