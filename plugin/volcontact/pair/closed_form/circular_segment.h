// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace volcontact {

/// Integrals over the part u >= cosine of the unit disc, v across: a segment of half angle `angle`,
/// 0 to pi. Thin segments keep their relative accuracy in `area` and `depth`.
/// docs/theory.md, "Torus".
struct CircularSegment {
  double sine, cosine, angle;
  double area;
  double depth;     ///< int (u - cosine)
  double u;         ///< int u
  double uu, vv;    ///< int u^2, int v^2
  double uuu, uvv;  ///< int u^3, int u v^2

  /// `height` = 1 - cosine, and the sine of the half angle.
  CircularSegment(double height, double sine_of_angle)
      : sine(sine_of_angle), cosine(1.0 - height), angle(std::atan2(sine, cosine)) {
    constexpr double kThin = 0.12;
    const double square = sine * sine, cube = square * sine;
    u = (2.0 / 3.0) * cube;
    if (height < kThin) {
      // sqrt(1 - t/2) = 1 - t/4 - t^2/32 - ..., times 2 sqrt(2 t), from t = 0 to the height.
      constexpr double kSeries[] = {1.0,           -1.0 / 4,       -1.0 / 32,
                                    -1.0 / 128,    -5.0 / 2048,    -7.0 / 8192,
                                    -21.0 / 65536, -33.0 / 262144, -429.0 / 8388608};
      double of_area = 0.0, of_depth = 0.0;
      for (int n = 8; n >= 0; --n) {
        of_area = of_area * height + kSeries[n] / (n + 1.5);
        of_depth = of_depth * height + kSeries[n] / ((n + 1.5) * (n + 2.5));
      }
      const double scale = height * std::sqrt(8.0 * height);
      area = scale * of_area;
      depth = scale * height * of_depth;
    } else {
      area = angle - sine * cosine;
      depth = u - cosine * area;
    }
    uu = 0.25 * area + 0.5 * cube * cosine;
    vv = 0.25 * area - cube * cosine / 6.0;
    uuu = u - 0.4 * cube * square;
    uvv = (2.0 / 15.0) * cube * square;
  }
};

}  // namespace volcontact
