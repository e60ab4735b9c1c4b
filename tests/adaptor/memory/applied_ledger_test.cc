// SPDX-License-Identifier: Apache-2.0
#include "adaptor/memory/applied_ledger.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace volcontact::adaptor::applied_ledger_test {
namespace {

class AppliedLedger : public ::testing::Test {
 protected:
  AppliedLedger() : numbers_(200, 0.0), block(numbers_.data() + numbers_.size(), {0, 2}) {
    block.claim();
  }
  void apply(double first, double second) {
    const double forces[] = {first, second};
    apply_beside_user(block, 2, forces, array.data());
  }

  std::vector<double> numbers_;
  UserdataBlock block;
  std::vector<double> array{0.0, 0.0};
};

TEST_F(AppliedLedger, DoesNotAccumulate) {
  for (int i = 0; i < 5; ++i) apply(3.0, -1.0);
  EXPECT_EQ(array, (std::vector<double>{3.0, -1.0}));
}

TEST_F(AppliedLedger, ConstantUserForceStays) {
  array = {10.0, 0.0};
  for (int i = 0; i < 5; ++i) apply(3.0, -1.0);
  EXPECT_EQ(array, (std::vector<double>{13.0, -1.0}));
}

TEST_F(AppliedLedger, AssignmentReplacesTheUsersForceOnly) {
  array = {10.0, 0.0};
  apply(3.0, -1.0);
  array[0] = 20.0;
  apply(4.0, -2.0);
  EXPECT_EQ(array, (std::vector<double>{24.0, -2.0}));
}

TEST_F(AppliedLedger, NothingIsLeftWhenContactEnds) {
  array = {10.0, 0.0};
  apply(0.1, 0.2);
  apply(0.0, 0.0);
  EXPECT_EQ(array, (std::vector<double>{10.0, 0.0}));
}

// In equilibrium contact and user cancel exactly; then the user takes the force away.
TEST_F(AppliedLedger, ZeroIsAnAssignmentAlsoWhereTheSumWasZero) {
  array = {6.0, 0.0};
  apply(-6.0, 0.0);
  EXPECT_LT(std::abs(array[0]), 1e-100);
  EXPECT_EQ(array[1], 0.0);  // no contact, no trace
  apply(-6.0, 0.0);
  EXPECT_EQ(block.base()[0], 6.0);  // not assigned: it stays
  array[0] = 0.0;
  apply(-1.0, 0.0);
  EXPECT_EQ(array[0], -1.0);
}

TEST_F(AppliedLedger, ReleaseLeavesWhatIsTheUsers) {
  array = {10.0, 0.0};
  apply(3.0, -1.0);
  array[1] = 7.0;  // assigned since
  release_to_user(block, 2, array.data());
  EXPECT_EQ(array, (std::vector<double>{10.0, 7.0}));
  release_to_user(block, 2, array.data());
  EXPECT_EQ(array, (std::vector<double>{10.0, 7.0}));
  apply(3.0, -1.0);
  EXPECT_EQ(array, (std::vector<double>{13.0, 6.0}));
}

TEST_F(AppliedLedger, ReleaseBeforeAnyEvaluationDoesNothing) {
  array = {10.0, 5.0};
  release_to_user(block, 2, array.data());
  EXPECT_EQ(array, (std::vector<double>{10.0, 5.0}));
}

}  // namespace
}  // namespace volcontact::adaptor::applied_ledger_test
