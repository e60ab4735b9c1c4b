// SPDX-License-Identifier: Apache-2.0
// The functions of FMI 2.0. What they mean is in the standard; what they do is in Instance and
// Unit.
#include "fmu/fmi2.h"

#include <algorithm>

#include "fmu/instance.h"
#include "fmu/resource_path.h"
#include "volcontact/base/check.h"

using namespace volcontact;
using namespace volcontact::fmi2;
using fmu::Group;
using fmu::Instance;
using fmu::Saved;
using fmu::Status;
using Type = Instance::Type;

namespace {

// The logger takes a format, in which # stands for references to variables. Masters in languages
// without C's variable arguments show it as it is: so it has the text, and there are no arguments.
std::string as_format(const std::string& message) {
  std::string format;
  for (const char letter : message) {
    if (letter == '%' || letter == '#') format += letter;
    format += letter;
  }
  return format;
}

class Instance2 final : public Instance {
 public:
  Instance2(Text name, Kind kind, Text token, Text resources, const Callbacks* callbacks)
      : Instance(fmu::path_from_uri(resources), token, kind == kModelExchange),
        name_(name),
        callbacks_(*callbacks) {}

  void log(Status status, const std::string& message) noexcept override {
    if (!callbacks_.logger) return;
    callbacks_.logger(callbacks_.environment, name_.c_str(), status, fmu::category_of(status),
                      as_format(message).c_str());
  }

 private:
  std::string name_;
  Callbacks callbacks_;
};

template <typename Function>
int call(Component c, const char* name, unsigned modes, Function&& function) noexcept {
  auto* instance = static_cast<Instance2*>(c);
  if (!instance) return fmu::kError;
  return instance->run(name, modes, [&] { function(*instance); });
}

void given(const void* pointer, std::size_t count) {
  require(pointer != nullptr || count == 0, "an array is null");
}

template <typename Number>
int get(Component c, const char* name, const Reference* references, std::size_t count,
        Number* values, Type type) {
  return call(c, name, fmu::kRunning | fmu::kTerminated, [&](Instance& i) {
    given(references, count);
    given(values, count);
    for (std::size_t k = 0; k < count; ++k) i.group_of(references[k], type);
    for (std::size_t k = 0; k < count; ++k) values[k] = static_cast<Number>(i.get(references[k]));
  });
}

template <typename Number>
int set(Component c, const char* name, const Reference* references, std::size_t count,
        const Number* values, Type type) {
  return call(c, name, fmu::kInstantiated | fmu::kRunning, [&](Instance& i) {
    given(references, count);
    given(values, count);
    for (std::size_t k = 0; k < count; ++k) {
      const Group& group = i.group_of(references[k], type);
      const double number = static_cast<double>(values[k]);
      i.set(group, static_cast<int>(references[k]) - group.first, &number, 1);
    }
  });
}

void exchange_only(const Instance& i) {
  require(i.is_exchange, "the instance is of Co-Simulation");
}
void simulation_only(const Instance& i) {
  require(!i.is_exchange, "the instance is of Model Exchange");
}
void same_count(std::size_t got, std::size_t wanted) {
  require(got == wanted,
          std::to_string(got) + " numbers are asked for and there are " + std::to_string(wanted));
}

}  // namespace

FMI2_EXPORT Text fmi2GetTypesPlatform() { return "default"; }
FMI2_EXPORT Text fmi2GetVersion() { return "2.0"; }

FMI2_EXPORT Component fmi2Instantiate(Text name, int kind, Text token, Text resources,
                                      const Callbacks* callbacks, Bool, Bool) {
  if (!callbacks) return nullptr;
  const auto refuse = [&](const char* message) -> Component {
    if (callbacks->logger) {
      callbacks->logger(callbacks->environment, name ? name : "", fmu::kError, "logStatusError",
                        as_format(message).c_str());
    }
    return nullptr;
  };
  if (!name || !*name) return refuse("fmi2Instantiate: the instance has no name");
  if (kind != kModelExchange && kind != kCoSimulation)
    return refuse("fmi2Instantiate: no such type");
  try {
    return static_cast<Instance2*>(
        new Instance2(name, static_cast<Kind>(kind), token, resources, callbacks));
  } catch (const std::exception& error) {
    return refuse((std::string("fmi2Instantiate: ") + error.what()).c_str());
  }
}

