// SPDX-License-Identifier: Apache-2.0
#include "volcontact/base/symmetric_eigen.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/support/random.h"

namespace volcontact::symmetric_eigen_test {
namespace {

// What makes them eigenvalues: M V = V diag(l), V' V = 1, and l rises.
template <int N>
void expect_eigen_of(const Matrix<N, N>& m) {
  const SymmetricEigen<N> eigen = symmetric_eigen(m);
  const Matrix<N, N>& v = eigen.vectors;
  EXPECT_LE((m * v - v * eigen.values.asDiagonal()).norm(), 1e-15 * N * m.norm());
  EXPECT_LE((v.transpose() * v - Matrix<N, N>::Identity()).norm(), 1e-15 * N);
  for (int k = 1; k < N; ++k) EXPECT_LE(eigen.values[k - 1], eigen.values[k]);
}

// R diag(l) R^T has the eigenvalues l and the columns of R as eigenvectors.
TEST(SymmetricEigen, FindsThoseThatAMatrixWasMadeOf) {
  test::Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Mat3 r = random.rotation();
    const Vec3 values(-1.0, random.uniform(0.0, 1.0), 3.0);
    const auto eigen = symmetric_eigen(r * values.asDiagonal() * r.transpose());
    EXPECT_LT((eigen.values - values).norm(), 1e-14);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(std::abs(eigen.vectors.col(k).dot(r.col(k))), 1.0, 1e-14);
    }
  }
}

TEST(SymmetricEigen, OfSizesFarApart) {
  test::Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Mat3 r = random.rotation();
    Vec3 values;
    for (double& x : values)
      x = random.log_uniform(1e-12, 1e12) * (random.uniform() < 0.5 ? -1 : 1);
    Mat3 m = r * values.asDiagonal() * r.transpose();
    m = 0.5 * (m + m.transpose());
    expect_eigen_of(m);
  }
}

// Where two are the same, or nothing is beside the diagonal, any vectors across will do.
TEST(SymmetricEigen, OfMatricesWithEqualOnes) {
  test::Random random(3);
  const Mat3 r = random.rotation();
  for (const Vec3& values : {Vec3(0, 0, 0), Vec3(2, 2, 2), Vec3(3, 1, 1), Vec3(1, 3, 3),
                             Vec3(-1, 0, 1), Vec3(5, 1, 3), Vec3(0, 0, 1e-300)}) {
    expect_eigen_of(Mat3(values.asDiagonal()));
    Mat3 turned = r * values.asDiagonal() * r.transpose();
    expect_eigen_of(0.5 * (turned + turned.transpose()));
  }
  expect_eigen_of(Mat3(0, 1, 1, 1, 0, 1, 1, 1, 0));
}

TEST(SymmetricEigen, OfTwo) {
  const auto eigen = symmetric_eigen(Mat2(2.0, 1.0, 1.0, 2.0));
  EXPECT_NEAR(eigen.values[0], 1.0, 1e-15);
  EXPECT_NEAR(eigen.values[1], 3.0, 1e-15);
  EXPECT_NEAR(std::abs(eigen.vectors.col(1).dot(Vec2(1.0, 1.0))), std::sqrt(2.0), 1e-15);
  test::Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const double beside = random.uniform(-1.0, 1.0) * random.log_uniform(1e-12, 1.0);
    expect_eigen_of(Mat2(random.uniform(-1.0, 1.0), beside, beside, random.uniform(-1.0, 1.0)));
  }
}

TEST(SymmetricEigen, EndsWithWhatIsNoNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(symmetric_eigen(Mat3::Constant(nan)).values.allFinite());
}

}  // namespace
}  // namespace volcontact::symmetric_eigen_test
