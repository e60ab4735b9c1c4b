// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>

namespace volcontact_cgal {

/// Volume, centroid and inertia tensor about the centroid for unit density.
struct Moments {
  double volume = 0.0;               ///< [m^3]
  std::array<double, 3> centroid{};  ///< [m]
  std::array<double, 6> inertia{};   ///< [m^5]: xx, yy, zz, xy, xz, yz
};

/// Sums signed tetrahedra from the origin in extended precision. Shift the origin near the solid:
/// then no digits cancel.
class MomentSum {
 public:
  using Corner = std::array<long double, 3>;

  void add(const Corner& a, const Corner& b, const Corner& c) {
    const long double det = a[0] * (b[1] * c[2] - b[2] * c[1]) +
                            a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
    volume_ += det / 6;
    for (int i = 0; i < 3; ++i) {
      const long double sum_i = a[i] + b[i] + c[i];
      first_[i] += det / 24 * sum_i;
      for (int j = i; j < 3; ++j) {
        const long double sum_j = a[j] + b[j] + c[j];
        second_[i][j] += det / 120 * (sum_i * sum_j + a[i] * a[j] + b[i] * b[j] + c[i] * c[j]);
      }
    }
  }

  /// The moments of the solid whose corners were given relative to `origin`.
  Moments result(const std::array<double, 3>& origin) const {
    Moments out;
    out.volume = static_cast<double>(volume_);
    if (volume_ == 0) return out;
    std::array<long double, 3> c{};
    for (int i = 0; i < 3; ++i) {
      c[i] = first_[i] / volume_;
      out.centroid[i] = static_cast<double>(origin[i] + c[i]);
    }
    const auto m = [&](int i, int j) { return second_[i][j] - volume_ * c[i] * c[j]; };
    out.inertia = {static_cast<double>(m(1, 1) + m(2, 2)), static_cast<double>(m(0, 0) + m(2, 2)),
                   static_cast<double>(m(0, 0) + m(1, 1)), static_cast<double>(-m(0, 1)),
                   static_cast<double>(-m(0, 2)),          static_cast<double>(-m(1, 2))};
    return out;
  }

 private:
  long double volume_ = 0;
  std::array<long double, 3> first_{};
  std::array<std::array<long double, 3>, 3> second_{};
};

}  // namespace volcontact_cgal
