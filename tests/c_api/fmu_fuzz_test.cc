// SPDX-License-Identifier: Apache-2.0
// Random calls, right and wrong ones, in any order: no crash, a status of the standard each time,
// and after a reset the instance is as new, to the bit. FMU_FUZZ_SEQUENCES=100000 runs that many,
// from number FMU_FUZZ_FIRST on.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <vector>

#include "c_api/fmu_functions.h"

namespace volcontact::c_api::testing::fmu_fuzz_test {
namespace {

constexpr unsigned kValues = 86;
constexpr std::size_t kStates = 9, kIndicators = 2;
constexpr int kCalls = 30;  // of a sequence

const Callbacks kQuiet{nullptr, nullptr, nullptr, nullptr, nullptr};

int wish(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text ? std::atoi(text) : otherwise;
}
int sequences() { return wish("FMU_FUZZ_SEQUENCES", 250); }
int first() { return wish("FMU_FUZZ_FIRST", 0); }

class Fuzz {
 public:
  explicit Fuzz(unsigned seed) : random_(seed) {}

  int below(int count) { return std::uniform_int_distribution<>(0, count - 1)(random_); }
  unsigned reference() {
    return below(20) == 0 ? random_() : static_cast<unsigned>(below(kValues + 2));
  }
  double number() {
    switch (below(12)) {
      case 0:
        return std::numeric_limits<double>::quiet_NaN();
      case 1:
        return std::numeric_limits<double>::infinity();
      case 2:
        return 0.0;
      case 3:
        return 1e300;
      default:
        return std::normal_distribution<>(0.0, below(2) ? 1.0 : 0.05)(random_);
    }
  }
  std::size_t count(std::size_t right) {
    return below(6) == 0 ? static_cast<std::size_t>(below(12)) : right;
  }
  bool yes() { return below(2) == 1; }

 private:
  std::mt19937 random_;
};

struct Two {
  static constexpr int kFunctions = 29;
  void* c;
  bool exchange;
  void* state = nullptr;
  double time = 0.0;

  Two(bool is_exchange)
      : c(fmi2Instantiate("fuzz", is_exchange ? 0 : 1, "ball", FMU_RESOURCES, &kQuiet, 0, 0)),
        exchange(is_exchange) {}
  ~Two() {
    fmi2FreeFMUstate(c, &state);
    fmi2FreeInstance(c);
  }

  int call(Fuzz& f) {
    unsigned references[4] = {f.reference(), f.reference(), f.reference(), f.reference()};
    double numbers[12];
    for (double& number : numbers) number = f.number();
    int whole[4] = {f.below(5), f.below(5), f.below(5), f.below(5)}, flags[2];
    const std::size_t few = static_cast<std::size_t>(f.below(5));
    EventInfo info;
    switch (f.below(kFunctions)) {
      case 0:
        return fmi2SetupExperiment(c, 0, 0.0, f.below(4) ? 0.0 : f.number(), 0, 0.0);
      case 1:
        return fmi2EnterInitializationMode(c);
      case 2:
        return fmi2ExitInitializationMode(c);
      case 3:
        return fmi2Terminate(c);
      case 4:
        return f.below(5) ? 0 : fmi2Reset(c);
      case 5:
      case 6:
        return fmi2GetReal(c, references, few, numbers);
      case 7:
      case 8:
        return fmi2SetReal(c, references, few, numbers);
      case 9:
        return fmi2GetInteger(c, references, few, whole);
      case 10:
        return fmi2SetInteger(c, references, few, whole);
      case 11:
        return fmi2GetBoolean(c, references, few, whole);
      case 12:
        return fmi2GetFMUstate(c, &state);
      case 13:
        return fmi2SetFMUstate(c, state);
      case 14:
        return fmi2FreeFMUstate(c, &state);
      case 15: {
        std::size_t size = 0;
        if (fmi2SerializedFMUstateSize(c, state, &size) != 0) return 3;
        std::vector<char> bytes(size);
        fmi2SerializeFMUstate(c, state, bytes.data(), f.yes() ? size : size / 2);
        if (f.yes()) bytes[static_cast<std::size_t>(f.below(static_cast<int>(size)))] ^= 0x55;
        fmi2FreeFMUstate(c, &state);
        return fmi2DeSerializeFMUstate(c, bytes.data(), f.below(4) ? size : size / 2, &state);
      }
      case 16:
        return fmi2GetDirectionalDerivative(c, references, few / 2, references + 2, few / 2,
                                            numbers, numbers + 4);
      case 17:
        return fmi2EnterEventMode(c);
      case 18:
        return fmi2NewDiscreteStates(c, f.below(9) ? &info : nullptr);
      case 19:
        return fmi2EnterContinuousTimeMode(c);
      case 20:
        return fmi2CompletedIntegratorStep(c, 1, flags, flags + 1);
      case 21:
        return fmi2SetTime(c, f.number());
      case 22:
        return fmi2SetContinuousStates(c, numbers, f.count(kStates));
      case 23:
        return fmi2GetDerivatives(c, numbers, f.count(kStates));
      case 24:
        return fmi2GetEventIndicators(c, numbers, f.count(kIndicators));
      case 25:
        return fmi2GetContinuousStates(c, numbers, f.count(kStates));
      case 26:
        return fmi2GetNominalsOfContinuousStates(c, numbers, f.count(kStates));
      default: {
        double at = 0.0;
        fmi2GetRealStatus(c, 2, &at);
        return fmi2DoStep(c, f.below(8) ? at : f.number(), f.below(8) ? 1e-3 : f.number(), 1);
      }
    }
  }

