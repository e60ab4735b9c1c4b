// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/signed_distance.h"

#include <string>

namespace volcontact {

SignedDistance::SignedDistance(std::shared_ptr<const Source> source, const Params& params)
    : source_(std::move(source)), p_(params), bounds_(source_->bounds()) {
  require(p_.lipschitz > 0.0 && p_.lipschitz < kInfinity,
          "signed_distance: lipschitz = " + std::to_string(p_.lipschitz) +
              " [-] is out of range: must be > 0");
  require(p_.curvature >= 0.0, "signed_distance: curvature = " + std::to_string(p_.curvature) +
                                   " [1/m] is out of range: must be >= 0");
  require(bounds_.bounded() && (bounds_.max - bounds_.min).minCoeff() >= 0.0,
          "signed_distance: bounds must be finite, the lower corner first [m]");
}

Vec3 SignedDistance::gradient(const Vec3& p) const {
  const double step = 1e-6 * bounds_.half_sizes().norm();
  Vec3 sum = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 offset = step * Vec3::Unit(axis);
    sum[axis] = signed_distance(p + offset) - signed_distance(p - offset);
  }
  return sum.squaredNorm() > 0.0 ? Vec3(sum.normalized()) : Vec3::UnitZ();
}

double SignedDistance::support_height(const Vec3& e) const {
  return e.dot(bounds_.center()) + e.cwiseAbs().dot(bounds_.half_sizes());
}

}  // namespace volcontact
