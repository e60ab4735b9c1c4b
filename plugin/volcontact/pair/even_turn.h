// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "volcontact/base/simd.h"
#include "volcontact/base/types.h"

namespace volcontact {

/// Directions that divide a whole turn evenly.
inline constexpr int kEvenTurn = 32;

/// Eight of `count` even directions, every (count / 8)th from number `first` on; count divides 32.
inline void even_directions(int count, int first, double* u, double* v) {
  struct Table {
    double cos[kEvenTurn], sin[kEvenTurn];
    Table() {
      for (int i = 0; i < kEvenTurn; ++i) {
        cos[i] = std::cos(2.0 * kPi * i / kEvenTurn);
        sin[i] = std::sin(2.0 * kPi * i / kEvenTurn);
      }
    }
  };
  static const Table table;
  for (int i = 0; i < kLanes; ++i) {
    const int at = (kEvenTurn / count * first + kEvenTurn / kLanes * i) % kEvenTurn;
    u[i] = table.cos[at];
    v[i] = table.sin[at];
  }
}

}  // namespace volcontact