FMI2_EXPORT void fmi2FreeInstance(Component c) { delete static_cast<Instance2*>(c); }

FMI2_EXPORT int fmi2SetDebugLogging(Component c, Bool, std::size_t, const Text*) {
  return call(c, __func__, fmu::kAnyMode, [](Instance&) {});
}

FMI2_EXPORT int fmi2SetupExperiment(Component c, Bool, double, double start, Bool, double) {
  return call(c, __func__, fmu::kInstantiated, [&](Instance& i) {
    require(start - start == 0.0, "the start time is no finite number");
    i.unit.set_time(start);
  });
}
FMI2_EXPORT int fmi2EnterInitializationMode(Component c) {
  return call(c, __func__, fmu::kInstantiated,
              [](Instance& i) { i.enter_initialization(i.unit.time()); });
}
FMI2_EXPORT int fmi2ExitInitializationMode(Component c) {
  return call(c, __func__, fmu::kInitialization, [](Instance& i) { i.exit_initialization(); });
}
FMI2_EXPORT int fmi2Terminate(Component c) {
  return call(c, __func__, fmu::kEvent | fmu::kContinuous | fmu::kStep,
              [](Instance& i) { i.mode = fmu::kTerminated; });
}
FMI2_EXPORT int fmi2Reset(Component c) {
  return call(c, __func__, fmu::kAnyMode, [](Instance& i) { i.reset(); });
}

FMI2_EXPORT int fmi2GetReal(Component c, const Reference* references, std::size_t count,
                            double* values) {
  return get(c, __func__, references, count, values, Type::kReal);
}
FMI2_EXPORT int fmi2GetInteger(Component c, const Reference* references, std::size_t count,
                               int* values) {
  return get(c, __func__, references, count, values, Type::kInteger);
}
FMI2_EXPORT int fmi2GetBoolean(Component c, const Reference* references, std::size_t count,
                               Bool* values) {
  return get(c, __func__, references, count, values, Type::kBoolean);
}
FMI2_EXPORT int fmi2GetString(Component c, const Reference*, std::size_t count, Text*) {
  return call(c, __func__, fmu::kAnyMode, [&](Instance&) { same_count(count, 0); });
}
FMI2_EXPORT int fmi2SetReal(Component c, const Reference* references, std::size_t count,
                            const double* values) {
  return set(c, __func__, references, count, values, Type::kReal);
}
FMI2_EXPORT int fmi2SetInteger(Component c, const Reference* references, std::size_t count,
                               const int* values) {
  return set(c, __func__, references, count, values, Type::kInteger);
}
FMI2_EXPORT int fmi2SetBoolean(Component c, const Reference* references, std::size_t count,
                               const Bool* values) {
  return set(c, __func__, references, count, values, Type::kBoolean);
}
FMI2_EXPORT int fmi2SetString(Component c, const Reference*, std::size_t count, const Text*) {
  return call(c, __func__, fmu::kAnyMode, [&](Instance&) { same_count(count, 0); });
}

