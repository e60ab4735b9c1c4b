// SPDX-License-Identifier: Apache-2.0
// The functions of FMI 3.0. What they mean is in the standard; what they do is in Instance and
// Unit.
#include "fmu/fmi3.h"

#include <algorithm>

#include "fmu/instance.h"
#include "fmu/resource_path.h"
#include "volcontact/base/check.h"

using namespace volcontact;
using namespace volcontact::fmi3;
using fmu::Group;
using fmu::Instance;
using fmu::Saved;
using fmu::Status;
using Type = Instance::Type;

namespace {

struct Callbacks {
  Environment environment = nullptr;
  Log log = nullptr;
  IntermediateUpdate intermediate_update = nullptr;
  bool event_mode_used = false;
  bool early_return_allowed = false;
};

class Instance3 final : public Instance {
 public:
  Instance3(Text token, Text resources, bool exchange, const Callbacks& given)
      : Instance(fmu::path_from_uri(resources), token, exchange), callbacks(given) {}

  void log(Status status, const std::string& message) noexcept override {
    if (!callbacks.log) return;
    callbacks.log(callbacks.environment, status, fmu::category_of(status), message.c_str());
  }

  const Callbacks callbacks;
};

Handle instantiate(Text name, Text token, Text resources, bool exchange,
                   const Callbacks& callbacks) {
  const auto refuse = [&](const char* message) -> Handle {
    if (callbacks.log) callbacks.log(callbacks.environment, fmu::kError, "logStatusError", message);
    return nullptr;
  };
  if (!name || !*name) return refuse("fmi3Instantiate: the instance has no name");
  try {
    return static_cast<Instance3*>(new Instance3(token, resources, exchange, callbacks));
  } catch (const std::exception& error) {
    return refuse((std::string("fmi3Instantiate: ") + error.what()).c_str());
  }
}

template <typename Function>
int call(Handle c, const char* name, unsigned modes, Function&& function) noexcept {
  auto* instance = static_cast<Instance3*>(c);
  if (!instance) return fmu::kError;
  return instance->run(name, modes, [&] { function(*instance); });
}

void given(const void* pointer, std::size_t count = 1) {
  require(pointer != nullptr || count == 0, "an array is null");
}
void same_count(std::size_t got, std::size_t wanted) {
  require(got == wanted,
          std::to_string(got) + " numbers are asked for and there are " + std::to_string(wanted));
}

// What a value reference stands for: all values of a group or, in a unit of scalars, one of them.
struct Values {
  const Group& group;
  int offset, count;
};
Values values_of(const Instance& i, Reference reference, Type type) {
  if (!i.unit.file().is_scalar) {
    const Group& group = i.group(reference, type);
    return {group, 0, group.count};
  }
  const Group& group = i.group_of(reference, type);
  return {group, static_cast<int>(reference) - group.first, 1};
}

// Calls visit(values) for each reference once it is known that all are there, with room for all.
template <typename Visit>
void for_groups(Instance& i, const Reference* references, std::size_t count, const void* values,
                std::size_t value_count, Type type, Visit&& visit) {
  given(references, count);
  given(values, value_count);
  std::size_t wanted = 0;
  for (std::size_t k = 0; k < count; ++k) {
    wanted += static_cast<std::size_t>(values_of(i, references[k], type).count);
  }
  same_count(value_count, wanted);
  for (std::size_t k = 0; k < count; ++k) visit(values_of(i, references[k], type));
}

template <typename Number>
int get(Handle c, const char* name, const Reference* references, std::size_t count, Number* values,
        std::size_t value_count, Type type) {
  return call(c, name, fmu::kRunning | fmu::kTerminated, [&](Instance& i) {
    Number* to = values;
    for_groups(i, references, count, values, value_count, type, [&](const Values& of) {
      for (int k = of.offset; k < of.offset + of.count; ++k) {
        *to++ = static_cast<Number>(i.get(static_cast<unsigned>(of.group.first + k)));
      }
    });
  });
}

template <typename Number>
int set(Handle c, const char* name, const Reference* references, std::size_t count,
        const Number* values, std::size_t value_count, Type type) {
  return call(c, name, fmu::kInstantiated | fmu::kRunning, [&](Instance& i) {
    const Number* from = values;
    for_groups(i, references, count, values, value_count, type, [&](const Values& of) {
      const std::vector<double> numbers(from, from + of.count);
      from += of.count;
      i.set(of.group, of.offset, numbers.data(), of.count);
    });
  });
}

int none(Handle c, const char* name, std::size_t count) {
  return call(c, name, fmu::kAnyMode, [&](Instance&) {
    require(count == 0, "the FMU has no variables of this type; see modelDescription.xml");
  });
}
int unavailable(Handle c, const char* name) {
  return call(c, name, fmu::kAnyMode, [](Instance&) {
    require(false, "this FMU does not offer it; see modelDescription.xml");
  });
}

void exchange_only(const Instance& i) {
  require(i.is_exchange, "the instance is of Co-Simulation");
}
void simulation_only(const Instance& i) {
  require(!i.is_exchange, "the instance is of Model Exchange");
}

// The groups as references to their single values.
std::vector<unsigned> single(const Instance& i, const Reference* references, std::size_t count,
                             bool is_known) {
  std::vector<unsigned> out;
  for (std::size_t k = 0; k < count; ++k) {
    const Values now = values_of(i, references[k], Type::kReal);
    require(!is_known || now.group.is_input() || now.group.is_state(),
            "value reference " + std::to_string(references[k]) + " is no input and no state");
    for (int j = 0; j < now.count; ++j) {
      out.push_back(static_cast<unsigned>(now.group.first + now.offset + j));
    }
  }
  return out;
}

}  // namespace

