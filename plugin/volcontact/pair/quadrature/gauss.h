// SPDX-License-Identifier: Apache-2.0
#pragma once

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

}  // namespace volcontact
