// SPDX-License-Identifier: Apache-2.0
#include "adaptor/run/scene_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <thread>

#include "adaptor/run/mujoco_messages.h"
#include "adaptor/support/models.h"

namespace volcontact::adaptor::scene_run_test {
namespace {

// A ball 1 mm deep in the floor: V = pi d^2 (3 r - d)/3.
constexpr double kVolume = 3.14159265358979323846 * 1e-6 * (0.15 - 1e-3) / 3.0;

class SceneRunTest : public ::testing::Test {
 protected:
  SceneRunTest()
      : m_(testing::load(testing::ball_scene(0.049, ""))),
        path_(::testing::TempDir() + "scene_run_" + std::to_string(getpid()) + ".mjb") {
    mj_saveModel(m_.get(), path_.c_str(), nullptr, 0);
    run_ = std::make_unique<SceneRun>(path_.c_str(), nullptr, 0);
  }
  ~SceneRunTest() override { unlink(path_.c_str()); }

  double get(SceneValue value, int index = 0) {
    double numbers[7];
    run_->get(value, index, numbers);
    return numbers[0];
  }

  testing::ModelPointer m_;
  std::string path_;
  std::unique_ptr<SceneRun> run_;
};

TEST_F(SceneRunTest, SeesTheVolumeOfTheCapOfAllAndOfAPair) {
  const int pair = run_->add_pair({1}, {0}), none = run_->add_pair({1}, {1});
  EXPECT_EQ(pair, 1);
  for (const int index : {0, pair}) {
    EXPECT_NEAR(get(SceneValue::kPairVolume, index), kVolume, 1e-9 * kVolume);
    EXPECT_EQ(get(SceneValue::kPairSites, index), 1.0);
  }
  double up[3], down[3];
  run_->get(SceneValue::kPairForce, pair, up);
  run_->get(SceneValue::kPairForce, run_->add_pair({0}, {1}), down);
  EXPECT_GT(up[2], 0.0);
  EXPECT_EQ(up[2], -down[2]);
  EXPECT_EQ(get(SceneValue::kPairTouching, none), 0.0);
  EXPECT_THROW(run_->add_pair({99}, {0}), std::invalid_argument);
}

TEST_F(SceneRunTest, StepsWithTheBitsOfMjStepWhateverIsRead) {
  const testing::Attached attached(m_);
  const testing::DataPointer d = testing::make_data(m_);
  for (int i = 0; i < 30; ++i) {
    mj_step(m_.get(), d.get());
    EXPECT_EQ(run_->step(), 1);
    get(SceneValue::kPairNormalForce);  // an evaluation between the steps
    double position[7];
    run_->get(SceneValue::kJointPosition, 0, position);
    ASSERT_EQ(position[2], d->qpos[2]) << i;
  }
  EXPECT_EQ(run_->time(), d->time);
}

TEST_F(SceneRunTest, GoesOnFromAStateToTheBit) {
  for (int i = 0; i < 5; ++i) run_->step();
  std::vector<double> state(static_cast<std::size_t>(run_->state_size()));
  run_->get_state(state.data());
  const auto later = [this] {
    for (int i = 0; i < 5; ++i) run_->step();
    double energies[4];
    run_->get(SceneValue::kContactDissipated, 0, energies);
    double position[7];
    run_->get(SceneValue::kJointPosition, 0, position);
    return std::pair(position[2], energies[0]);
  };
  const auto straight = later();
  run_->set_state(state.data());
  EXPECT_EQ(later(), straight);
  run_->reset();
  EXPECT_EQ(run_->time(), 0.0);
}

TEST_F(SceneRunTest, ComeAndGoOnThreadsWithTheSameBits) {
  const auto run = [this](std::vector<double>& out) {
    for (int again = 0; again < 10; ++again) {
      SceneRun one(path_.c_str(), nullptr, 0);
      for (int i = 0; i < 20; ++i) EXPECT_EQ(one.step(), 1);
      double position[7];
      one.get(SceneValue::kJointPosition, 0, position);
      out.push_back(position[2]);
    }
  };
  run_.reset();
  std::vector<std::vector<double>> got(4);
  std::vector<std::thread> threads;
  for (auto& out : got) threads.emplace_back([&] { run(out); });
  for (std::thread& thread : threads) thread.join();
  for (const auto& out : got) EXPECT_EQ(out, std::vector<double>(10, got[0][0]));
}

TEST_F(SceneRunTest, KnowsWhatThereIs) {
  EXPECT_EQ(run_->count(SceneValue::kJointPosition, 0), 7);
  EXPECT_EQ(run_->count(SceneValue::kJointVelocity, 0), 6);
  EXPECT_EQ(run_->count(SceneValue::kCtrl, 0), -1);
  EXPECT_EQ(run_->count(SceneValue::kMocapPosition, 1), -1);
  const double force[] = {0.0, 0.0, 1.0}, step = 0.0;
  EXPECT_THROW(run_->set(SceneValue::kAppliedForce, 99, force), std::invalid_argument);
  EXPECT_THROW(run_->set(SceneValue::kTimestep, 0, &step), RefusedValue);
}

TEST_F(SceneRunTest, TellsOfARunThatDivergesAndGoesOnAfterAReset) {
  const double force[] = {0.0, 0.0, 1e300};
  run_->set(SceneValue::kAppliedForce, 1, force);
  EXPECT_THROW(
      {
        run_->step();
        run_->step();
      },
      std::runtime_error);
  EXPECT_NE(MujocoMessages::take_warnings(), "");
  run_->reset();
  EXPECT_EQ(run_->step(), 1);
}

TEST(MujocoMessages, AnErrorOfMujocoIsAValueAndAnotherThreadsStayWhatTheyWere) {
  MujocoMessages::install();
  EXPECT_FALSE(MujocoMessages::run([] { mju_error("on fire"); }));
  EXPECT_STREQ(MujocoMessages::error(), "on fire");
  EXPECT_TRUE(MujocoMessages::run([] { mju_warning("hot"); }));
  EXPECT_EQ(MujocoMessages::take_warnings(), "hot");
  EXPECT_EQ(MujocoMessages::take_warnings(), "");
}

TEST(SceneRunFile, ThatIsNoModelIsTold) {
  EXPECT_THROW(SceneRun("/no/such/file.mjb", nullptr, 0), std::exception);
}

}  // namespace
}  // namespace volcontact::adaptor::scene_run_test
