// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "volcontact/base/cholesky.h"
#include "volcontact/pair/sections/section.h"

namespace volcontact {

/// How the rim of an overlap lies about the axis of a set of sections: the ways to it in eight even
/// directions, as Sections::ends() finds them.
struct RimShape {
  double u[kLanes], v[kLanes], rho[kLanes], height[kLanes];

  double shortest() const { return *std::min_element(rho, rho + kLanes); }
  double longest() const { return *std::max_element(rho, rho + kLanes); }

  /// A frame about the middle of the rim in which it is rounder; false where the rim is too thin to
  /// tell.
  bool round_off(SectionFrame& frame) const {
    double area = 0.0;
    Vec3 first = Vec3::Zero();
    Mat3 second = Mat3::Zero();
    for (int i = 0; i < kLanes; ++i) {
      const Vec3 direction(u[i], v[i], 0.0);
      const double r2 = rho[i] * rho[i];
      area += r2 / 2.0;
      first += r2 * rho[i] / 3.0 * direction;
      second += outer(r2 * r2 / 4.0 * direction, direction);
    }
    const Vec3 shift = first / area;
    const Mat3 axes = cholesky(4.0 * (second / area - outer(shift, shift)));
    if (!(axes(0, 0) > 0.0) || !(axes(1, 1) > 0.0)) return false;
    (frame.central ? frame.t : frame.center) += frame.u * shift.x() + frame.v * shift.y();
    frame.u = frame.u * axes(0, 0) + frame.v * axes(1, 0);
    frame.v *= axes(1, 1);
    return true;
  }

  /// From a far corner, whose rim tells little: a frame half way to the place of the rim that is
  /// farthest off.
  void go_inwards(SectionFrame& frame) const {
    const auto far = std::max_element(rho, rho + kLanes) - rho;
    const double x = 0.5 * rho[far] * u[far], y = 0.5 * rho[far] * v[far];
    if (frame.central) {
      frame.t += x * frame.u + y * frame.v;
    } else {
      frame.center = frame.place(x, y, 0.5 * height[far]);
    }
    frame.u *= 0.5 * rho[far];
    frame.v *= 0.5 * rho[far];
  }
};

}  // namespace volcontact
