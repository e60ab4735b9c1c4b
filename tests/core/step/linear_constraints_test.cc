// SPDX-License-Identifier: Apache-2.0
#include "volcontact/step/linear_constraints.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/support/dense.h"
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

  using LinearConstraints::guess;

  VectorXd forces(const VectorXd& x) const {
    VectorXd f = (-d_ * x).cwiseMax(0.0);
    f.tail<3>() = -test::eigen(h_ * Vec3(x.tail<3>()));
    return f;
  }

 private:
  void respond(std::span<const int> rows, std::span<const double> violation) override {
    const VectorXd x =
        Eigen::Map<const VectorXd>(violation.data(), static_cast<Eigen::Index>(violation.size()));
    const VectorXd f = forces(x);
    for (const int i : rows) {
      set_response(i, f[i], i < one_sided_ && x[i] < 0.0 ? d_ : 0.0);
      if (i == one_sided_) add_cone(i, 3, test::eigen(h_).data());
    }
  }

  double d_;
  Mat3 h_;
  int one_sided_;
};

// Dry friction of degrees of freedom: f = -d x, and no more than it can hold.
class DryRows final : public LinearConstraints {
 public:
  DryRows(int count, double d, double most) : d_(d), most_(most) {
    begin_rows();
    for (int i = 0; i < count; ++i) {
      add_entry(i, 1.0);
      end_row(0.0);
    }
    join(0, 6);
  }

  using LinearConstraints::guess;

  VectorXd forces(const VectorXd& x) const { return (-d_ * x).cwiseMax(-most_).cwiseMin(most_); }

 private:
  void respond(std::span<const int> rows, std::span<const double> violation) override {
    const VectorXd f = forces(
        Eigen::Map<const VectorXd>(violation.data(), static_cast<Eigen::Index>(violation.size())));
    for (const int i : rows) set_response(i, f[i], std::abs(f[i]) < most_ ? d_ : 0.0);
  }

  double d_, most_;
};

// Two free bodies under random forces t, with rows that know all of their degrees of freedom.
struct Problem {
  explicit Problem(test::Random& random) {
    for (int i = 0; i < 2; ++i) bodies.add(random.log_uniform(0.1, 10.0), Mat3::Identity());
    for (double& x : jacobian.reshaped()) x = random.uniform(-1.0, 1.0);
    for (double& x : reference) x = random.uniform(-5.0, 5.0);
    for (double& x : t) x = random.uniform(-10.0, 10.0);
    // Without curvature along one direction, as a cone along the way to its tip.
    const Vec3 flat = random.direction();
    h = 30.0 * (Mat3::Identity() - outer(flat, flat));
    m = MatrixXd::Zero(kDofs, kDofs);
    for (int i = 0; i < kDofs; ++i) {
      double row[kDofs] = {};
      bodies.mass(i, row);
      for (int k = i; k >= i - i % 6; --k) m(i, k) = m(k, i) = row[i - k];
    }
  }

  Rows rows() const { return {jacobian, reference, 20.0, h}; }

  // Newton's method on M a = t + Jc' f(Jc a - a_ref). Returns how many rounds it took, or 0.
  int settle(LinearConstraints& constraints, VectorXd& a) const {
    ContactIslands islands;
    islands.build(*bodies.trees, {}, constraints.joined());
    constraints.select(islands, 0);
    for (int round = 1; round <= 30; ++round) {
      MatrixXd left = m;
      VectorXd right = t;
      for (const auto& entry : constraints.load()) right[entry.dof] += entry.value;
      for (int c = 0; c < constraints.columns(); ++c) {
        VectorXd column = VectorXd::Zero(kDofs);
        for (const auto& entry : constraints.column(c)) column[entry.dof] += entry.value;
        left += test::square(column);
      }
      a = test::solution(left, right);
      if (constraints.improve({a.data(), kDofs})) return round;
    }
    return 0;
  }

  static constexpr int kDofs = 12;
  test::FreeBodies bodies;
  MatrixXd jacobian = MatrixXd(8, kDofs), m;
  VectorXd reference = VectorXd(8), t = VectorXd(kDofs);
  Mat3 h;
};

TEST(LinearConstraints, RoundsEndAtTheForcesOfTheRows) {
  test::Random random(4);
  for (int run = 0; run < 50; ++run) {
    const Problem problem(random);
    Rows constraints = problem.rows();
    VectorXd a;
    EXPECT_GT(problem.settle(constraints, a), 0) << run;
    EXPECT_FALSE(constraints.empty());
    const VectorXd force =
        constraints.forces(test::product(problem.jacobian, a) - problem.reference);
    const VectorXd missing = problem.t + test::product(problem.jacobian.transpose(), force) -
                             test::product(problem.m, a);
    EXPECT_LT(missing.norm(), 1e-8 * problem.t.norm()) << run;
  }
}

TEST(LinearConstraints, TheFirstGuessTellsOnlyWhichRowsPush) {
  test::Random random(5);
  for (int run = 0; run < 50; ++run) {
    const Problem problem(random);
    VectorXd a, again, anywhere(Problem::kDofs);
    Rows constraints = problem.rows();
    ASSERT_GT(problem.settle(constraints, a), 0);
    constraints.guess({a.data(), Problem::kDofs});
    EXPECT_EQ(problem.settle(constraints, again), 1) << run;
    EXPECT_LT((again - a).norm(), 1e-12 * a.norm()) << run;
    for (double& x : anywhere) x = random.uniform(-100.0, 100.0);
    anywhere[0] = std::numeric_limits<double>::quiet_NaN();
    constraints.guess({anywhere.data(), Problem::kDofs});
    ASSERT_GT(problem.settle(constraints, again), 0) << run;
    EXPECT_LT((again - a).norm(), 1e-12 * a.norm()) << run;
    anywhere[0] = 0.0;
    constraints.guess({anywhere.data(), Problem::kDofs});
    ASSERT_GT(problem.settle(constraints, again), 0) << run;
    EXPECT_LT((again - a).norm(), 1e-12 * a.norm()) << run;
  }
}

// What moves across the narrow range in which it holds is not looked at from the other side again.
TEST(LinearConstraints, DryFrictionComesToHold) {
  test::Random random(6);
  int holds = 0, slides = 0;
  for (int run = 0; run < 50; ++run) {
    Problem problem(random);
    // Bodies that hang together, so that friction of one holds the other.
    MatrixXd coupled(Problem::kDofs, Problem::kDofs);
    for (double& x : coupled.reshaped()) x = random.uniform(-1.0, 1.0);
    problem.m += test::square(coupled);
    constexpr double kMost = 4.0;
    DryRows constraints(Problem::kDofs, 1e6, kMost);
    VectorXd a = VectorXd::Zero(Problem::kDofs);
    VectorXd start(Problem::kDofs);
    for (double& x : start) x = random.uniform(-1.0, 1.0);
    constraints.guess({start.data(), Problem::kDofs});
    EXPECT_GT(problem.settle(constraints, a), 0) << run;
    const VectorXd force = constraints.forces(a);
    EXPECT_LT((problem.t + force - test::product(problem.m, a)).norm(), 1e-6 * problem.t.norm())
        << run;
    for (const double f : force) ++(std::abs(f) < kMost ? holds : slides);
  }
  EXPECT_GT(holds, 100);
  EXPECT_GT(slides, 50);
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