FMI3_EXPORT Text fmi3GetVersion() { return "3.0"; }

FMI3_EXPORT int fmi3SetDebugLogging(Handle c, bool, std::size_t, const Text*) {
  return call(c, __func__, fmu::kAnyMode, [](Instance&) {});
}

FMI3_EXPORT Handle fmi3InstantiateModelExchange(Text name, Text token, Text resources, bool, bool,
                                                Environment environment, Log log) {
  return instantiate(name, token, resources, true, {environment, log});
}
FMI3_EXPORT Handle fmi3InstantiateCoSimulation(Text name, Text token, Text resources, bool, bool,
                                               bool event_mode_used, bool early_return_allowed,
                                               const Reference*, std::size_t,
                                               Environment environment, Log log,
                                               IntermediateUpdate intermediate_update) {
  return instantiate(
      name, token, resources, false,
      {environment, log, intermediate_update, event_mode_used, early_return_allowed});
}
FMI3_EXPORT Handle fmi3InstantiateScheduledExecution(Text, Text, Text, bool, bool,
                                                     Environment environment, Log log, void*, void*,
                                                     void*) {
  if (log) {
    log(environment, fmu::kError, "logStatusError",
        "fmi3InstantiateScheduledExecution: this FMU has Model Exchange and Co-Simulation only");
  }
  return nullptr;
}
FMI3_EXPORT void fmi3FreeInstance(Handle c) { delete static_cast<Instance3*>(c); }

FMI3_EXPORT int fmi3EnterInitializationMode(Handle c, bool, double, double start, bool, double) {
  return call(c, __func__, fmu::kInstantiated, [&](Instance& i) { i.enter_initialization(start); });
}
FMI3_EXPORT int fmi3ExitInitializationMode(Handle c) {
  return call(c, __func__, fmu::kInitialization, [](Instance3& i) {
    i.exit_initialization();
    if (i.callbacks.event_mode_used) i.mode = fmu::kEvent;
  });
}
FMI3_EXPORT int fmi3EnterEventMode(Handle c) {
  return call(c, __func__, fmu::kContinuous | fmu::kStep, [](Instance3& i) {
    require(i.is_exchange || i.callbacks.event_mode_used, "eventModeUsed is false");
    i.mode = fmu::kEvent;
  });
}
FMI3_EXPORT int fmi3Terminate(Handle c) {
  return call(c, __func__, fmu::kEvent | fmu::kContinuous | fmu::kStep,
              [](Instance& i) { i.mode = fmu::kTerminated; });
}
FMI3_EXPORT int fmi3Reset(Handle c) {
  return call(c, __func__, fmu::kAnyMode & ~fmu::kIntermediate, [](Instance& i) { i.reset(); });
}

