// SPDX-License-Identifier: Apache-2.0
// A step without memory is an error, and the data are those before it: the next step goes on as if
// nothing had been.
#include <gtest/gtest.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <thread>

#include "adaptor/support/fail_allocations.h"
#include "adaptor/support/models.h"

namespace volcontact::adaptor::out_of_memory_test {
namespace {

using test::AllocationLimit;
using testing::DataPointer;
using testing::ModelPointer;

constexpr int kStepsBefore = 5, kStepsAfter = 20;
constexpr long kMost = 20000;  // allocations of a first step
// MuJoCo 2 normalizes quaternions in place when a step begins, another time where one has failed.
constexpr double kNormalized = mjVERSION_HEADER < 300 ? 1e-12 : 0.0;

// Boxes on a floor, a ball in a mesh of a cup's stead, tiles that are one solid, a stiff pair.
std::string scene(const std::string& integrator, const std::string& stiffness) {
  return "<mujoco><option timestep=\"1e-3\" integrator=\"" + integrator +
         "\"/><asset><mesh name=\"wedge\" vertex=\"0 0 0  .2 0 0  0 .2 0  0 0 .2\"/></asset>"
         "<worldbody><geom name=\"floor\" type=\"plane\" size=\"1 1 .1\"/>"
         "<geom name=\"left\" type=\"box\" size=\".2 .2 .05\" pos=\".4 0 .05\"/>"
         "<geom name=\"right\" type=\"box\" size=\".2 .2 .05\" pos=\".8 0 .05\"/>"
         "<body pos=\"0 0 .0499\" euler=\"3 2 1\"><freejoint/>"
         "<geom name=\"crate\" type=\"box\" size=\".1 .08 .05\" mass=\"1\"/></body>"
         "<body pos=\".6 0 .1495\"><freejoint/>"
         "<geom name=\"can\" type=\"cylinder\" size=\".08 .05\" mass=\"1\"/></body>"
         "<body pos=\"-.4 0 -.001\"><freejoint/>"
         "<geom name=\"heap\" type=\"mesh\" mesh=\"wedge\" mass=\"1\"/></body></worldbody>" +
         testing::material("steel",
                           {{"stiffness", stiffness}, {"damping", "1"}, {"friction", "0.3"}},
                           {"floor", "left", "right", "crate", "can", "heap"}) +
         "</mujoco>";
}

struct State {
  std::vector<double> numbers;
  State(const mjModel* m, const mjData* d) {
    numbers.assign(d->qpos, d->qpos + m->nq);
    numbers.insert(numbers.end(), d->qvel, d->qvel + m->nv);
    numbers.insert(numbers.end(), d->qfrc_applied, d->qfrc_applied + m->nv);
    numbers.push_back(d->time);
  }
  bool operator==(const State& other) const {
    return std::memcmp(numbers.data(), other.numbers.data(), numbers.size() * sizeof(double)) == 0;
  }
};

thread_local std::jmp_buf way_out;
thread_local char told[1000];
void on_error(const char* text) {
  std::snprintf(told, sizeof told, "%s", text);
  std::longjmp(way_out, 1);
}

// Nothing with a destructor lives here. False where MuJoCo was told of an error.
bool steps(const mjModel* m, mjData* d) {
  if (setjmp(way_out) != 0) return false;
  mj_step(m, d);
  return true;
}

// One step by a thread that has never evaluated anything, with `left` allocations. Whether it was
// made, and whether one was refused.
struct Outcome {
  bool made = false, reached = false;
};
Outcome cold_step(const mjModel* m, mjData* d, long left) {
  Outcome outcome;
  std::thread([&] {
    const AllocationLimit limit(left);
    outcome.made = steps(m, d);
    outcome.reached = limit.was_reached();
  }).join();
  return outcome;
}

// `nearly`: how far what follows may be from the same without a failure; 0 is to the bit.
void expect_unharmed(const std::string& mjcf, double nearly = 0.0) {
  const ModelPointer m = testing::load(mjcf);
  nearly = std::max(nearly, 1e3 * kNormalized);
  const auto before = std::exchange(mju_user_error, &on_error);
  const auto begin = [&](const DataPointer& d) {
    for (int i = 0; i < kStepsBefore; ++i) mj_step(m.get(), d.get());
  };
  std::vector<double> expected;
  {
    const testing::Attached attached(m);
    const DataPointer d = testing::make_data(m);
    begin(d);
    ASSERT_TRUE(cold_step(m.get(), d.get(), kMost).made);
    for (int i = 0; i < kStepsAfter; ++i) mj_step(m.get(), d.get());
    expected = State(m.get(), d.get()).numbers;
  }
  long failed = 0;
  for (bool reached = true; reached && !::testing::Test::HasFailure(); ++failed) {
    ASSERT_LT(failed, kMost);
    const testing::Attached attached(m);  // its pairs are made anew
    const DataPointer d = testing::make_data(m);
    begin(d);
    const State there(m.get(), d.get());
    told[0] = '\0';
    const Outcome outcome = cold_step(m.get(), d.get(), failed);
    reached = outcome.reached;
    ASSERT_EQ(outcome.made, !reached) << "after " << failed << " allocations";
    if (reached) {
      const State here(m.get(), d.get());
      for (std::size_t i = 0; i < here.numbers.size(); ++i) {
        EXPECT_NEAR(here.numbers[i], there.numbers[i], kNormalized)
            << "number " << i << " after " << failed << " allocations";
      }
      mj_step(m.get(), d.get());
    }
    for (int i = 0; i < kStepsAfter; ++i) mj_step(m.get(), d.get());
    const std::vector<double> now = State(m.get(), d.get()).numbers;
    if (nearly == 0.0) {
      EXPECT_EQ(now, expected) << "after " << failed << " allocations";
    } else {
      for (int i = 0; i < m->nq; ++i) {
        const auto k = static_cast<std::size_t>(i);
        EXPECT_NEAR(now[k], expected[k], nearly) << "after " << failed << " allocations";
      }
    }
  }
  EXPECT_GT(failed, 10);
  mju_user_error = before;
}

TEST(OutOfMemory, EveryAllocationOfAnExplicitStepMayFail) {
  expect_unharmed(scene("Euler", "1e6"));
}

TEST(OutOfMemory, EveryAllocationOfAnImplicitStepMayFail) {
  expect_unharmed(scene("implicit", "1e11"));
}

// The first stage is the cold one. It takes the place of the last stage of the step before, whose
// account is then gone: what a pair may give back is told anew.
TEST(OutOfMemory, EveryAllocationOfAStepOfRungeKuttaMayFail) {
  expect_unharmed(scene("RK4", "1e6"), 1e-4);
}

TEST(OutOfMemory, TheMessageSaysWhatToDo) {
  const ModelPointer m = testing::load(scene("Euler", "1e6"));
  const testing::Attached attached(m);
  const DataPointer d = testing::make_data(m);
  const auto before = std::exchange(mju_user_error, &on_error);
  std::string message;
  std::thread([&] {
    {
      const AllocationLimit limit(0);
      EXPECT_FALSE(steps(m.get(), d.get()));
    }
    message = told;
  }).join();
  mju_user_error = before;
  EXPECT_EQ(message,
            "volcontact: out of memory in an evaluation of the contacts; the state is that before "
            "the step (free memory, then step again)");
}

// The functions of the C interface return it.
TEST(OutOfMemory, FunctionsReturnIt) {
  const ModelPointer m = testing::load(scene("Euler", "1e6"));
  const testing::Attached attached(m);
  const DataPointer d = testing::make_data(m);
  mj_step(m.get(), d.get());
  const State there(m.get(), d.get());
  std::thread([&] {
    volcontact_watch watch{};
    watch.force_limit = watch.torque_limit = mjMAXVAL;
    int sites = 0, stepped = 0;
    {
      const AllocationLimit limit(0);
      sites = volcontact_sites(m.get(), d.get(), nullptr, 0);
      stepped = volcontact_step_watched(m.get(), d.get(), 3, &watch);
    }
    EXPECT_EQ(sites, VOLCONTACT_ERROR_MEMORY);
    EXPECT_EQ(stepped, VOLCONTACT_ERROR_MEMORY);
    EXPECT_TRUE(State(m.get(), d.get()) == there);
    EXPECT_EQ(volcontact_step_watched(m.get(), d.get(), 3, &watch), 3);
  }).join();
}

}  // namespace
}  // namespace volcontact::adaptor::out_of_memory_test