  // The forces and states of a short run from the start.
  std::vector<double> run() {
    fmi2Reset(c);
    EXPECT_EQ(fmi2SetupExperiment(c, 0, 0.0, 0.0, 0, 0.0), 0);
    EXPECT_EQ(fmi2EnterInitializationMode(c), 0);
    EXPECT_EQ(fmi2ExitInitializationMode(c), 0);
    const unsigned references[] = {13, 14, 15, 16, 17, 18, 30, 31, 33, 35};
    std::vector<double> out(std::size(references) + kStates);
    if (exchange) {
      EventInfo info;
      EXPECT_EQ(fmi2NewDiscreteStates(c, &info), 0);
      EXPECT_EQ(fmi2EnterContinuousTimeMode(c), 0);
      EXPECT_EQ(fmi2GetDerivatives(c, &out[std::size(references)], kStates), 0);
    } else {
      EXPECT_EQ(fmi2DoStep(c, 0.0, 1e-3, 1), 0);
    }
    EXPECT_EQ(fmi2GetReal(c, references, std::size(references), out.data()), 0);
    return out;
  }
};

struct Three {
  static constexpr int kFunctions = 19;
  void* c;
  bool exchange;
  void* state = nullptr;

  Three(bool is_exchange)
      : c(is_exchange
              ? fmi3InstantiateModelExchange("fuzz", "ball", FMU_RESOURCES, false, false, nullptr,
                                             nullptr)
              : fmi3InstantiateCoSimulation("fuzz", "ball", FMU_RESOURCES, false, false, true, true,
                                            nullptr, 0, nullptr, nullptr, nullptr)),
        exchange(is_exchange) {}
  ~Three() {
    fmi3FreeFMUState(c, &state);
    fmi3FreeInstance(c);
  }

  int call(Fuzz& f) {
    std::uint32_t references[2] = {f.reference(), f.reference()};
    double numbers[12];
    for (double& number : numbers) number = f.number();
    bool flags[5];
    const std::size_t few = static_cast<std::size_t>(f.below(3));
    const std::size_t count = static_cast<std::size_t>(f.below(9));
    switch (f.below(kFunctions)) {
      case 0:
        return fmi3EnterInitializationMode(c, false, 0.0, f.below(4) ? 0.0 : f.number(), false,
                                           0.0);
      case 1:
        return fmi3ExitInitializationMode(c);
      case 2:
        return fmi3EnterEventMode(c);
      case 3:
        return fmi3Terminate(c);
      case 4:
        return f.below(5) ? 0 : fmi3Reset(c);
      case 5:
      case 6:
        return fmi3GetFloat64(c, references, few, numbers, count);
      case 7:
      case 8:
        return fmi3SetFloat64(c, references, few, numbers, count);
      case 9:
        return fmi3GetFMUState(c, &state);
      case 10:
        return fmi3SetFMUState(c, state);
      case 11:
        return fmi3UpdateDiscreteStates(c, flags, flags + 1, flags + 2, flags + 3, flags + 4,
                                        numbers);
      case 12:
        return fmi3EnterContinuousTimeMode(c);
      case 13:
        return fmi3CompletedIntegratorStep(c, true, flags, flags + 1);
      case 14:
        return fmi3SetContinuousStates(c, numbers, f.count(kStates));
      case 15:
        return fmi3GetContinuousStateDerivatives(c, numbers, f.count(kStates));
      case 16:
        return fmi3EnterStepMode(c);
      case 17:
        return fmi3GetDirectionalDerivative(c, references, 1, references + 1, 1, numbers, few,
                                            numbers + 3, count);
      default:
        return fmi3DoStep(c, f.below(4) ? 0.0 : f.number(), f.below(8) ? 1e-3 : f.number(), true,
                          flags, flags + 1, flags + 2, numbers);
    }
  }

  std::vector<double> run() {
    fmi3Reset(c);
    EXPECT_EQ(fmi3EnterInitializationMode(c, false, 0.0, 0.0, false, 0.0), 0);
    EXPECT_EQ(fmi3ExitInitializationMode(c), 0);
    const std::uint32_t force = 13, power = 31;
    std::vector<double> out(7);
    bool flags[5];
    double number = 0.0;
    EXPECT_EQ(
        fmi3UpdateDiscreteStates(c, flags, flags + 1, flags + 2, flags + 3, flags + 4, &number), 0);
    EXPECT_EQ(exchange ? fmi3EnterContinuousTimeMode(c) : fmi3EnterStepMode(c), 0);
    if (!exchange) {
      EXPECT_EQ(fmi3DoStep(c, 0.0, 1e-3, true, flags, flags + 1, flags + 2, &number), 0);
    }
    EXPECT_EQ(fmi3GetFloat64(c, &force, 1, out.data(), 3), 0);
    EXPECT_EQ(fmi3GetFloat64(c, &power, 1, &out[3], 4), 0);
    return out;
  }
};

template <typename Unit>
void fuzz(bool exchange) {
  const std::vector<double> as_new = Unit(exchange).run();
  EXPECT_GT(as_new[2], 0.1);
  Unit unit(exchange);
  for (int i = first(); i < first() + sequences(); ++i) {
    Fuzz random(static_cast<unsigned>(i));
    for (int k = 0; k < kCalls; ++k) {
      const int status = unit.call(random);
      ASSERT_TRUE(status == 0 || status == 2 || status == 3) << status << " in sequence " << i;
    }
    ASSERT_EQ(unit.run(), as_new) << "after sequence " << i;
  }
}

TEST(FmuFuzz, ModelExchange2) { fuzz<Two>(true); }
TEST(FmuFuzz, CoSimulation2) { fuzz<Two>(false); }
TEST(FmuFuzz, ModelExchange3) { fuzz<Three>(true); }
TEST(FmuFuzz, CoSimulation3) { fuzz<Three>(false); }

}  // namespace
}  // namespace volcontact::c_api::testing::fmu_fuzz_test