FMI3_EXPORT int fmi3GetFloat64(Handle c, const Reference* references, std::size_t count,
                               double* values, std::size_t value_count) {
  return get(c, __func__, references, count, values, value_count, Type::kReal);
}
FMI3_EXPORT int fmi3SetFloat64(Handle c, const Reference* references, std::size_t count,
                               const double* values, std::size_t value_count) {
  return set(c, __func__, references, count, values, value_count, Type::kReal);
}
FMI3_EXPORT int fmi3GetInt32(Handle c, const Reference* references, std::size_t count,
                             std::int32_t* values, std::size_t value_count) {
  return get(c, __func__, references, count, values, value_count, Type::kInteger);
}
FMI3_EXPORT int fmi3SetInt32(Handle c, const Reference* references, std::size_t count,
                             const std::int32_t* values, std::size_t value_count) {
  return set(c, __func__, references, count, values, value_count, Type::kInteger);
}
FMI3_EXPORT int fmi3GetBoolean(Handle c, const Reference* references, std::size_t count,
                               bool* values, std::size_t value_count) {
  return get(c, __func__, references, count, values, value_count, Type::kBoolean);
}
FMI3_EXPORT int fmi3SetBoolean(Handle c, const Reference* references, std::size_t count,
                               const bool* values, std::size_t value_count) {
  return set(c, __func__, references, count, values, value_count, Type::kBoolean);
}

// Types of which there are no variables.
#define VOLCONTACT_NO_VALUES(Name)                                                          \
  FMI3_EXPORT int fmi3Get##Name(Handle c, const Reference*, std::size_t count, void*,       \
                                std::size_t) {                                              \
    return none(c, __func__, count);                                                        \
  }                                                                                         \
  FMI3_EXPORT int fmi3Set##Name(Handle c, const Reference*, std::size_t count, const void*, \
                                std::size_t) {                                              \
    return none(c, __func__, count);                                                        \
  }
VOLCONTACT_NO_VALUES(Float32)
VOLCONTACT_NO_VALUES(Int8)
VOLCONTACT_NO_VALUES(UInt8)
VOLCONTACT_NO_VALUES(Int16)
VOLCONTACT_NO_VALUES(UInt16)
VOLCONTACT_NO_VALUES(UInt32)
VOLCONTACT_NO_VALUES(Int64)
VOLCONTACT_NO_VALUES(UInt64)
VOLCONTACT_NO_VALUES(String)
#undef VOLCONTACT_NO_VALUES
FMI3_EXPORT int fmi3GetBinary(Handle c, const Reference*, std::size_t count, std::size_t*, void*,
                              std::size_t) {
  return none(c, __func__, count);
}
FMI3_EXPORT int fmi3SetBinary(Handle c, const Reference*, std::size_t count, const std::size_t*,
                              const void*, std::size_t) {
  return none(c, __func__, count);
}
FMI3_EXPORT int fmi3GetClock(Handle c, const Reference*, std::size_t count, bool*) {
  return none(c, __func__, count);
}
FMI3_EXPORT int fmi3SetClock(Handle c, const Reference*, std::size_t count, const bool*) {
  return none(c, __func__, count);
}

#define VOLCONTACT_UNAVAILABLE(Name, ...) \
  FMI3_EXPORT int fmi3##Name(Handle c, __VA_ARGS__) { return unavailable(c, __func__); }
VOLCONTACT_UNAVAILABLE(GetNumberOfVariableDependencies, Reference, std::size_t*)
VOLCONTACT_UNAVAILABLE(GetVariableDependencies, Reference, std::size_t*, Reference*, std::size_t*,
                       int*, std::size_t)
VOLCONTACT_UNAVAILABLE(GetAdjointDerivative, const Reference*, std::size_t, const Reference*,
                       std::size_t, const double*, std::size_t, double*, std::size_t)
VOLCONTACT_UNAVAILABLE(GetIntervalDecimal, const Reference*, std::size_t, double*, int*)
VOLCONTACT_UNAVAILABLE(GetIntervalFraction, const Reference*, std::size_t, void*, void*, int*)
VOLCONTACT_UNAVAILABLE(GetShiftDecimal, const Reference*, std::size_t, double*)
VOLCONTACT_UNAVAILABLE(GetShiftFraction, const Reference*, std::size_t, void*, void*)
VOLCONTACT_UNAVAILABLE(SetIntervalDecimal, const Reference*, std::size_t, const double*)
VOLCONTACT_UNAVAILABLE(SetIntervalFraction, const Reference*, std::size_t, const void*, const void*)
VOLCONTACT_UNAVAILABLE(SetShiftDecimal, const Reference*, std::size_t, const double*)
VOLCONTACT_UNAVAILABLE(SetShiftFraction, const Reference*, std::size_t, const void*, const void*)
VOLCONTACT_UNAVAILABLE(GetOutputDerivatives, const Reference*, std::size_t, const std::int32_t*,
                       double*, std::size_t)
