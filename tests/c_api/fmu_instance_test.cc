// SPDX-License-Identifier: Apache-2.0
// The life of instances: values, states to come back to, derivatives, wrong use.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "c_api/fmu_functions.h"
#include "core/support/sanitized.h"

namespace volcontact::c_api::testing::fmu_instance_test {
namespace {

// Value references of tests/c_api/fmu_ball/unit.txt.
constexpr unsigned kPosition = 0, kQuaternion = 3, kAngular = 7, kVelocity = 10, kForce = 13,
                   kVolume = 25, kElastic = 30, kDissipated = 35, kState = 59, kRate = 64,
                   kFriction = 75, kStiffness = 71, kInternalStep = 84;
constexpr std::size_t kStates = 9;
constexpr double kPi = 3.14159265358979323846;

thread_local std::string last_message;
void log2(void*, const char*, int, const char*, const char* format, ...) {
  EXPECT_EQ(std::strchr(format, '%'), nullptr);  // a text without arguments
  last_message = format;
}
const Callbacks kCallbacks{&log2, nullptr, nullptr, nullptr, nullptr};
void log3(void*, int, const char*, const char* message) { last_message = message; }

struct Free2 {
  void operator()(void* c) const { fmi2FreeInstance(c); }
};
struct Free3 {
  void operator()(void* c) const { fmi3FreeInstance(c); }
};
using Two = std::unique_ptr<void, Free2>;
using Three = std::unique_ptr<void, Free3>;

Two two(int kind) {
  return Two(fmi2Instantiate("test", kind, "ball", "file://" FMU_RESOURCES, &kCallbacks, 0, 0));
}

Two started(int kind) {
  Two c = two(kind);
  EXPECT_TRUE(c) << last_message;
  EXPECT_EQ(fmi2SetupExperiment(c.get(), 0, 0.0, 0.0, 0, 0.0), 0);
  EXPECT_EQ(fmi2EnterInitializationMode(c.get()), 0);
  EXPECT_EQ(fmi2ExitInitializationMode(c.get()), 0);
  if (kind == 1) return c;
  EventInfo info;
  EXPECT_EQ(fmi2NewDiscreteStates(c.get(), &info), 0) << last_message;
  EXPECT_EQ(fmi2EnterContinuousTimeMode(c.get()), 0);
  return c;
}

double get(const Two& c, unsigned reference) {
  double value = NAN;
  EXPECT_EQ(fmi2GetReal(c.get(), &reference, 1, &value), 0) << last_message;
  return value;
}
int set(const Two& c, unsigned reference, double value) {
  return fmi2SetReal(c.get(), &reference, 1, &value);
}
bool said(const char* part) { return last_message.find(part) != std::string::npos; }

// Some steps of a ball that slides in the floor.
std::vector<double> slide(const Two& c, double from, int steps) {
  std::vector<double> out;
  for (int i = 0; i < steps; ++i) {
    const double time = from + 1e-3 * i;
    EXPECT_EQ(set(c, kPosition, 0.02 * time), 0);
    EXPECT_EQ(set(c, kVelocity, 0.02), 0);
    EXPECT_EQ(fmi2DoStep(c.get(), time, 1e-3, 1), 0) << last_message;
    for (unsigned r = kForce; r < 64; ++r) {
      const bool real = r != 27 && r != 28 && r != 29 && r != 39;
      if (real) out.push_back(get(c, r));
    }
  }
  return out;
}

TEST(FmuInstance, GivesTheForceOfTheCap) {
  const double depth = 1e-4, volume = kPi * depth * depth * (0.15 - depth) / 3.0;
  for (const int kind : {0, 1}) {
    const Two c = started(kind);
    EXPECT_NEAR(get(c, kVolume), volume, 1e-12 * volume);
    EXPECT_NEAR(get(c, kForce + 2), 1e8 * volume, 1e-10);
    EXPECT_EQ(get(c, kForce + 2), -get(c, kForce + 8));  // on the world
  }
}

TEST(FmuInstance, ContinuesFromASavedStateToTheBit) {
  const Two c = started(1);
  slide(c, 0.0, 5);
  void* state = nullptr;
  ASSERT_EQ(fmi2GetFMUstate(c.get(), &state), 0);
  std::size_t size = 0;
  ASSERT_EQ(fmi2SerializedFMUstateSize(c.get(), state, &size), 0);
  std::vector<char> bytes(size);
  ASSERT_EQ(fmi2SerializeFMUstate(c.get(), state, bytes.data(), size), 0);
  const std::vector<double> straight = slide(c, 5e-3, 10);
  ASSERT_EQ(fmi2SetFMUstate(c.get(), state), 0);
  EXPECT_EQ(slide(c, 5e-3, 10), straight);
  ASSERT_EQ(fmi2FreeFMUstate(c.get(), &state), 0);
  EXPECT_EQ(state, nullptr);

  const Two other = started(1);  // another instance, from bytes
  ASSERT_EQ(fmi2DeSerializeFMUstate(other.get(), bytes.data(), size, &state), 0) << last_message;
  ASSERT_EQ(fmi2SetFMUstate(other.get(), state), 0);
  EXPECT_EQ(slide(other, 5e-3, 10), straight);
  EXPECT_GT(std::abs(straight[0]), 1e-3);  // friction
  fmi2FreeFMUstate(other.get(), &state);
  bytes[0] ^= 1;
  EXPECT_EQ(fmi2DeSerializeFMUstate(other.get(), bytes.data(), size, &state), 3);
  EXPECT_TRUE(said("not a state of this unit"));
}

// Those that may change in a run, and one that says how much the laws keep.
TEST(FmuInstance, AStateBringsItsParameters) {
  constexpr unsigned kDamping = 72, kRestitution = 73;
  const Two c = two(1);
  EXPECT_EQ(set(c, kRestitution, 0.5), 2);  // beside damping
  EXPECT_TRUE(said("exclude each other"));
  ASSERT_EQ(set(c, kDamping, 0.0), 0) << last_message;
  ASSERT_EQ(set(c, kRestitution, 0.5), 0) << last_message;
  ASSERT_EQ(fmi2SetupExperiment(c.get(), 0, 0.0, 0.0, 0, 0.0), 0);
  ASSERT_EQ(fmi2EnterInitializationMode(c.get()), 0);
  ASSERT_EQ(fmi2ExitInitializationMode(c.get()), 0);
  slide(c, 0.0, 3);
  void* state = nullptr;
  ASSERT_EQ(fmi2GetFMUstate(c.get(), &state), 0);
  std::size_t size = 0;
  ASSERT_EQ(fmi2SerializedFMUstateSize(c.get(), state, &size), 0);
  std::vector<char> bytes(size);
  ASSERT_EQ(fmi2SerializeFMUstate(c.get(), state, bytes.data(), size), 0);
  const std::vector<double> straight = slide(c, 3e-3, 5);
  ASSERT_EQ(set(c, kStiffness, 3e8), 0) << last_message;
  ASSERT_EQ(fmi2SetFMUstate(c.get(), state), 0);
  EXPECT_EQ(get(c, kStiffness), 1e8);
  EXPECT_EQ(slide(c, 3e-3, 5), straight);
  fmi2FreeFMUstate(c.get(), &state);

  const Two other = started(1);  // with damping
  void* before = nullptr;
  ASSERT_EQ(fmi2GetFMUstate(other.get(), &before), 0);
  const std::vector<double> damped = slide(other, 0.0, 8);
  ASSERT_EQ(fmi2DeSerializeFMUstate(other.get(), bytes.data(), size, &state), 0) << last_message;
  ASSERT_EQ(fmi2SetFMUstate(other.get(), state), 0) << last_message;
  EXPECT_EQ(get(other, kRestitution), 0.5);
  EXPECT_EQ(slide(other, 3e-3, 5), straight);
  fmi2FreeFMUstate(other.get(), &state);
  ASSERT_EQ(fmi2SetFMUstate(other.get(), before), 0) << last_message;
  EXPECT_EQ(get(other, kDamping), 0.5);
  EXPECT_EQ(slide(other, 0.0, 8), damped);
  fmi2FreeFMUstate(other.get(), &before);
}

TEST(FmuInstance, PartsOfAStepGiveTheSameLawsAsSteps) {
  const Two parts = started(1), whole = started(1);
  ASSERT_EQ(set(parts, kInternalStep, 2.5e-4), 0) << last_message;
  slide(parts, 0.0, 20);
  slide(whole, 0.0, 20);
  EXPECT_NEAR(get(parts, kForce), get(whole, kForce), 2e-3 * std::abs(get(whole, kForce)));
  EXPECT_GT(get(parts, kDissipated + 2), 0.0);
}

// d(wrench)/d(motion) against differences of the FMU itself.
TEST(FmuInstance, DirectionalDerivativesAreThoseOfDifferences) {
  const Two c = started(0);
  ASSERT_EQ(set(c, kVelocity, 1e-3), 0);
  ASSERT_EQ(set(c, kVelocity + 2, -0.02), 0);
  std::vector<double> x(kStates, 0.0);
  x[4] = 2e-6, x[7] = 1e-7, x[8] = 0.5;
  ASSERT_EQ(fmi2SetContinuousStates(c.get(), x.data(), kStates), 0);
  const unsigned unknowns[] = {kForce, kForce + 1, kForce + 2, kRate, kElastic};
  const auto values = [&] {
    std::vector<double> v(std::size(unknowns));
    EXPECT_EQ(fmi2GetReal(c.get(), unknowns, v.size(), v.data()), 0);
    return v;
  };
  for (const unsigned known : {kPosition + 2, kVelocity, kVelocity + 2, kAngular + 1, kState}) {
    const double seed = 1.0, by = known == kState ? 1e-9 : 1e-7, here = get(c, known);
    std::vector<double> got(std::size(unknowns));
    ASSERT_EQ(
        fmi2GetDirectionalDerivative(c.get(), unknowns, got.size(), &known, 1, &seed, got.data()),
        0)
        << last_message;
    std::vector<double> ends[2];
    for (const int side : {0, 1}) {
      if (known == kState) {
        x[4] = here + (side ? by : -by);
        ASSERT_EQ(fmi2SetContinuousStates(c.get(), x.data(), kStates), 0);
      } else {
        ASSERT_EQ(set(c, known, here + (side ? by : -by)), 0);
      }
      ends[side] = values();
    }
    if (known == kState) {
      x[4] = here;
      ASSERT_EQ(fmi2SetContinuousStates(c.get(), x.data(), kStates), 0);
    } else {
      ASSERT_EQ(set(c, known, here), 0);
    }
    double scale = 0.0;
    for (std::size_t i = 0; i < 3; ++i) scale = std::max(scale, std::abs(ends[1][i] - ends[0][i]));
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(got[i], (ends[1][i] - ends[0][i]) / (2 * by), 0.02 * scale / (2 * by))
          << known << ' ' << i;
    }
    for (std::size_t i = 3; i < got.size(); ++i) {
      const double wanted = (ends[1][i] - ends[0][i]) / (2 * by);
      EXPECT_NEAR(got[i], wanted, 1e-3 * std::abs(wanted) + 1e-5) << known << ' ' << i;
    }
  }
}

TEST(FmuInstance, WrongValuesAreDiscardedAndTheInstanceGoesOn) {
  const Two c = started(0);
  const double before = get(c, kForce + 2);
  EXPECT_EQ(set(c, kPosition, std::numeric_limits<double>::quiet_NaN()), 2);
  EXPECT_TRUE(said("no finite number"));
  const unsigned quaternion[] = {3, 4, 5, 6};
  const double none[] = {0, 0, 0, 0}, one[] = {1, 0, 0, 0};
  EXPECT_EQ(fmi2SetReal(c.get(), quaternion, 4, none), 0);
  double force = 0.0;
  EXPECT_EQ(fmi2GetReal(c.get(), &kForce, 1, &force), 2);
  EXPECT_TRUE(said("quaternion has the norm 0"));
  double rates[kStates];
  EXPECT_EQ(fmi2GetDerivatives(c.get(), rates, kStates), 2);
  EXPECT_EQ(fmi2SetReal(c.get(), quaternion, 4, one), 0);
  EXPECT_EQ(get(c, kForce + 2), before);
  EXPECT_EQ(fmi2EnterEventMode(c.get()), 0);
  EXPECT_EQ(set(c, kStiffness, -1.0), 2);
  EXPECT_TRUE(said("stiffness = -1"));
  EXPECT_EQ(get(c, kStiffness), 1e8);
  EXPECT_EQ(set(c, kStiffness, 2e8), 0);
  EXPECT_NEAR(get(c, kForce + 2), 2 * before, 1e-9);
}

TEST(FmuInstance, WrongCallsAreErrorsWithAMessage) {
  EXPECT_EQ(fmi2Instantiate("x", 0, "wrong", "file://" FMU_RESOURCES, &kCallbacks, 0, 0), nullptr);
  EXPECT_TRUE(said("token"));
  EXPECT_EQ(fmi2Instantiate("x", 0, "ball", "file:///no/such/folder", &kCallbacks, 0, 0), nullptr);
  EXPECT_TRUE(said("cannot read"));
  EXPECT_EQ(fmi2Instantiate("x", 0, "ball", "http://host/x", &kCallbacks, 0, 0), nullptr);
  EXPECT_TRUE(said("no file: URI"));
  EXPECT_EQ(fmi2DoStep(nullptr, 0.0, 1.0, 0), 3);
  const Two c = two(1);
  EXPECT_EQ(fmi2DoStep(c.get(), 0.0, 1e-3, 0), 3);
  EXPECT_TRUE(said("not allowed in Instantiated"));
  const Two running = started(1);
  EXPECT_EQ(fmi2DoStep(running.get(), 0.5, 1e-3, 0), 3);
  EXPECT_TRUE(said("communication point"));
  EXPECT_EQ(fmi2DoStep(running.get(), 0.0, -1.0, 0), 3);
  EXPECT_TRUE(said("must be above 0"));
  const unsigned unknown = 100000;
  double value = 0.0;
  EXPECT_EQ(fmi2GetReal(running.get(), &unknown, 1, &value), 3);
  EXPECT_TRUE(said("value reference 100000"));
  EXPECT_EQ(set(running, kForce, 1.0), 3);
  EXPECT_TRUE(said("cannot be set"));
  EXPECT_EQ(set(running, 73, 0.5), 3);  // restitution is fixed
  EXPECT_EQ(fmi2GetReal(running.get(), nullptr, 1, &value), 3);
  EXPECT_EQ(fmi2Reset(running.get()), 0);
  EXPECT_EQ(fmi2SetupExperiment(running.get(), 0, 0.0, 0.0, 0, 0.0), 0);
}

TEST(FmuInstance, ThirdVersionReturnsEarlyWhereBodiesPart) {
  struct Seen {
    std::vector<double> times;
  } seen;
  const auto update = [](void* environment, double time, bool, bool, bool, bool, bool* early,
                         double* until) {
    static_cast<Seen*>(environment)->times.push_back(time);
    *early = false;
    *until = time;
  };
  const Three c(fmi3InstantiateCoSimulation("test", "ball", FMU_RESOURCES "/", false, false, true,
                                            true, nullptr, 0, &seen, &log3, update));
  ASSERT_TRUE(c) << last_message;
  ASSERT_EQ(fmi3EnterInitializationMode(c.get(), false, 0.0, 0.0, false, 0.0), 0);
  const std::uint32_t velocity = kVelocity, internal = kInternalStep;
  const double up[] = {0.0, 0.0, 0.1}, part = 1e-4;
  ASSERT_EQ(fmi3SetFloat64(c.get(), &velocity, 1, up, 3), 0) << last_message;
  ASSERT_EQ(fmi3SetFloat64(c.get(), &internal, 1, &part, 1), 0);
  ASSERT_EQ(fmi3ExitInitializationMode(c.get()), 0);
  ASSERT_EQ(fmi3EnterStepMode(c.get()), 0);
  bool event = false, terminate = false, early = false;
  double reached = 0.0;
  // 0.1 mm deep, at 0.1 m/s: apart after 1 ms.
  ASSERT_EQ(fmi3DoStep(c.get(), 0.0, 5e-3, true, &event, &terminate, &early, &reached), 0)
      << last_message;
  EXPECT_TRUE(event && early);
  EXPECT_NEAR(reached, 1e-3, 1.01e-4);
  EXPECT_GE(seen.times.size(), 8U);
}

TEST(FmuInstance, ManyInstancesAndThreadsGiveTheSameBits) {
  std::vector<Two> many;
  const std::size_t kMany = test::cases(1000, 200);
  for (std::size_t i = 0; i < kMany; ++i) many.push_back(started(1));
  const Two alone = started(1);
  const std::vector<double> wanted = slide(alone, 0.0, 3);
  std::vector<std::thread> threads;
  std::vector<std::vector<double>> got(8);
  for (std::size_t t = 0; t < 8; ++t) {
    threads.emplace_back([&, t] { got[t] = slide(many[kMany / 8 * t], 0.0, 3); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const auto& one : got) EXPECT_EQ(one, wanted);
}

// FMU_INSTANCES=10000 makes that many. The address sanitizer finds what is not given back.
TEST(FmuInstance, MadeAndFreedManyTimes) {
  const char* text = std::getenv("FMU_INSTANCES");
  const int count = text ? std::atoi(text) : test::cases(1000, 200);
  for (int i = 0; i < count; i += 2) {
    EXPECT_TRUE(two(i / 2 % 2));
    const Three c(
        fmi3InstantiateModelExchange("test", "ball", FMU_RESOURCES, false, false, nullptr, &log3));
    EXPECT_TRUE(c);
  }
}

}  // namespace
}  // namespace volcontact::c_api::testing::fmu_instance_test
