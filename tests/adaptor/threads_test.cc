// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstring>
#include <thread>

#include "adaptor/support/models.h"

// Many threads step their own data of one model. ./run threads runs these under the thread
// sanitizer.

namespace volcontact::adaptor::threads_test {
namespace {

using testing::ModelPointer;

constexpr int kThreads = 8;
constexpr int kSteps = 10000;

// A box that is pushed over a floor and against a wall, with bristles.
std::string pushed_box(const std::string& step, const std::string& stiffness) {
  return "<mujoco><option timestep=\"" + step +
         "\"/><worldbody><geom name=\"floor\" type=\"plane\" size=\"1 1 .1\"/>"
         "<geom name=\"wall\" type=\"box\" size=\".02 1 .2\" pos=\".2 0 .2\"/>"
         "<body pos=\"0 0 .052\" euler=\"3 2 1\"><freejoint/>"
         "<geom name=\"box\" type=\"box\" size=\".1 .08 .05\" mass=\"1\"/></body></worldbody>" +
         testing::material("steel",
                           {{"stiffness", stiffness},
                            {"damping", "1"},
                            {"friction", "0.2"},
                            {"static_friction", "0.3"},
                            {"friction_law/bristle", "1"}},
                           {"floor", "wall", "box"}) +
         "</mujoco>";
}

// All that a run leaves, pushed by a force of its own.
std::vector<double> run(const ModelPointer& m, int number) {
  const testing::DataPointer d = testing::make_data(m);
  d->qfrc_applied[0] = 1.0 + 0.5 * number;
  d->qfrc_applied[5] = 0.01 * number;
  for (int i = 0; i < kSteps; ++i) mj_step(m.get(), d.get());
  std::vector<double> left(d->qpos, d->qpos + m->nq);
  left.insert(left.end(), d->qvel, d->qvel + m->nv);
  left.insert(left.end(), d->qfrc_applied, d->qfrc_applied + m->nv);
  left.insert(left.end(), d->userdata, d->userdata + m->nuserdata);
  return left;
}

void expect_threads_equal_single_runs(const std::string& scene) {
  const ModelPointer m = testing::load(scene);
  const testing::Attached attached(m);
  std::vector<std::vector<double>> left(kThreads);
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i) {
    threads.emplace_back([&, i] { left[static_cast<std::size_t>(i)] = run(m, i); });
  }
  for (std::thread& thread : threads) thread.join();
  for (int i = 0; i < kThreads; ++i) {
    const std::vector<double> alone = run(m, i), &one = left[static_cast<std::size_t>(i)];
    ASSERT_EQ(one.size(), alone.size());
    EXPECT_EQ(std::memcmp(one.data(), alone.data(), alone.size() * sizeof(double)), 0) << i;
  }
  EXPECT_NE(left[0], left[1]);
  // It lies on the floor: the upward force on it is there.
  EXPECT_GT(left[0][static_cast<std::size_t>(m->nq + m->nv) + 2], 1.0);
}

TEST(Threads, EightTimesTenThousandExplicitStepsEqualSingleRuns) {
  expect_threads_equal_single_runs(pushed_box("2e-4", "1e7"));
}

TEST(Threads, EightTimesTenThousandImplicitStepsEqualSingleRuns) {
  expect_threads_equal_single_runs(pushed_box("2e-3", "1e11"));
}

// One thread attaches and detaches other models while others step.
TEST(Threads, ScenesMayComeAndGoMeanwhile) {
  const ModelPointer m = testing::load(pushed_box("2e-4", "1e7"));
  const testing::Attached attached(m);
  const std::vector<double> alone = run(m, 1);
  std::vector<std::vector<double>> left(3);
  std::vector<std::thread> threads;
  for (auto& mine : left) threads.emplace_back([&] { mine = run(m, 1); });
  const ModelPointer other = testing::load(testing::ball_scene(0.049, ""));
  for (int i = 0; i < 50; ++i) {
    const testing::Attached meanwhile(other);
    const testing::DataPointer d = testing::make_data(other);
    mj_step(other.get(), d.get());
    EXPECT_GT(d->qfrc_applied[2], 0.0);
  }
  for (std::thread& thread : threads) thread.join();
  for (const auto& one : left) EXPECT_EQ(one, alone);
}

}  // namespace
}  // namespace volcontact::adaptor::threads_test
