// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Cholesky>
#include <algorithm>

#include "volcontact/pair/fan.h"

namespace volcontact {

/// How the rim of an overlap lies about the axis of a fan, from the ways to it in eight even
/// directions.
class RimShape {
 public:
  RimShape(const double* u, const double* v, const double* rho) {
    const auto [shortest, longest] = std::minmax_element(rho, rho + kLanes);
    ratio_ = *longest / *shortest;
    double area = 0.0;
    Eigen::Vector2d first = Eigen::Vector2d::Zero();
    Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
    for (int i = 0; i < kLanes; ++i) {
      const Eigen::Vector2d direction(u[i], v[i]);
      const double r2 = rho[i] * rho[i];
      area += r2 / 2.0;
      first += r2 * rho[i] / 3.0 * direction;
      second += r2 * r2 / 4.0 * direction * direction.transpose();
    }
    shift_ = first / area;
    const Eigen::LLT<Eigen::Matrix2d> factor(4.0 * (second / area - shift_ * shift_.transpose()));
    known_ = factor.info() == Eigen::Success;
    axes_ = factor.matrixL();
  }

  /// Longest by shortest way to the rim.
  double ratio() const { return ratio_; }

  /// A frame about the middle of the rim in which it is rounder; false where the rim is too thin to
  /// tell.
  bool round_off(FanFrame& frame) const {
    if (!known_) return false;
    (frame.central ? frame.t : frame.center) += frame.u * shift_.x() + frame.v * shift_.y();
    frame.u = frame.u * axes_(0, 0) + frame.v * axes_(1, 0);
    frame.v *= axes_(1, 1);
    return true;
  }

 private:
  double ratio_;
  bool known_;
  Eigen::Vector2d shift_;
  Eigen::Matrix2d axes_;
};

}  // namespace volcontact
