// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "volcontact/base/simd.h"
#include "volcontact/pair/quadrature/gauss.h"

namespace volcontact {

/// How the half-planes of a set of sections are spread over its angle, and what error that leaves.
/// All errors are estimates, of V.
namespace outer_rule {
inline constexpr double kTarget = 5e-2;      ///< share of the tolerance asked: no more division
inline constexpr double kEvenTarget = 1e-2;  ///< the same of even steps, where a kink may be hidden
inline constexpr int kMaxDepth = 4;          ///< of divisions of an arc
inline constexpr double kCloserTarget = 1e-2;  ///< of the target, on a closer look
inline constexpr int kCloserDepth = 2;         ///< more of divisions then
/// Divisions then, whatever the error seems to be: the same nodes would agree by the same chance.
inline constexpr int kCloserLeast = 1;
/// Of the gap on a closer look, and of what V changed by since the first: error of V. Where two
/// silhouettes come near each other, the normals in the check converge far less fast than V.
inline constexpr double kGapShare = 0.1;
/// Of V: a surface as far from closed as this is an answer, to any tolerance, but an approximate
/// one.
inline constexpr double kLeastOpen = 1e-3;
inline constexpr double kInnerError = 3e-6;  ///< of the rule along a half-plane, per V; as measured
/// The same with five nodes, where a round face of one solid turns back a little beyond the
/// other's, as a tube does in a ball that is 6 % wider.
inline constexpr double kNearTurnError = 2.5e-5;
}  // namespace outer_rule

using OuterRule = GaussRule<kLanes>;

/// Legendre polynomials at the nodes of the rule with 8 nodes, times 2 k + 1.
struct LegendreTable {
  static constexpr int kCount = kLanes;
  double p[kCount][kCount];

  constexpr LegendreTable() : p{} {
    for (int i = 0; i < kCount; ++i) {
      const double x = 2.0 * OuterRule::kNodes[i] - 1.0;
      double now = 1.0, next = x;
      for (int k = 0; k < kCount; ++k) {
        p[i][k] = (2 * k + 1) * now;
        const double after = ((2 * k + 3) * x * next - (k + 1) * now) / (k + 2);
        now = next;
        next = after;
      }
    }
  }
};

/// Estimates of the error of a rule. Where the integrand is smooth the error falls on as the
/// coefficients do that the nodes tell; where a kink was overlooked it does not.
struct RuleError {
  double smooth, kinked;
};

/// From how fast the Legendre coefficients of the integrand fall; `terms` are its values times the
/// weights of the rule. Two coefficients next to each other are small together only by chance: the
/// fall is taken over all of them but the first.
inline RuleError legendre_errors(const double* terms) {
  static constexpr LegendreTable kTable;
  double c[LegendreTable::kCount] = {};
  for (int i = 0; i < LegendreTable::kCount; ++i) {
    for (int k = 0; k < LegendreTable::kCount; ++k) c[k] += terms[i] * kTable.p[i][k];
  }
  const double last = std::abs(c[6]) + std::abs(c[7]), first = std::abs(c[2]) + std::abs(c[3]);
  const double fall = first > 0.0 ? std::min(1.0, last / first) : 0.0;  // of two pairs
  // Where coefficients do not fall at all, all that follow may be as large; as measured.
  const double root = std::sqrt(fall);
  return {last * fall * root, last * root * (1.0 + 4.0 * fall)};
}
inline double legendre_error(const double* terms) { return legendre_errors(terms).smooth; }

/// The same of even steps over a whole smooth turn, from the sums of every second step each: twice
/// the steps square the error.
inline double even_error(double one, double other) {
  const double sum = one + other, relative = std::abs(one - other) / sum;
  return relative * std::sqrt(relative) * sum;
}

}  // namespace volcontact
