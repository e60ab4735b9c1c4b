// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/support/dense.h"
#include "volcontact/step/mechanism.h"

namespace volcontact::test {

/// Rigid bodies that fly alone: body 0 stands, body i has the degrees of freedom from 6 (i - 1) on,
/// three along and three about the axes of the world, at its centre of mass.
class FreeBodies final : public Mechanism {
 public:
  FreeBodies()
      : tree_of_{{}, {}, {}, {}, {}, {}, {MechanismTrees::kNone}, {MechanismTrees::kNone}} {
    origins_.assign(3, 0.0);
    twists_.assign(6, 0.0);
  }
  FreeBodies(const FreeBodies&) = delete;
  FreeBodies& operator=(const FreeBodies&) = delete;

  /// Adds a body; `inertia` about its centre of mass, in the axes of the world. Returns its number.
  int add(double mass, const Mat3& inertia, const Vec3& centre = Vec3::Zero(),
          const Twist& twist = {}) {
    const int body = static_cast<int>(tree_of_.tree_of_body.size()), first = 6 * (body - 1);
    tree_of_.trees.push_back({first, first + 6});
    tree_of_.mass.push_back(mass);
    tree_of_.root.push_back(body);
    tree_of_.tree_of_body.push_back(body - 1);
    tree_of_.last_dof.push_back(first + 5);
    Matrix<6, 6> m = Matrix<6, 6>::Zero();
    m.set_block(0, 0, mass * Mat3::Identity());
    m.set_block(3, 3, inertia);
    masses_.push_back(eigen(m));
    origins_.insert(origins_.end(), centre.begin(), centre.end());
    twists_.insert(twists_.end(), twist.angular.begin(), twist.angular.end());
    twists_.insert(twists_.end(), twist.linear.begin(), twist.linear.end());
    speeds_.insert(speeds_.end(), twist.linear.begin(), twist.linear.end());
    speeds_.insert(speeds_.end(), twist.angular.begin(), twist.angular.end());
    for (int i = 0; i < 6; ++i) {
      tree_of_.carrier.push_back(i == 0 ? MechanismTrees::kNone : first + i - 1);
      tree_of_.depth.push_back(i);
      tree_of_.tree_of_dof.push_back(body - 1);
      for (int k = 0; k < 6; ++k) motions_.push_back((k + 3) % 6 == i ? 1.0 : 0.0);
      // An axis of turns goes with the body, seen from a point that stays.
      Vec3 rate = Vec3::Zero();
      if (i >= 3) rate = twist.linear.cross(Vec3::Unit(i - 3));
      rates_.insert(rates_.end(), 3, 0.0);
      rates_.insert(rates_.end(), rate.begin(), rate.end());
    }
    point_at_numbers();
    return body;
  }

  Eigen::Map<const Eigen::VectorXd> velocity() const {
    return {speeds_.data(), static_cast<Eigen::Index>(speeds_.size())};
  }
  double kinetic_energy(const Eigen::VectorXd& v) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < masses_.size(); ++i) {
      const auto part = v.segment<6>(6 * static_cast<Eigen::Index>(i));
      sum += 0.5 * part.dot(masses_[i] * part);
    }
    return sum;
  }
  /// M^-1 of a body.
  Eigen::Matrix<double, 6, 6> mobility(int body) const {
    return solution(masses_[size(body - 1)], Eigen::MatrixXd::Identity(6, 6));
  }

  void mass(int dof, double* row) const override {
    for (int k = dof % 6; k >= 0; --k) *row++ = masses_[size(dof / 6)](dof % 6, k);
  }
  void damping(std::span<const int> /*dofs*/, std::vector<DofEntry>& /*out*/) const override {}
  bool constraints_see_damping() const override { return false; }

 private:
  void point_at_numbers() {
    trees = &tree_of_;
    speeds = speeds_.data();
    motions = motions_.data();
    motion_rates = rates_.data();
    origins = origins_.data();
    twists = twists_.data();
  }

  MechanismTrees tree_of_;
  std::vector<Eigen::Matrix<double, 6, 6>> masses_;
  std::vector<double> speeds_, motions_, rates_, origins_, twists_;
};

}  // namespace volcontact::test
