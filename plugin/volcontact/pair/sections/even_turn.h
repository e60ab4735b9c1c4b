// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "volcontact/base/simd.h"
#include "volcontact/base/types.h"
#include "volcontact/pair/quadrature/outer_rule.h"

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

/// Integrates a set of sections that is round all about and has no corners, by equal steps of the
/// angle. False, and the sections cleared, when 32 of them are too few for the tolerance; `error`
/// is an estimate.
template <typename AnySections>
bool integrate_even_turn(AnySections& sections, SimdPath path, double tolerance, double& error) {
  for (const int batches : {2, 4}) {
    double u[kLanes], v[kLanes], weight[kLanes], section[kLanes], volume[2] = {0.0, 0.0};
    std::fill_n(weight, kLanes, 2.0 * kPi / (batches * kLanes));
    sections.clear();
    for (int k = 0; k < batches; ++k) {
      even_directions(batches * kLanes, k, u, v);
      sections.integrate(path, u, v, weight, section);
      sections.accept_batch();
      volume[k % 2] += sections.batch().moments[0];
    }
    error = even_error(volume[0], volume[1]);
    if (error <= outer_rule::kEvenTarget * tolerance * (volume[0] + volume[1])) return true;
  }
  sections.clear();
  error = 0.0;
  return false;
}

}  // namespace volcontact
