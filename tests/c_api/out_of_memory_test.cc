// SPDX-License-Identifier: Apache-2.0
#include "adaptor/support/fail_allocations.h"
#include "c_api/support.h"

namespace volcontact::c_api::testing::out_of_memory_test {
namespace {

using test::AllocationLimit;

// A cold evaluation with memory for so many pieces, then one with all: the same as if nothing had
// been, and the caller's state untouched until then.
TEST(COutOfMemory, EveryAllocationOfAColdEvaluationMayFail) {
  const double half_length = 0.1;
  const Solid cylinder = solid("cylinder", "radius", {0.1});
  ASSERT_EQ(vc_solid_set(cylinder.get(), "half_length", &half_length, 1), 0);
  const Model model = model_of(cylinder, solid("box", "half_sizes", {0.5, 0.5, 0.05}));
  ASSERT_EQ(vc_model_choose(model.get(), "friction_law", "bristle"), 0);
  const std::vector<double> begin(static_cast<std::size_t>(vc_model_state_size(model.get(), 4)));
  const int size = static_cast<int>(begin.size());
  const vc_motion motion = at(0.0, 0.0, 0.14, 0.3);
  const auto evaluate = [&](const Workspace& scratch, std::vector<double>& state,
                            vc_result& result) {
    return vc_evaluate(model.get(), scratch.get(), &motion, begin.data(), state.data(), size, 1e-3,
                       &result);
  };
  vc_result expected;
  std::vector<double> left = begin;
  ASSERT_EQ(evaluate(workspace(), left, expected), 0) << vc_error();
  ASSERT_GT(expected.metrics.volume, 0.0);
  long failed = 0;
  for (bool reached = true; reached; ++failed) {
    ASSERT_LT(failed, 10000);
    const Workspace scratch = workspace();
    std::vector<double> state = begin;
    vc_result result;
    int code = 0;
    {
      const AllocationLimit limit(failed);
      code = evaluate(scratch, state, result);
      reached = limit.was_reached();
    }
    ASSERT_EQ(code, reached ? VC_ERROR_MEMORY : 0) << "after " << failed << " allocations";
    if (reached) {
      EXPECT_STREQ(vc_error(), "out of memory");
      EXPECT_EQ(state, begin) << "after " << failed << " allocations";
    }
    ASSERT_EQ(evaluate(scratch, state, result), 0);
    EXPECT_EQ(result.metrics.volume, expected.metrics.volume);
    EXPECT_EQ(state, left);
  }
  EXPECT_GT(failed, 1);
}

TEST(COutOfMemory, AWorkspaceIsNullWithoutMemory) {
  vc_workspace* scratch = nullptr;
  int code = 0;
  {
    const AllocationLimit limit(0);
    code = vc_workspace_create(&scratch);
  }
  EXPECT_EQ(code, VC_ERROR_MEMORY);
  EXPECT_EQ(scratch, nullptr);
  EXPECT_STREQ(vc_error(), "out of memory");
}

}  // namespace
}  // namespace volcontact::c_api::testing::out_of_memory_test
