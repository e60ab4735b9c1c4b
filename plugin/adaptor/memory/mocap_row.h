// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/base/types.h"

namespace volcontact::adaptor {

/// What is kept of each mocap body at an evaluation: its pose, its twist, and the wrench of all
/// contacts on it and on what hangs on it, about its origin.
struct MocapRow {
  static constexpr int kNumbers = 7 + 6 + 6;
  double* p;

  Vector<7> pose() const { return Vector<7>::from(p); }  ///< position, quaternion
  Twist twist() const { return {Vec3::from(p + 7), Vec3::from(p + 10)}; }
  void set_twist(const Twist& twist) const {
    twist.angular.to(p + 7);
    twist.linear.to(p + 10);
  }
  Wrench wrench() const { return {.torque = Vec3::from(p + 16), .force = Vec3::from(p + 13)}; }
  void add(const Wrench& more) const {
    Wrench sum = wrench();
    sum += more;
    sum.force.to(p + 13);
    sum.torque.to(p + 16);
  }
};

}  // namespace volcontact::adaptor
