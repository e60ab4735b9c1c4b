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

// A scene of a simulator has many contact models: other shapes and laws, all at once on threads.
TEST(CThreads, ManyModelsAtOnceGiveTheBitsOfEachAlone) {
  constexpr std::size_t kModels = 8;
  const char* laws[] = {"bristle", "elastic_coulomb", "regularized_coulomb", "none"};
  std::vector<Model> models;
  for (std::size_t i = 0; i < kModels; ++i) {
    models.push_back(model_of(solid("box", "half_sizes", {0.1, 0.08, 0.05}),
                              i % 2 ? solid("box", "half_sizes", {0.5, 0.5, 0.05})
                                    : solid("cylinder", "half_length", {0.05})));
    ASSERT_EQ(vc_model_choose(models[i].get(), "friction_law", laws[i % 4]), 0) << vc_error();
    ASSERT_EQ(set(models[i], "stiffness", 1e7 * static_cast<double>(1 + i)), 0);
  }
  std::vector<std::vector<double>> forces(kModels);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < kModels; ++i) {
    threads.emplace_back([&, i] { forces[i] = course(models[i].get(), 0.01, 500); });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < kModels; ++i) {
    EXPECT_EQ(course(models[i].get(), 0.01, 500), forces[i]) << i;
    EXPECT_NE(forces[i], forces[(i + 1) % kModels]);
  }
}

// A thread of a simulator may go through all its models with one workspace.
TEST(CThreads, ModelsMayTakeTurnsWithOneWorkspace) {
  const Model boxes = model_of(solid("box", "half_sizes", {0.1, 0.08, 0.05}),
                               solid("box", "half_sizes", {0.5, 0.5, 0.05}));
  const Model ball = model_of(solid("sphere", "radius", {0.1}), solid("half_space"));
  const Workspace shared = workspace();
  vc_result turns[2], alone[2];
  for (int i = 0; i < 20; ++i) {
    const vc_motion motion = at(1e-3 * i, 0.01, 0.0995 - 1e-5 * i, 0.05 * i);
    int k = 0;
    for (const vc_model* model : {boxes.get(), ball.get()}) {
      ASSERT_EQ(vc_evaluate(model, shared.get(), &motion, nullptr, nullptr, 0, 0.0, &turns[k]), 0);
      ASSERT_EQ(vc_evaluate(model, workspace().get(), &motion, nullptr, nullptr, 0, 0.0, &alone[k]),
                0);
      EXPECT_EQ(std::memcmp(&turns[k], &alone[k], sizeof(vc_result)), 0) << i;
      ++k;
    }
  }
  EXPECT_GT(turns[0].force_on_a[2], 0.0);
  EXPECT_GT(turns[1].force_on_a[2], 0.0);
}

}  // namespace
}  // namespace volcontact::c_api::testing::threads_test
