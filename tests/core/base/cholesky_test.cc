// SPDX-License-Identifier: Apache-2.0
#include "volcontact/base/cholesky.h"

#include <gtest/gtest.h>

#include "core/support/random.h"

namespace volcontact::cholesky_test {
namespace {

Mat3 lower(double xx, double yx, double yy, double zx, double zy, double zz) {
  Mat3 l = {xx, 0.0, 0.0, yx, yy, 0.0, zx, zy, zz};
  return l;
}

TEST(Cholesky, FindsTheTriangleThatAMatrixWasMadeOf) {
  test::Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Mat3 l =
        lower(random.uniform(0.5, 2.0), random.uniform(-1.0, 1.0), random.uniform(0.5, 2.0),
              random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(0.5, 2.0));
    EXPECT_LT((cholesky(l * l.transpose()) - l).norm(), 1e-13);
  }
}

// In whole numbers, which do not round.
TEST(Cholesky, OfASemidefiniteMatrixHasColumnsOfNothing) {
  for (const Mat3& l : {lower(2, 1, 0, 3, 0, 1), lower(0, 0, 2, 0, 1, 3), lower(2, -1, 3, 1, 2, 0),
                        lower(0, 0, 0, 0, 0, 0)}) {
    EXPECT_EQ(cholesky(l * l.transpose()), l);
  }
}

}  // namespace
}  // namespace volcontact::cholesky_test
