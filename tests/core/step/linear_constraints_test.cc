// SPDX-License-Identifier: Apache-2.0
#include "volcontact/step/linear_constraints.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "core/support/free_bodies.h"
#include "core/support/random.h"

namespace volcontact::linear_constraints_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Rows that only push, f = max(0, -d x), and after them three that know each other, f = -H x.
class Rows final : public LinearConstraints {
 public:
  Rows(const MatrixXd& jacobian, const VectorXd& reference, double d, const Mat3& h)
      : d_(d), h_(h), one_sided_(static_cast<int>(jacobian.rows()) - 3) {
    begin_rows();
    for (Eigen::Index i = 0; i < jacobian.rows(); ++i) {
      for (Eigen::Index k = 0; k < jacobian.cols(); ++k) {
        if (jacobian(i, k) != 0.0) add_entry(static_cast<int>(k), jacobian(i, k));
      }
      end_row(reference[i]);
    }
    join(0, 6);
  }

  VectorXd forces(const VectorXd& x) const {
    VectorXd f = (-d_ * x).cwiseMax(0.0);
    f.tail<3>() = -h_ * x.tail<3>();
    return f;
  }

 private:
  void respond(std::span<const int> rows, std::span<const double> violation) override {
    const VectorXd x =
        Eigen::Map<const VectorXd>(violation.data(), static_cast<Eigen::Index>(violation.size()));
    const VectorXd f = forces(x);
    for (const int i : rows) {
      set_response(i, f[i], i < one_sided_ && x[i] < 0.0 ? d_ : 0.0);
      if (i == one_sided_) add_cone(i, 3, h_.data());
    }
  }

  double d_;
  Mat3 h_;
  int one_sided_;
};

// Newton's method on M a = t + Jc' f(Jc a - a_ref): ends where the forces are those of the rows.
TEST(LinearConstraints, RoundsEndAtTheForcesOfTheRows) {
  test::Random random(4);
  for (int run = 0; run < 50; ++run) {
    test::FreeBodies bodies;
    for (int i = 0; i < 2; ++i) bodies.add(random.log_uniform(0.1, 10.0), Mat3::Identity());
    const int rows = 8, dofs = 12;
    MatrixXd jacobian = MatrixXd::Zero(rows, dofs);
    VectorXd reference(rows), t(dofs);
    for (int i = 0; i < rows; ++i) {
      for (int k = 0; k < dofs; ++k) jacobian(i, k) = random.uniform(-1.0, 1.0);
      reference[i] = random.uniform(-5.0, 5.0);
    }
    for (int k = 0; k < dofs; ++k) t[k] = random.uniform(-10.0, 10.0);
    // Without curvature along one direction, as a cone along the way to its tip.
    const Vec3 flat = random.direction();
    const Mat3 h = 30.0 * (Mat3::Identity() - flat * flat.transpose());
    Rows constraints(jacobian, reference, 20.0, h);
    ContactIslands islands;
    islands.build(*bodies.trees, {}, constraints.joined());
    ASSERT_EQ(islands.count(), 1);
    constraints.select(islands, 0);
    ASSERT_FALSE(constraints.empty());

    std::vector<DofEntry> entries;
    const int all[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
    bodies.mass(all, entries);
    MatrixXd m = MatrixXd::Zero(dofs, dofs);
    for (const DofEntry& entry : entries) m(entry.row, entry.column) = entry.value;
    m = MatrixXd(m.selfadjointView<Eigen::Lower>());
    VectorXd a(dofs);
    bool settled = false;
    for (int round = 0; round < 30 && !settled; ++round) {
      MatrixXd left = m;
      VectorXd right = t;
      for (const auto& entry : constraints.load()) right[entry.dof] += entry.value;
      for (int c = 0; c < constraints.columns(); ++c) {
        VectorXd column = VectorXd::Zero(dofs);
        for (const auto& entry : constraints.column(c)) column[entry.dof] += entry.value;
        left += column * column.transpose();
      }
      a = left.ldlt().solve(right);
      settled = constraints.improve({a.data(), static_cast<std::size_t>(dofs)});
    }
    EXPECT_TRUE(settled) << run;
    const VectorXd missing =
        t + jacobian.transpose() * constraints.forces(jacobian * a - reference) - m * a;
    EXPECT_LT(missing.norm(), 1e-8 * t.norm()) << run;
  }
}

TEST(LinearConstraints, AnIslandWithoutAnyHasNone) {
  test::FreeBodies bodies;
  for (int i = 0; i < 3; ++i) bodies.add(1.0, Mat3::Identity());
  MatrixXd jacobian = MatrixXd::Zero(4, 18);
  jacobian.col(0).setOnes();
  Rows constraints(jacobian, VectorXd::Ones(4), 1.0, Mat3::Identity());
  const std::vector<ContactPlace> places = {{3, 0}};
  ContactIslands islands;
  islands.build(*bodies.trees, places, constraints.joined());
  ASSERT_EQ(islands.count(), 2);
  constraints.select(islands, islands.island_of(12));
  EXPECT_TRUE(constraints.empty());
  EXPECT_EQ(constraints.columns(), 0);
  constraints.select(islands, islands.island_of(0));
  EXPECT_FALSE(constraints.empty());
}

}  // namespace
}  // namespace volcontact::linear_constraints_test