FMI2_EXPORT int fmi2GetFMUstate(Component c, void** state) {
  return call(c, __func__, fmu::kAnyMode, [&](Instance& i) {
    given(state, 1);
    auto saved = i.save();
    if (auto* old = static_cast<Saved*>(*state)) {
      *old = *saved;
    } else {
      *state = saved.release();
    }
  });
}
FMI2_EXPORT int fmi2SetFMUstate(Component c, void* state) {
  return call(c, __func__, fmu::kAnyMode, [&](Instance& i) {
    given(state, 1);
    i.restore(*static_cast<Saved*>(state));
  });
}
FMI2_EXPORT int fmi2FreeFMUstate(Component c, void** state) {
  return call(c, __func__, fmu::kAnyMode, [&](Instance&) {
    if (!state) return;
    delete static_cast<Saved*>(*state);
    *state = nullptr;
  });
}
FMI2_EXPORT int fmi2SerializedFMUstateSize(Component c, void* state, std::size_t* size) {
  return call(c, __func__, fmu::kAnyMode, [&](Instance& i) {
    given(state, 1);
    given(size, 1);
    *size = i.saved_size(*static_cast<Saved*>(state));
  });
}
FMI2_EXPORT int fmi2SerializeFMUstate(Component c, void* state, char* bytes, std::size_t size) {
  return call(c, __func__, fmu::kAnyMode, [&](Instance& i) {
    given(state, 1);
    i.serialize(*static_cast<Saved*>(state), bytes, size);
  });
}
FMI2_EXPORT int fmi2DeSerializeFMUstate(Component c, const char* bytes, std::size_t size,
                                        void** state) {
  return call(c, __func__, fmu::kAnyMode, [&](Instance& i) {
    given(state, 1);
    *state = i.deserialize(bytes, size).release();
  });
}

FMI2_EXPORT int fmi2GetDirectionalDerivative(Component c, const Reference* unknowns,
                                             std::size_t unknown_count, const Reference* knowns,
                                             std::size_t known_count, const double* seed,
                                             double* sensitivity) {
  return call(c, __func__, fmu::kEvent | fmu::kContinuous | fmu::kInitialization, [&](Instance& i) {
    exchange_only(i);
    given(unknowns, unknown_count);
    given(knowns, known_count);
    given(seed, known_count);
    given(sensitivity, unknown_count);
    for (std::size_t k = 0; k < unknown_count; ++k) i.group_of(unknowns[k], Type::kReal);
    for (std::size_t k = 0; k < known_count; ++k) {
      const Group& group = i.group_of(knowns[k], Type::kReal);
      require(group.is_input() || group.is_state(),
              "value reference " + std::to_string(knowns[k]) + " is no input and no state");
    }
    i.unit.derivative(unknowns, unknown_count, knowns, known_count, seed, sensitivity);
  });
}

// ---- Model Exchange -----------------------------------------------------------------------------

FMI2_EXPORT int fmi2EnterEventMode(Component c) {
  return call(c, __func__, fmu::kContinuous | fmu::kEvent, [](Instance& i) {
    exchange_only(i);
    i.mode = fmu::kEvent;
  });
}
FMI2_EXPORT int fmi2NewDiscreteStates(Component c, EventInfo* info) {
  return call(c, __func__, fmu::kEvent, [&](Instance& i) {
    given(info, 1);
    *info = {};
    info->values_of_continuous_states_changed = i.unit.update_states();
  });
}
FMI2_EXPORT int fmi2EnterContinuousTimeMode(Component c) {
  return call(c, __func__, fmu::kEvent, [](Instance& i) { i.mode = fmu::kContinuous; });
}
FMI2_EXPORT int fmi2CompletedIntegratorStep(Component c, Bool, Bool* event, Bool* terminate) {
  return call(c, __func__, fmu::kContinuous, [&](Instance& i) {
    given(event, 1);
    given(terminate, 1);
    *terminate = 0;
    *event = i.unit.complete_step();
  });
}
FMI2_EXPORT int fmi2SetTime(Component c, double time) {
  return call(c, __func__, fmu::kEvent | fmu::kContinuous, [&](Instance& i) {
    exchange_only(i);
    require(time - time == 0.0, "the time is no finite number");
    i.unit.set_time(time);
  });
}
FMI2_EXPORT int fmi2SetContinuousStates(Component c, const double* x, std::size_t count) {
  return call(c, __func__, fmu::kContinuous | fmu::kEvent, [&](Instance& i) {
    exchange_only(i);
    same_count(count, i.unit.state_count());
    given(x, count);
    i.unit.set_states(x);
  });
}
FMI2_EXPORT int fmi2GetDerivatives(Component c, double* rates, std::size_t count) {
  return call(c, __func__, fmu::kEvent | fmu::kContinuous | fmu::kInitialization, [&](Instance& i) {
    exchange_only(i);
    same_count(count, i.unit.state_count());
    given(rates, count);
    i.unit.get_rates(rates);
  });
}
FMI2_EXPORT int fmi2GetEventIndicators(Component c, double* indicators, std::size_t count) {
  return call(c, __func__, fmu::kEvent | fmu::kContinuous | fmu::kInitialization, [&](Instance& i) {
    exchange_only(i);
    same_count(count, i.unit.indicator_count());
    given(indicators, count);
    i.unit.get_indicators(indicators);
  });
}
FMI2_EXPORT int fmi2GetContinuousStates(Component c, double* x, std::size_t count) {
  return call(c, __func__, fmu::kEvent | fmu::kContinuous | fmu::kInitialization, [&](Instance& i) {
    exchange_only(i);
    same_count(count, i.unit.state_count());
    given(x, count);
    i.unit.get_states(x);
  });
}
FMI2_EXPORT int fmi2GetNominalsOfContinuousStates(Component c, double* nominals,
                                                  std::size_t count) {
  return call(c, __func__, fmu::kAnyMode, [&](Instance& i) {
    exchange_only(i);
    same_count(count, i.unit.state_count());
    given(nominals, count);
    i.unit.get_nominals(nominals);
  });
}

