// SPDX-License-Identifier: Apache-2.0
// Directional derivatives of a unit: of the wrenches by the motion from the analytic tangent, of
// the rest from differences.
#include <algorithm>
#include <cmath>

#include "fmu/contact/contact_unit.h"
#include "volcontact/base/check.h"

namespace volcontact::fmu {
namespace {

using Mat12 = Matrix<12, 12>;
using Column12 = Vector<12>;

// The turn in the world that a change of a rotation is.
Vec3 turn_of(const Mat3& change, const Mat3& rotation) {
  const Mat3 w = change * rotation.transpose();
  return 0.5 * Vec3(w(2, 1) - w(1, 2), w(0, 2) - w(2, 0), w(1, 0) - w(0, 1));
}

Vec3 turn_of_quaternion(const double* change, const double* quaternion) {
  const auto q = Vector<4>::from(quaternion), dq = Vector<4>::from(change);
  const Vec3 along = q.tail<3>(), change_along = dq.tail<3>();
  // Twice the vector of dq times the inverse of q.
  return 2.0 / q.squaredNorm() * (q[0] * change_along - dq[0] * along - change_along.cross(along));
}

}  // namespace

// Of one body, from a change of the values: turn, way, change of both velocities, in the world.
std::vector<double> ContactUnit::body_change(int body, const std::vector<double>& change) const {
  std::vector<double> out(12, 0.0);
  if (!file_.is_free[static_cast<std::size_t>(body)]) return out;
  const Body& now = bodies_[static_cast<std::size_t>(body)];
  const auto at = [&](Role role) {
    const double* value = values(role, body);
    return value ? &change[static_cast<std::size_t>(value - memory_.values.data())] : nullptr;
  };
  Vec3 turn;
  if (const double* dq = at(Role::kQuaternion)) {
    turn = turn_of_quaternion(dq, values(Role::kQuaternion, body));
  } else {
    turn = turn_of(Mat3::from_rows(at(Role::kRotation)), now.X.rotation);
  }
  Vec3 angular = Vec3::from(at(Role::kAngularVelocity)), linear = Vec3::from(at(Role::kVelocity));
  if (file_.is_in_body) {
    angular = now.X.rotation * angular + turn.cross(now.V.angular);
    linear = now.X.rotation * linear + turn.cross(now.V.linear);
  }
  turn.to(out.data());
  Vec3::from(at(Role::kPosition)).to(out.data() + 3);
  angular.to(out.data() + 6);
  linear.to(out.data() + 9);
  return out;
}

// Change of torque and force on every body, in the frame of the outputs.
void ContactUnit::analytic(const std::vector<double>& change, std::vector<double>& wrenches) const {
  std::vector<std::vector<double>> moved;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    moved.push_back(body_change(static_cast<int>(i), change));
  }
  for (std::size_t m = 0; m < models_.size(); ++m) {
    vc_tangent tangent;
    if (vc_tangent_of(models_[m].model.get(), models_[m].workspace.get(), &tangent) != 0) {
      throw Discarded(vc_error());
    }
    const int sides[] = {file_.models[m].body_a, file_.models[m].body_b};
    Column12 x, v;
    for (int side = 0; side < 2; ++side) {
      const std::vector<double>& body = moved[static_cast<std::size_t>(sides[side])];
      std::copy_n(body.data(), 6, x.data() + 6 * side);
      std::copy_n(body.data() + 6, 6, v.data() + 6 * side);
    }
    const Column12 w =
        Mat12::from_rows(tangent.by_motion) * x + Mat12::from_rows(tangent.by_speed) * v;
    for (int k = 0; k < 12; ++k) {
      wrenches[6 * static_cast<std::size_t>(sides[k / 6]) + static_cast<std::size_t>(k % 6)] +=
          w[k];
    }
  }
  for (std::size_t i = 0; file_.is_in_body && i < bodies_.size(); ++i) {
    const Mat3 to = bodies_[i].X.rotation.transpose();
    const Vec3 turn = Vec3::from(moved[i].data());
    const auto turned_back = [&](const double* wrench, double* change_of_it) {
      const Vec3 in_world = to.transpose() * Vec3::from(wrench);
      (to * (Vec3::from(change_of_it) - turn.cross(in_world))).to(change_of_it);
    };
    const int body = static_cast<int>(i);
    turned_back(values(Role::kTorque, body), &wrenches[6 * i]);
    turned_back(values(Role::kForce, body), &wrenches[6 * i + 3]);
  }
}

void ContactUnit::derivative(const unsigned* unknowns, std::size_t unknown_count,
                             const unsigned* knowns, std::size_t known_count, const double* seed,
                             double* sensitivity) {
  update();
  std::vector<double> change(memory_.values.size(), 0.0);
  bool by_inputs = true;
  double largest = 0.0;
  for (std::size_t i = 0; i < known_count; ++i) {
    change[knowns[i]] += seed[i];
    by_inputs = by_inputs && group_around(knowns[i])->is_input();
    largest = std::max(largest, std::abs(seed[i]));
  }
  const auto is_wrench = [&](unsigned unknown) {
    const Role role = group_around(unknown)->role;
    return role == Role::kForce || role == Role::kTorque;
  };
  const bool all = std::all_of(unknowns, unknowns + unknown_count, is_wrench);
  if (by_inputs) {
    std::vector<double> wrenches(6 * bodies_.size(), 0.0);
    analytic(change, wrenches);
    for (std::size_t i = 0; i < unknown_count; ++i) {
      if (!is_wrench(unknowns[i])) continue;
      const Group& group = *group_around(unknowns[i]);
      const int at = 6 * group.index + (group.role == Role::kForce ? 3 : 0) +
                     static_cast<int>(unknowns[i]) - group.first;
      sensitivity[i] = wrenches[static_cast<std::size_t>(at)];
    }
    if (all) return;
  }
  if (largest == 0.0) {
    std::fill_n(sensitivity, unknown_count, 0.0);
    return;
  }
  // Deflections are 1e-6 m, poses and speeds about 1.
  const double by = (by_inputs ? 1e-7 : 1e-9) / largest;
  const Memory before = memory_;
  std::vector<double> ends[2];
  for (int side = 0; side < 2; ++side) {
    for (std::size_t i = 0; i < change.size(); ++i) {
      memory_.values[i] = before.values[i] + (side ? by : -by) * change[i];
    }
    out_of_date_ = true;
    update();
    ends[side] = memory_.values;
    memory_ = before;
  }
  out_of_date_ = true;
  for (std::size_t i = 0; i < unknown_count; ++i) {
    if (by_inputs && is_wrench(unknowns[i])) continue;
    const double difference = ends[1][unknowns[i]] - ends[0][unknowns[i]];
    sensitivity[i] = group_around(unknowns[i])->is_input() ? 0.0 : difference / (2.0 * by);
  }
}

}  // namespace volcontact::fmu
