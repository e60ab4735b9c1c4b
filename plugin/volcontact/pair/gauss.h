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

}  // namespace volcontact
