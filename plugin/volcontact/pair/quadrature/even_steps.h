// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "volcontact/base/simd.h"
#include "volcontact/base/types.h"

namespace volcontact {

/// Eight equal steps of theta over half a turn: the rule for integrands that are even and periodic
/// in theta, such as what grows from nothing to nothing between angle = middle -+ half cos theta.
struct EvenSteps {
  static constexpr double kHalfSeen = 0.1;    ///< of the second wave: of odd ones that tell little
  static constexpr double kFallError = 10.0;  ///< error by the fall of waves, as measured
  static constexpr double kSymmetric = 1e-3;  ///< of the second wave: what the odd ones are then
  static constexpr double kUnsteadyFall = 3.0;  ///< by the fall from the wave before
  double cos[kLanes][kLanes], sin[kLanes];      ///< of multiples 0 to 7 of theta, and of theta

  EvenSteps() {
    for (int i = 0; i < kLanes; ++i) {
      const double theta = kPi * (i + 0.5) / kLanes;
      for (int k = 0; k < kLanes; ++k) cos[k][i] = std::cos(k * theta);
      sin[i] = std::sin(theta);
    }
  }

  /// Estimate of the error, from the values times their weights, whose sum goes to `total`: the
  /// error is the wave number 16, and no more than this foretells from those before. Of a symmetric
  /// integrand there are four values and three waves: where the last of these is larger than the
  /// fall of those before tells, it is small by chance and foretells nothing.
  double error(const double* terms, double& total) const {
    double waves[kLanes] = {};
    total = 0.0;
    for (int i = 0; i < kLanes; ++i) {
      total += terms[i];
      for (int k = 1; k < kLanes; ++k) waves[k] += 2.0 * terms[i] * cos[k][i];
    }
    const double last = std::abs(waves[5]) + std::abs(waves[6]) + std::abs(waves[7]);
    const double first = std::abs(waves[1]) + std::abs(waves[2]) + std::abs(waves[3]);
    const double odd =
        std::abs(waves[1]) + std::abs(waves[3]) + std::abs(waves[5]) + std::abs(waves[7]);
    if (odd < kSymmetric * std::abs(waves[2]) &&
        std::abs(waves[6] * waves[2]) > kUnsteadyFall * waves[4] * waves[4]) {
      return last;
    }
    return first > 0.0 ? last * std::min(1.0, kFallError * last / first) : last;
  }
  /// Whether the integrand is nearly symmetric about its middle and so has four values, not eight,
  /// and of their waves, which are the even ones, more than `share` of the sum is left at the end:
  /// a kink that they stepped over may be as large. Closed surfaces look closed whatever it is.
  bool may_hide_a_kink(const double* terms, double share) const {
    double waves[kLanes] = {};
    for (int i = 0; i < kLanes; ++i) {
      for (int k = 0; k < kLanes; ++k) waves[k] += (k == 0 ? 1.0 : 2.0) * terms[i] * cos[k][i];
    }
    const double odd =
        std::abs(waves[1]) + std::abs(waves[3]) + std::abs(waves[5]) + std::abs(waves[7]);
    return odd < kHalfSeen * std::abs(waves[2]) && std::abs(waves[6]) > share * waves[0];
  }
};

inline const EvenSteps& even_steps() {
  static const EvenSteps steps;
  return steps;
}

}  // namespace volcontact
