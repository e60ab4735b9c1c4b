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

/// Values at even directions round a whole turn, and what their waves tell of the error of their
/// sum: of `count` values that is the wave number `count`. Of a smooth function waves fall faster
/// than any power, so that far less than those before is left; where a kink was overlooked they
/// fall as powers, and as little again is left.
class EvenTurnValues {
 public:
  /// Of the eight directions even_directions(count, first).
  void set(int count, int first, const double* values) {
    for (int i = 0; i < kLanes; ++i) values_[first + count / kLanes * i] = values[i];
  }

  /// Errors of the sum of `count` values, in units of it.
  RuleError errors(int count) const {
    double x[kMostWaves] = {}, y[kMostWaves] = {}, sum = 0.0;
    const int waves = count / 2;
    for (int i = 0; i < count; ++i) {
      const double *cosine = table().cos[kEvenTurn / count * i],
                   *sine = table().sin[kEvenTurn / count * i];
      for (int k = 0; k < waves; ++k) {
        x[k] += values_[i] * cosine[k];
        y[k] += values_[i] * sine[k];
      }
      sum += values_[i];
    }
    if (!(sum > 0.0)) return {0.0, 0.0};
    const auto size = [&](int from, int to) {
      double total = 0.0;
      for (int k = from; k < to; ++k) total += 2.0 * std::sqrt(x[k] * x[k] + y[k] * y[k]);
      return total;
    };
    const double first = size(0, waves / 2), last = size(waves / 2, waves);
    const double fall = first > last ? last / first : 1.0;
    return {last * fall * std::sqrt(fall) / sum, kLeft * last * fall / sum};
  }

  static constexpr int kMostWaves = kEvenTurn / 2;
  /// Cosine and sine of each direction, times 1, 2, 3, ...
  struct Table {
    double cos[kEvenTurn][kMostWaves], sin[kEvenTurn][kMostWaves];
    Table() {
      for (int i = 0; i < kEvenTurn; ++i) {
        for (int k = 0; k < kMostWaves; ++k) {
          const double angle = 2.0 * kPi * ((k + 1) * i % kEvenTurn) / kEvenTurn;
          cos[i][k] = std::cos(angle);
          sin[i][k] = std::sin(angle);
        }
      }
    }
  };
  static const Table& table() {
    static const Table table;
    return table;
  }

 private:
  static constexpr double kLeft = 2.0;  // of waves that fall as the squares of their numbers: 0.6
  double values_[kEvenTurn];
};

/// Eight of `count` even directions, every (count / 8)th from number `first` on; count divides 32.
inline void even_directions(int count, int first, double* u, double* v) {
  const EvenTurnValues::Table& table = EvenTurnValues::table();
  for (int i = 0; i < kLanes; ++i) {
    const int at = (kEvenTurn / count * first + kEvenTurn / kLanes * i) % kEvenTurn;
    u[i] = table.cos[at][0];
    v[i] = table.sin[at][0];
  }
}

/// Integrates a set of sections that is round all about and has no corners, by equal steps of the
/// angle. False, and the sections cleared, when 32 of them are too few for the tolerance; `error`
/// is an estimate.
template <typename AnySections>
bool integrate_even_turn(AnySections& sections, SimdPath path, double tolerance, double& error) {
  EvenTurnValues values;
  for (const int batches : {2, 4}) {
    const int count = batches * kLanes;
    double u[kLanes], v[kLanes], weight[kLanes], section[kLanes], volume = 0.0;
    std::fill_n(weight, kLanes, 2.0 * kPi / count);
    sections.clear();
    for (int k = 0; k < batches; ++k) {
      even_directions(count, k, u, v);
      sections.integrate(path, u, v, weight, section);
      sections.accept_batch();
      volume += sections.batch().moments[0];
      values.set(count, k, section);
    }
    const RuleError errors = values.errors(count);
    error = errors.kinked * volume;
    if (errors.smooth <= outer_rule::kEvenTarget * tolerance) return true;
  }
  sections.clear();
  error = 0.0;
  return false;
}

}  // namespace volcontact
