// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "adaptor/mujoco_compat.h"
#include "volcontact/base/types.h"

namespace volcontact::adaptor {

/// Where two bodies meet: six coordinates of the relative motion of a against b, along n, about
/// t_1, about t_2, along t_1, along t_2, about n.
struct ContactPlace {
  int body_a = 0;
  int body_b = 0;
  Vec3 point = Vec3::Zero();     ///< of the world [m]
  Mat3 axes = Mat3::Identity();  ///< t_1, t_2, n by columns, in the world
};

/// What one step of MuJoCo makes of forces at contact places: u' = u_free + h Lambda f, with
/// u = J v, Lambda = J Mh^-1 J' and u_free = u + h J Mh^-1 t. Mh is what the integrator divides by:
/// M, or M + h B with the damping B of the degrees of freedom. Memory is reused from step to step.
class ContactSpace {
 public:
  static constexpr int kRows = 6;  ///< of a place
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using Block = Eigen::Matrix<double, kRows, 1>;

  /// `known`: t, all generalized forces but those at the places, nv numbers. Uses the mass matrix
  /// and the positions that are current in `d`.
  void build(const mjModel* m, mjData* d, std::span<const ContactPlace> places,
             const double* known) noexcept;

  int rows() const { return rows_; }
  Eigen::Map<const RowMajor> jacobian() const { return {jacobian_.data(), rows_, nv_}; }
  /// Where there are fewer degrees of freedom than rows, it is cheaper to solve for their
  /// velocities; then `mass` is there, else `delassus`.
  bool prefers_dofs() const { return nv_ <= rows_; }
  /// Lambda.
  Eigen::Map<const RowMajor> delassus() const { return {delassus_.data(), rows_, rows_}; }
  /// Mh, its lower triangle.
  Eigen::Map<const RowMajor> mass() const { return {mass_.data(), nv_, nv_}; }
  /// The block of Lambda of one place.
  const Eigen::Matrix<double, kRows, kRows>& mobility(std::size_t place) const {
    return mobility_[place];
  }
  Eigen::Map<const Eigen::VectorXd> known() const { return {known_, nv_}; }
  /// Makes `delassus` where `build` did not.
  void build_delassus() noexcept;
  /// u' under the forces f.
  void move(const std::vector<double>& f, std::vector<double>& u) noexcept;
  Eigen::Map<const Eigen::VectorXd> velocity() const { return {velocity_.data(), rows_}; }
  Eigen::Map<const Eigen::VectorXd> free_velocity() const { return {free_.data(), rows_}; }

 private:
  void add_body(const mjModel* m, const mjData* d, const ContactPlace& place, int body, double sign,
                double* rows) noexcept;
  void make_mass(const mjModel* m, mjData* d, bool damped) noexcept;
  void divide_by_mass(const mjModel* m) noexcept;

  int rows_ = 0;
  int nv_ = 0;
  std::vector<double> jacobian_, response_;  // J and J Mh^-1, row by row
  std::vector<double> delassus_, velocity_, free_;
  std::vector<double> mass_, block_, generalized_;
  std::vector<Eigen::Matrix<double, kRows, kRows>> mobility_;
  const double* known_ = nullptr;
  double step_ = 0.0;
};

/// All that acts on the degrees of freedom beside the contacts and MuJoCo's constraints, nv
/// numbers: passive forces so far, bias, actuators at the present state, and what the user applied,
/// given as `user_qfrc` (nv) and `user_xfrc` (6 nbody).
void known_forces(const mjModel* m, mjData* d, const double* user_qfrc, const double* user_xfrc,
                  std::vector<double>& out) noexcept;

}  // namespace volcontact::adaptor
