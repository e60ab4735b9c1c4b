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
  RimShape() = default;
  RimShape(const double* u, const double* v, const double* rho, const double* height) {
    const auto [shortest, longest] = std::minmax_element(rho, rho + kLanes);
    shortest_ = *shortest;
    longest_ = *longest;
    const auto far = longest - rho;
    farthest_ = rho[far] * Vec3(u[far], v[far], height[far] / rho[far]);
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

  double shortest() const { return shortest_; }
  double longest() const { return longest_; }
  /// Longest by shortest way to the rim.
  double ratio() const { return longest_ / shortest_; }

  /// A frame about the middle of the rim in which it is rounder; false where the rim is too thin to
  /// tell.
  bool round_off(FanFrame& frame) const {
    if (!known_) return false;
    (frame.central ? frame.t : frame.center) += frame.u * shift_.x() + frame.v * shift_.y();
    frame.u = frame.u * axes_(0, 0) + frame.v * axes_(1, 0);
    frame.v *= axes_(1, 1);
    return true;
  }

  /// From a far corner, whose rim tells little: a frame half way to the place of the rim that is
  /// farthest off.
  void go_inwards(FanFrame& frame) const {
    const Vec3 half = 0.5 * farthest_;
    const double scale = half.head<2>().norm();
    if (frame.central) {
      frame.t += half.x() * frame.u + half.y() * frame.v;
    } else {
      frame.center = frame.place(half.x(), half.y(), half.z());
    }
    frame.u *= scale;
    frame.v *= scale;
  }

 private:
  double shortest_, longest_;
  Vec3 farthest_;  // of the rim: along u, v and t
  bool known_;
  Eigen::Vector2d shift_;
  Eigen::Matrix2d axes_;
};

}  // namespace volcontact
