// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adaptor/memory/userdata_layout.h"

namespace volcontact::adaptor {

/// What is left where contact and user cancel to the last bit, as in equilibrium. A zero there
/// could not be told from one that the user assigns; this number nobody does, and it moves nothing
/// [N].
inline constexpr double kCancelled = 1e-200;

/// Adds `forces` to an array that the user writes as well and that MuJoCo never clears
/// (qfrc_applied, xfrc_applied), without losing or accumulating anything.
///
/// Per entry the ledger keeps `base`, what the user wants there, and `left`, what we left there. An
/// entry that is no longer what we left was assigned by the user: that is the new base. Then the
/// entry becomes base + force. docs/plugin.md, "Applied forces".
inline void apply_beside_user(const UserdataBlock& block, int count, const double* forces,
                              double* array) noexcept {
  double* base = block.base();
  double* left = block.left();
  const bool known = block.ledger_is_valid();
  for (int i = 0; i < count; ++i) {
    if (!known || array[i] != left[i]) base[i] = array[i];
    const double sum = base[i] + forces[i];
    array[i] = left[i] = sum == 0.0 && forces[i] != 0.0 ? kCancelled : sum;
  }
  block.set_ledger_valid();
}

/// What the user wants in entry i of the array, before our force of this evaluation is added.
inline double user_share(const UserdataBlock& block, int i, const double* array) noexcept {
  return block.ledger_is_valid() && array[i] == block.left()[i] ? block.base()[i] : array[i];
}

/// Takes our part out of the array again and forgets it: what remains is the user's.
inline void release_to_user(const UserdataBlock& block, int count, double* array) noexcept {
  if (!block.is_ours() || !block.ledger_is_valid()) return;
  for (int i = 0; i < count; ++i) {
    if (array[i] == block.left()[i]) array[i] = block.base()[i];
    block.left()[i] = array[i];
    block.base()[i] = array[i];
  }
}

}  // namespace volcontact::adaptor
