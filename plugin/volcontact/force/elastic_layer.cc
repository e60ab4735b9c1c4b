// SPDX-License-Identifier: Apache-2.0
#include "volcontact/force/elastic_layer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "volcontact/base/fields.h"
#include "volcontact/force/restitution.h"

namespace volcontact {
namespace {

constexpr Range kPoisson{-1.0, 0.5, true, true, "> -1 and < 0.5"};
constexpr Range kRestitution{0.0, 1.0, true, false, "> 0 and <= 1"};

double checked(const char* name, const char* unit, double value, const Range& range) {
  require(range.contains(value), out_of_range_message("layer", name, unit, value, range));
  return value;
}

double stiffness(double value) { return checked("stiffness", "N/m^3", value, kPositive); }

// Both over the same power of two, which makes the larger one about 1: their sum and their products
// with other numbers stay finite, and ratios have the bits that they had.
struct Scaled {
  Scaled(double stiffness_a, double stiffness_b)
      : a(stiffness(stiffness_a)), b(stiffness(stiffness_b)) {
    const int exponent = std::ilogb(std::max(a, b));
    a = std::scalbn(a, -exponent);
    b = std::scalbn(b, -exponent);
  }
  double a;
  double b;
};

}  // namespace

double layer_stiffness(double modulus, double thickness) {
  return checked("modulus", "Pa", modulus, kPositive) /
         checked("thickness", "m", thickness, kPositive);
}

double confined_layer_stiffness(double modulus, double thickness, double poisson_ratio) {
  const double nu = checked("poisson_ratio", "-", poisson_ratio, kPoisson);
  return layer_stiffness(modulus, thickness) * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
}

double series_stiffness(double stiffness_a, double stiffness_b) {
  const double a = stiffness(stiffness_a), b = stiffness(stiffness_b);
  const double product = a * b;
  if (std::isfinite(product) && product >= std::numeric_limits<double>::min()) {
    return product / (a + b);
  }
  const auto [least, most] = std::minmax(a, b);
  return least / (1.0 + least / most);
}

double series_damping(double stiffness_a, double damping_a, double stiffness_b, double damping_b) {
  const auto [a, b] = Scaled(stiffness_a, stiffness_b);
  return (b * checked("damping", "s/m", damping_a, kNonNegative) +
          a * checked("damping", "s/m", damping_b, kNonNegative)) /
         (a + b);
}

double share_of_first(double stiffness_a, double stiffness_b) {
  const auto [a, b] = Scaled(stiffness_a, stiffness_b);
  return b / (a + b);
}

double series_restitution(double stiffness_a, double restitution_a, double stiffness_b,
                          double restitution_b) {
  const auto number = [](double e) {
    return damping_number_of(checked("restitution", "-", e, kRestitution));
  };
  return restitution_of(
      series_damping(stiffness_a, number(restitution_a), stiffness_b, number(restitution_b)));
}

}  // namespace volcontact
