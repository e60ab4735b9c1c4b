// SPDX-License-Identifier: Apache-2.0
#include "adaptor/memory/userdata_layout.h"

#include <gtest/gtest.h>

#include <vector>

namespace volcontact::adaptor::userdata_layout_test {
namespace {

// Integrates a constant rate as a law with one state would, through any order of evaluations.
class Integrator {
 public:
  Integrator() : numbers_(static_cast<std::size_t>(kLayout.size()), 0.0) {}

  double evaluate(double time, double rate, double step = 0.1) {
    const UserdataBlock block = this->block();
    block.claim();
    const double elapsed = open_slot(block, time, step);
    const double committed = block.count() > 1 ? block.slot(1).states()[0] : 0.0;
    return block.slot(0).states()[0] = committed + elapsed * rate;
  }
  UserdataBlock block() { return {numbers_.data() + numbers_.size(), kLayout}; }
  std::vector<double>& numbers() { return numbers_; }

  static constexpr UserdataLayout kLayout{1, 3, 0, 2, 4};

 private:
  std::vector<double> numbers_;
};

TEST(UserdataLayout, ZeroMeansNeverEvaluated) {
  Integrator state;
  EXPECT_FALSE(state.block().is_ours());
  state.block().claim();
  EXPECT_TRUE(state.block().is_ours());
  EXPECT_EQ(state.block().count(), 0);
  EXPECT_FALSE(state.block().ledger_is_valid());
}

TEST(UserdataLayout, BlockStaysInsideItsSize) {
  std::vector<double> numbers(static_cast<std::size_t>(Integrator::kLayout.size()) + 5, 7.0);
  const UserdataBlock block(numbers.data() + numbers.size(), Integrator::kLayout);
  block.claim();
  for (int i = 0; i < 10; ++i) {
    open_slot(block, 0.1 * i, 0.1);
    block.slot(0).set_energy({1.0, {1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 1}, 1.0, 1.0});
    std::fill_n(block.slot(0).forces(), 2, 1.0);
    block.slot(0).states()[0] = 1.0;
    std::fill_n(block.motion(), 4, 4.0);
    std::fill_n(block.base(), 3, 2.0);
    std::fill_n(block.left(), 3, 3.0);
  }
  for (int i = 0; i < 5; ++i) EXPECT_EQ(numbers[static_cast<std::size_t>(i)], 7.0);
  EXPECT_EQ(block.count(), UserdataLayout::kSlots);
  EXPECT_TRUE(block.is_ours());
}

TEST(UserdataLayout, SlotGivesBackWhatItWasGiven) {
  std::vector<double> numbers(static_cast<std::size_t>(Integrator::kLayout.size()), 0.0);
  const UserdataBlock block(numbers.data() + numbers.size(), Integrator::kLayout);
  block.claim();
  open_slot(block, 0.1, 0.1);
  const Slot slot = block.slot(0);
  EXPECT_EQ(slot.stage(), Stage::kWhole);
  slot.set_stage(Stage::kSecondMiddle);
  slot.set_energy({1.0,
                   {2, 3, 4, 5},
                   {6, 7, 8, 9},
                   {10, 11, 12, 13},
                   14.0,
                   15.0,
                   16.0,
                   true,
                   17.0,
                   18.0,
                   19.0,
                   23.0});
  slot.forces()[0] = 20.0;
  slot.forces()[1] = 21.0;
  slot.states()[0] = 22.0;
  const EnergyAccount e = slot.energy();
  EXPECT_EQ(slot.stage(), Stage::kSecondMiddle);
  EXPECT_EQ(slot.time(), 0.1);
  EXPECT_EQ(e.elastic, 1.0);
  EXPECT_EQ(e.dissipated.spin, 5.0);
  EXPECT_EQ(e.power.normal, 6.0);
  EXPECT_EQ(e.taken.slide, 12.0);
  EXPECT_EQ(e.slide_energy, 14.0);
  EXPECT_EQ(e.spin_energy, 15.0);
  EXPECT_EQ(e.stored, 16.0);
  EXPECT_TRUE(e.implicit);
  EXPECT_EQ(e.work, 17.0);
  EXPECT_EQ(e.numerical, 18.0);
  EXPECT_EQ(e.force_power, 19.0);
  EXPECT_EQ(e.last_power, 23.0);
  EXPECT_EQ(slot.forces()[0], 20.0);
  EXPECT_EQ(slot.forces()[1], 21.0);
  EXPECT_EQ(slot.states()[0], 22.0);
}

TEST(UserdataLayout, ConstantRateIsIntegratedExactly) {
  Integrator state;
  double value = 0.0;
  for (int i = 0; i <= 100; ++i) value = state.evaluate(0.1 * i, 2.0);
  EXPECT_NEAR(value, 20.0, 1e-12);
}

TEST(UserdataLayout, RepeatedEvaluationReplacesTheLast) {
  Integrator state;
  state.evaluate(0.0, 2.0);
  state.evaluate(0.1, 50.0);
  EXPECT_DOUBLE_EQ(state.evaluate(0.1, 2.0), 0.2);
  EXPECT_DOUBLE_EQ(state.evaluate(0.2, 2.0), 0.4);
}

TEST(UserdataLayout, RungeKuttaStagesEndWhereTheirStepDoes) {
  Integrator state;
  double value = 0.0;
  for (int i = 0; i <= 50; ++i) {
    const double t = 0.1 * i;
    for (const double stage : {t, t + 0.05, t + 0.05, t + 0.1}) {
      value = state.evaluate(stage, 2.0);
      EXPECT_NEAR(value, 2.0 * stage, 1e-12);
    }
  }
  EXPECT_NEAR(value, 10.2, 1e-12);
}

TEST(UserdataLayout, WholeRungeKuttaStepsCanBeRedone) {
  // As finite differences do: several trial steps from one time, then the real one.
  Integrator plain, with_trials;
  for (int i = 0; i <= 20; ++i) {
    const double t = 0.1 * i;
    for (int trial = 0; trial < 5; ++trial) {
      for (const double stage : {t, t + 0.05, t + 0.05, t + 0.1}) {
        with_trials.evaluate(stage, 100.0 + trial);
      }
    }
    for (const double stage : {t, t + 0.05, t + 0.05, t + 0.1}) {
      EXPECT_EQ(with_trials.evaluate(stage, 2.0), plain.evaluate(stage, 2.0));
    }
  }
}

TEST(UserdataLayout, JumpInTimeStartsAnew) {
  Integrator state;
  for (int i = 0; i <= 10; ++i) state.evaluate(0.1 * i, 2.0);
  EXPECT_EQ(state.evaluate(5.0, 2.0), 0.0);  // ahead
  EXPECT_NEAR(state.evaluate(5.1, 2.0), 0.2, 1e-14);
  EXPECT_EQ(state.evaluate(0.0, 2.0), 0.0);  // back
  EXPECT_DOUBLE_EQ(state.evaluate(0.1, 2.0), 0.2);
}

TEST(UserdataLayout, SmallerStepFromNowOnIsNoJump) {
  Integrator state;
  state.evaluate(0.0, 2.0, 0.1);
  EXPECT_DOUBLE_EQ(state.evaluate(0.1, 2.0, 0.001), 0.2);
  EXPECT_DOUBLE_EQ(state.evaluate(0.101, 2.0, 0.001), 0.202);
}

TEST(UserdataLayout, CopyContinuesAsTheOriginal) {
  Integrator state;
  for (int i = 0; i <= 10; ++i) state.evaluate(0.1 * i, 2.0);
  Integrator copy;
  copy.numbers() = state.numbers();
  EXPECT_EQ(copy.evaluate(1.1, 3.0), state.evaluate(1.1, 3.0));
}

TEST(UserdataLayout, OtherNumberOfStatesKeepsTheLedger) {
  std::vector<double> numbers(200, 0.0);
  double* end = numbers.data() + numbers.size();
  const UserdataBlock before(end, {1, 3});
  before.claim();
  open_slot(before, 1.0, 0.1);
  before.set_ledger_valid();
  before.base()[2] = 5.0;
  before.left()[2] = 6.0;
  const UserdataBlock after(end, {7, 3});
  after.claim();
  EXPECT_EQ(after.count(), 0);
  EXPECT_TRUE(after.ledger_is_valid());
  EXPECT_EQ(after.base()[2], 5.0);
  EXPECT_EQ(after.left()[2], 6.0);
}

}  // namespace
}  // namespace volcontact::adaptor::userdata_layout_test