VOLCONTACT_UNAVAILABLE(ActivateModelPartition, Reference, double)
#undef VOLCONTACT_UNAVAILABLE
FMI3_EXPORT int fmi3EnterConfigurationMode(Handle c) { return unavailable(c, __func__); }
FMI3_EXPORT int fmi3ExitConfigurationMode(Handle c) { return unavailable(c, __func__); }

FMI3_EXPORT int fmi3GetFMUState(Handle c, void** state) {
  return call(c, __func__, fmu::kAnyMode & ~fmu::kIntermediate, [&](Instance& i) {
    given(state);
    auto saved = i.save();
    if (auto* old = static_cast<Saved*>(*state)) {
      *old = *saved;
    } else {
      *state = saved.release();
    }
  });
}
FMI3_EXPORT int fmi3SetFMUState(Handle c, void* state) {
  return call(c, __func__, fmu::kAnyMode & ~fmu::kIntermediate, [&](Instance& i) {
    given(state);
    i.restore(*static_cast<Saved*>(state));
  });
}
FMI3_EXPORT int fmi3FreeFMUState(Handle c, void** state) {
  return call(c, __func__, fmu::kAnyMode, [&](Instance&) {
    if (!state) return;
    delete static_cast<Saved*>(*state);
    *state = nullptr;
  });
}
FMI3_EXPORT int fmi3SerializedFMUStateSize(Handle c, void* state, std::size_t* size) {
  return call(c, __func__, fmu::kAnyMode, [&](Instance& i) {
    given(state);
    given(size);
    *size = i.saved_size(*static_cast<Saved*>(state));
  });
}
FMI3_EXPORT int fmi3SerializeFMUState(Handle c, void* state, std::uint8_t* bytes,
                                      std::size_t size) {
  return call(c, __func__, fmu::kAnyMode, [&](Instance& i) {
    given(state);
    i.serialize(*static_cast<Saved*>(state), bytes, size);
  });
}
FMI3_EXPORT int fmi3DeserializeFMUState(Handle c, const std::uint8_t* bytes, std::size_t size,
                                        void** state) {
  return call(c, __func__, fmu::kAnyMode, [&](Instance& i) {
    given(state);
    *state = i.deserialize(bytes, size).release();
  });
}

FMI3_EXPORT int fmi3GetDirectionalDerivative(Handle c, const Reference* unknowns,
                                             std::size_t unknown_count, const Reference* knowns,
                                             std::size_t known_count, const double* seed,
                                             std::size_t seed_count, double* sensitivity,
                                             std::size_t sensitivity_count) {
  return call(c, __func__, fmu::kEvent | fmu::kContinuous | fmu::kInitialization, [&](Instance& i) {
    exchange_only(i);
    given(unknowns, unknown_count);
    given(knowns, known_count);
    const std::vector<unsigned> of = single(i, unknowns, unknown_count, false);
    const std::vector<unsigned> by = single(i, knowns, known_count, true);
    same_count(seed_count, by.size());
    same_count(sensitivity_count, of.size());
    given(seed, seed_count);
    given(sensitivity, sensitivity_count);
    i.unit.derivative(of.data(), of.size(), by.data(), by.size(), seed, sensitivity);
  });
}

FMI3_EXPORT int fmi3EvaluateDiscreteStates(Handle c) {
  return call(c, __func__, fmu::kEvent | fmu::kInitialization, [](Instance&) {});
}
FMI3_EXPORT int fmi3UpdateDiscreteStates(Handle c, bool* update_needed, bool* terminate,
                                         bool* nominals_changed, bool* values_changed,
                                         bool* next_event_defined, double* next_event) {
  return call(c, __func__, fmu::kEvent, [&](Instance& i) {
    for (bool* flag :
         {update_needed, terminate, nominals_changed, values_changed, next_event_defined}) {
      given(flag);
    }
    given(next_event);
    *update_needed = *terminate = *nominals_changed = *next_event_defined = false;
    *values_changed = i.is_exchange && i.unit.update_states();
  });
}

