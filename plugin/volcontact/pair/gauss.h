// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace volcontact {

/// Gauss-Legendre rule on [0, 1]: exact for polynomials of degree 2 N - 1.
template <int N>
struct GaussRule;

template <>
struct GaussRule<5> {
  static constexpr double kNodes[] = {0.046910077030668004, 0.23076534494715845, 0.5,
                                      0.76923465505284155, 0.953089922969332};
  static constexpr double kWeights[] = {0.11846344252809454, 0.23931433524968323,
                                        0.28444444444444444, 0.23931433524968323,
                                        0.11846344252809454};
};

template <>
struct GaussRule<8> {
  static constexpr double kNodes[] = {
      0.019855071751231884, 0.10166676129318663, 0.23723379504183551, 0.4082826787521751,
      0.5917173212478249,   0.76276620495816449, 0.89833323870681337, 0.98014492824876812};
  static constexpr double kWeights[] = {
      0.05061426814518813, 0.11119051722668724, 0.15685332293894364, 0.18134189168918099,
      0.18134189168918099, 0.15685332293894364, 0.11119051722668724, 0.05061426814518813};
};

/// Estimate of the error of the rule with 8 nodes, from how fast the Legendre coefficients of the
/// integrand fall; `terms` are its values times the weights of the rule.
inline double legendre_error(const double* terms) {
  constexpr int kCount = 8;
  double c[kCount] = {};
  for (int i = 0; i < kCount; ++i) {
    const double x = 2.0 * GaussRule<kCount>::kNodes[i] - 1.0;
    double p = 1.0, p_next = x;
    for (int k = 0; k < kCount; ++k) {
      c[k] += (2 * k + 1) * terms[i] * p;
      const double p_new = ((2 * k + 3) * x * p_next - (k + 1) * p) / (k + 2);
      p = p_next;
      p_next = p_new;
    }
  }
  const double last = std::abs(c[6]) + std::abs(c[7]), before = std::abs(c[4]) + std::abs(c[5]);
  const double fall = before > 0.0 ? std::min(1.0, last / before) : 0.0;
  return last * fall * fall * fall;
}

}  // namespace volcontact
