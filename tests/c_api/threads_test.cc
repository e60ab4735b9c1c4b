// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <thread>

#include "c_api/support.h"

namespace volcontact::c_api::testing::threads_test {
namespace {

// A leaning box that slides and turns on another; what it feels after `steps` steps.
std::vector<double> course(const vc_model* model, double start, int steps) {
  const Workspace scratch = workspace();
  const int size = vc_model_state_size(model, 4);
  std::vector<double> state(static_cast<std::size_t>(size)), forces;
  for (int i = 0; i < steps; ++i) {
    const double time = 1e-3 * i;
    vc_motion motion = at(start + 0.05 * time, 0.01, 0.0995 + 2e-4 * std::sin(40.0 * time), time);
    motion.V_WA[2] = 1.0;
    motion.V_WA[3] = 0.05;
    motion.V_WA[5] = 8e-3 * std::cos(40.0 * time);
    vc_result result;
    EXPECT_EQ(
        vc_evaluate(model, scratch.get(), &motion, state.data(), state.data(), size, 1e-3, &result),
        0)
        << vc_error();
    forces.insert(forces.end(), result.force_on_a, result.force_on_a + 3);
    forces.insert(forces.end(), result.torque_on_a, result.torque_on_a + 3);
  }
  return forces;
}

TEST(CThreads, EightThreadsOnOneModelGiveTheBitsOfOne) {
  const Model model = model_of(solid("box", "half_sizes", {0.1, 0.08, 0.05}),
                               solid("box", "half_sizes", {0.5, 0.5, 0.05}));
  ASSERT_EQ(vc_model_choose(model.get(), "friction_law", "bristle"), 0);
  constexpr int kThreads = 8, kSteps = 2000;
  std::vector<std::vector<double>> forces(kThreads);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < kThreads; ++i) {
    threads.emplace_back([&, i] { forces[i] = course(model.get(), 0.01 * (i % 2), kSteps); });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < kThreads; ++i) {
    const std::vector<double> alone =
        i < 2 ? course(model.get(), 0.01 * (i % 2), kSteps) : forces[i % 2];
    EXPECT_EQ(std::memcmp(forces[i].data(), alone.data(), alone.size() * sizeof(double)), 0) << i;
  }
  EXPECT_NE(forces[0], forces[1]);
}

}  // namespace
}  // namespace volcontact::c_api::testing::threads_test
