// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/support/random.h"

namespace volcontact::test {

/// Central difference of f at 0, fourth order: exact for polynomials of degree 4 up to rounding.
template <typename Function>
double derivative(Function&& f, double step) {
  return (8.0 * (f(step) - f(-step)) - (f(2.0 * step) - f(-2.0 * step))) / (12.0 * step);
}

struct Gradient {
  Vec3 shift;  ///< along the axes of A
  Vec3 turn;   ///< about the axes of A through its origin
};

/// Gradient of a function of the pose X_AB when A moves and B stays.
template <typename Function>
Gradient gradient_of_A(Function&& f, const Pose& X_AB, double step) {
  Gradient g;
  for (int i = 0; i < 3; ++i) {
    const Vec3 axis = Vec3::Unit(i);
    g.shift[i] =
        derivative([&](double h) { return f(moved(X_AB, -h * axis, Vec3::Zero())); }, step);
    g.turn[i] = derivative([&](double h) { return f(moved(X_AB, Vec3::Zero(), -h * axis)); }, step);
  }
  return g;
}

}  // namespace volcontact::test
