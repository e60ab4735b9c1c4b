// SPDX-License-Identifier: Apache-2.0
#include "adaptor/support/count_allocations.h"
#include "c_api/support.h"

namespace volcontact::c_api::testing::allocations_test {
namespace {

TEST(CAllocations, WarmEvaluationAllocatesNothing) {
  const Model model = model_of(solid("box", "half_sizes", {0.1, 0.08, 0.05}),
                               solid("box", "half_sizes", {0.5, 0.5, 0.05}));
  ASSERT_EQ(vc_model_choose(model.get(), "friction_law", "bristle"), 0);
  const Workspace scratch = workspace();
  std::vector<double> state(static_cast<std::size_t>(vc_model_state_size(model.get(), 4)));
  vc_result result;
  vc_site sites[4];
  const auto evaluate = [&](double x) {
    const vc_motion motion = at(x, 0, 0.099);
    return vc_evaluate(model.get(), scratch.get(), &motion, state.data(), state.data(),
                       static_cast<int>(state.size()), 1e-3, &result);
  };
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(evaluate(1e-5 * i), 0) << vc_error();
  }
  const adaptor::testing::AllocationCounter counter;
  const long before = adaptor::testing::AllocationCounter::total();
  for (int i = 3; i < 20; ++i) {
    evaluate(1e-5 * i);
    vc_sites(scratch.get(), sites, 4);
  }
  EXPECT_EQ(adaptor::testing::AllocationCounter::total(), before);
  workspace();  // the counter does count
  EXPECT_GT(adaptor::testing::AllocationCounter::total(), before);
}

// A host in real time warms its workspace before the run, at a pose of deep overlap.
TEST(CAllocations, WorkspaceWarmedByAnOverlapIsWarmAtTheFirstTouch) {
  const double half_length = 0.1;
  const Solid cylinder = solid("cylinder", "radius", {0.1});
  ASSERT_EQ(vc_solid_set(cylinder.get(), "half_length", &half_length, 1), 0);
  const Model model = model_of(cylinder, solid("box", "half_sizes", {0.5, 0.5, 0.05}));
  ASSERT_EQ(vc_model_choose(model.get(), "friction_law", "elastic_coulomb"), 0);
  const Workspace scratch = workspace();
  std::vector<double> state(static_cast<std::size_t>(vc_model_state_size(model.get(), 4)));
  const int size = static_cast<int>(state.size());
  vc_result result;
  const auto evaluate = [&](double z, double turn) {
    const vc_motion motion = at(0.0, 0.0, z, turn);
    return vc_evaluate(model.get(), scratch.get(), &motion, state.data(), state.data(), size, 1e-3,
                       &result);
  };
  ASSERT_EQ(evaluate(0.1, 0.0), 0) << vc_error();
  ASSERT_EQ(evaluate(0.1, 0.1), 0) << vc_error();
  ASSERT_GT(result.metrics.volume, 0.0);
  std::fill(state.begin(), state.end(), 0.0);
  const adaptor::testing::AllocationCounter counter;
  const long before = adaptor::testing::AllocationCounter::total();
  const int apart = evaluate(1.0, 0.0), sites_apart = result.sites, touch = evaluate(0.149, 0.2);
  EXPECT_EQ(adaptor::testing::AllocationCounter::total(), before);
  EXPECT_EQ(apart, 0);
  EXPECT_EQ(sites_apart, 0);
  EXPECT_EQ(touch, 0);
  EXPECT_EQ(result.sites, 1);
}

// What implicit solvers and solvers that integrate the states call as well.
TEST(CAllocations, WarmTangentAndRatesAllocateNothing) {
  const Model model = model_of(solid("box", "half_sizes", {0.1, 0.08, 0.05}),
                               solid("box", "half_sizes", {0.5, 0.5, 0.05}));
  ASSERT_EQ(vc_model_choose(model.get(), "friction_law", "bristle"), 0);
  const Workspace scratch = workspace();
  std::vector<double> state(static_cast<std::size_t>(vc_model_state_size(model.get(), 4)));
  std::vector<double> next = state, rates = state;
  const int size = static_cast<int>(state.size());
  vc_result result;
  vc_tangent tangent;
  const auto evaluate = [&](double x) {
    const vc_motion motion = at(x, 0, 0.099);
    const int code = vc_evaluate_rates(model.get(), scratch.get(), &motion, state.data(),
                                       next.data(), rates.data(), size, &result);
    return code != 0 ? code : vc_tangent_of(model.get(), scratch.get(), &tangent);
  };
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(evaluate(1e-5 * i), 0) << vc_error();
  }
  const adaptor::testing::AllocationCounter counter;
  const long before = adaptor::testing::AllocationCounter::total();
  for (int i = 3; i < 20; ++i) evaluate(1e-5 * i);
  EXPECT_EQ(adaptor::testing::AllocationCounter::total(), before);
}

}  // namespace
}  // namespace volcontact::c_api::testing::allocations_test
