// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace volcontact {

/// Cosine and sine of an angle, from a Taylor series: exact to rounding up to kSmallTurn [rad].
inline constexpr double kSmallTurn = 0.8;

struct SmallTurn {
  double cos, sin;

  SmallTurn(double the_cos, double the_sin) : cos(the_cos), sin(the_sin) {}
  static SmallTurn any(double x) { return {std::cos(x), std::sin(x)}; }
  explicit SmallTurn(double x) {
    const double y = x * x;
    cos = 1.0 -
          y * (1.0 / 2 -
               y * (1.0 / 24 -
                    y * (1.0 / 720 -
                         y * (1.0 / 40320 -
                              y * (1.0 / 3628800 -
                                   y * (1.0 / 479001600 -
                                        y * (1.0 / 87178291200 - y * (1.0 / 20922789888000))))))));
    sin = x * (1.0 - y * (1.0 / 6 -
                          y * (1.0 / 120 -
                               y * (1.0 / 5040 -
                                    y * (1.0 / 362880 - y * (1.0 / 39916800 -
                                                             y * (1.0 / 6227020800 -
                                                                  y * (1.0 / 1307674368000))))))));
  }
};

}  // namespace volcontact