// ---- Model Exchange -----------------------------------------------------------------------------

FMI3_EXPORT int fmi3EnterContinuousTimeMode(Handle c) {
  return call(c, __func__, fmu::kEvent, [](Instance& i) {
    exchange_only(i);
    i.mode = fmu::kContinuous;
  });
}
FMI3_EXPORT int fmi3CompletedIntegratorStep(Handle c, bool, bool* event, bool* terminate) {
  return call(c, __func__, fmu::kContinuous, [&](Instance& i) {
    given(event);
    given(terminate);
    *terminate = false;
    *event = i.unit.complete_step();
  });
}
FMI3_EXPORT int fmi3SetTime(Handle c, double time) {
  return call(c, __func__, fmu::kEvent | fmu::kContinuous, [&](Instance& i) {
    exchange_only(i);
    require(time - time == 0.0, "the time is no finite number");
    i.unit.set_time(time);
  });
}
FMI3_EXPORT int fmi3SetContinuousStates(Handle c, const double* x, std::size_t count) {
  return call(c, __func__, fmu::kContinuous, [&](Instance& i) {
    same_count(count, i.unit.state_count());
    given(x, count);
    i.unit.set_states(x);
  });
}

#define VOLCONTACT_NUMBERS(Name, modes, counter, getter)                        \
  FMI3_EXPORT int fmi3Get##Name(Handle c, double* numbers, std::size_t count) { \
    return call(c, __func__, modes, [&](Instance& i) {                          \
      exchange_only(i);                                                         \
      same_count(count, i.unit.counter());                                      \
      given(numbers, count);                                                    \
      i.unit.getter(numbers);                                                   \
    });                                                                         \
  }
constexpr unsigned kKnown = fmu::kEvent | fmu::kContinuous | fmu::kInitialization;
VOLCONTACT_NUMBERS(ContinuousStateDerivatives, kKnown, state_count, get_rates)
VOLCONTACT_NUMBERS(EventIndicators, kKnown, indicator_count, get_indicators)
VOLCONTACT_NUMBERS(ContinuousStates, kKnown, state_count, get_states)
VOLCONTACT_NUMBERS(NominalsOfContinuousStates, fmu::kAnyMode, state_count, get_nominals)
#undef VOLCONTACT_NUMBERS

FMI3_EXPORT int fmi3GetNumberOfEventIndicators(Handle c, std::size_t* count) {
  return call(c, __func__, fmu::kAnyMode, [&](Instance& i) {
    exchange_only(i);
    given(count);
    *count = i.unit.indicator_count();
  });
}
FMI3_EXPORT int fmi3GetNumberOfContinuousStates(Handle c, std::size_t* count) {
  return call(c, __func__, fmu::kAnyMode, [&](Instance& i) {
    exchange_only(i);
    given(count);
    *count = i.unit.state_count();
  });
}

// ---- Co-Simulation ------------------------------------------------------------------------------

FMI3_EXPORT int fmi3EnterStepMode(Handle c) {
  return call(c, __func__, fmu::kEvent, [](Instance& i) {
    simulation_only(i);
    i.mode = fmu::kStep;
  });
}

FMI3_EXPORT int fmi3DoStep(Handle c, double now, double step, bool, bool* event_needed,
                           bool* terminate, bool* early_return, double* reached) {
  return call(c, __func__, fmu::kStep, [&](Instance3& i) {
    simulation_only(i);
    given(event_needed);
    given(terminate);
    given(early_return);
    given(reached);
    *event_needed = *terminate = *early_return = false;
    *reached = i.unit.time();
    const Callbacks& callbacks = i.callbacks;
    const auto part_done = [&](double time) {
      if (!callbacks.intermediate_update) return false;
      bool wanted = false;
      double until = time;
      i.mode = fmu::kIntermediate;
      callbacks.intermediate_update(callbacks.environment, time, true, true, true,
                                    callbacks.early_return_allowed, &wanted, &until);
      i.mode = fmu::kStep;
      return wanted && callbacks.early_return_allowed && until <= time;
    };
    const bool stops = callbacks.early_return_allowed && callbacks.event_mode_used;
    const bool touched = i.unit.touching();
    *reached = i.step(now, step, stops, part_done);
    *event_needed = callbacks.event_mode_used && touched != i.unit.touching();
    *early_return = *reached < now + step;
  });
}
