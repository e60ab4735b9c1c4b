// SPDX-License-Identifier: Apache-2.0
#include "volcontact/base/symmetric_eigen.h"

#include <gtest/gtest.h>

#include "core/support/random.h"

namespace volcontact::symmetric_eigen_test {
namespace {

// R diag(l) R^T has the eigenvalues l and the columns of R as eigenvectors.
TEST(SymmetricEigen, FindsThoseThatAMatrixWasMadeOf) {
  test::Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Mat3 r = random.rotation();
    const Vec3 values(-1.0, random.uniform(0.0, 1.0), 3.0);
    const Mat3 m = r * Mat3(values.asDiagonal()) * r.transpose();
    const auto eigen = symmetric_eigen(m);
    EXPECT_LT((eigen.values - values).norm(), 1e-14);
    EXPECT_LT((direct_eigenvalues(m) - values).norm(), 1e-7);
    const Mat3 direct = direct_eigenvectors(m);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(std::abs(eigen.vectors.col(k).dot(r.col(k))), 1.0, 1e-14);
      EXPECT_NEAR(std::abs(direct.col(k).dot(r.col(k))), 1.0, 1e-7);
    }
  }
}

TEST(SymmetricEigen, OfTwo) {
  Eigen::Matrix2d m;
  m << 2.0, 1.0, 1.0, 2.0;
  const auto eigen = symmetric_eigen(m);
  EXPECT_NEAR(eigen.values[0], 1.0, 1e-15);
  EXPECT_NEAR(eigen.values[1], 3.0, 1e-15);
  EXPECT_NEAR(std::abs(eigen.vectors.col(1).dot(Eigen::Vector2d(1.0, 1.0))), std::sqrt(2.0), 1e-15);
}

}  // namespace
}  // namespace volcontact::symmetric_eigen_test