// ---- Co-Simulation ------------------------------------------------------------------------------

FMI2_EXPORT int fmi2DoStep(Component c, double now, double step, Bool) {
  return call(c, __func__, fmu::kStep, [&](Instance& i) {
    simulation_only(i);
    i.step(now, step, false, [](double) { return false; });
  });
}
FMI2_EXPORT int fmi2CancelStep(Component c) {
  return call(c, __func__, 0, [](Instance&) {});  // no step is ever pending
}
FMI2_EXPORT int fmi2SetRealInputDerivatives(Component c, const Reference*, std::size_t, const int*,
                                            const double*) {
  return call(c, __func__, fmu::kRunning, [](Instance&) {
    require(false, "canInterpolateInputs is false: set the inputs, and `extrapolation`");
  });
}
FMI2_EXPORT int fmi2GetRealOutputDerivatives(Component c, const Reference*, std::size_t, const int*,
                                             double*) {
  return call(c, __func__, fmu::kRunning,
              [](Instance&) { require(false, "maxOutputDerivativeOrder is 0"); });
}
FMI2_EXPORT int fmi2GetStatus(Component c, int, int* value) {
  return call(c, __func__, fmu::kAnyMode, [&](Instance& i) {
    simulation_only(i);
    given(value, 1);
    throw fmu::Discarded("no step is ever pending");
  });
}
FMI2_EXPORT int fmi2GetRealStatus(Component c, int kind, double* value) {
  return call(c, __func__, fmu::kAnyMode, [&](Instance& i) {
    simulation_only(i);
    given(value, 1);
    if (kind != kLastSuccessfulTime) throw fmu::Discarded("only fmi2LastSuccessfulTime is known");
    *value = i.unit.time();
  });
}
FMI2_EXPORT int fmi2GetIntegerStatus(Component c, int, int*) {
  return call(c, __func__, fmu::kAnyMode, [](Instance&) { throw fmu::Discarded("none is known"); });
}
FMI2_EXPORT int fmi2GetBooleanStatus(Component c, int kind, Bool* value) {
  return call(c, __func__, fmu::kAnyMode, [&](Instance& i) {
    simulation_only(i);
    given(value, 1);
    if (kind != kIsTerminated) throw fmu::Discarded("only fmi2Terminated is known");
    *value = 0;
  });
}
FMI2_EXPORT int fmi2GetStringStatus(Component c, int, Text*) {
  return call(c, __func__, fmu::kAnyMode, [](Instance&) { throw fmu::Discarded("none is known"); });
}
