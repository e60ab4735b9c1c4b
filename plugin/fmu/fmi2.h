// SPDX-License-Identifier: Apache-2.0
#pragma once

// The types of FMI 2.0 (fmi-standard.org) that its functions take, in our own words.

#include <cstddef>

#if defined(_WIN32)
#define FMI2_EXPORT extern "C" __declspec(dllexport)
#else
#define FMI2_EXPORT extern "C" __attribute__((visibility("default")))
#endif

namespace volcontact::fmi2 {

using Component = void*;
using Reference = unsigned int;
using Bool = int;
using Text = const char*;

enum Kind : int { kModelExchange = 0, kCoSimulation = 1 };
enum StatusKind : int { kDoStepStatus, kPendingStatus, kLastSuccessfulTime, kIsTerminated };

struct Callbacks {
  void (*logger)(void* environment, Text instance, int status, Text category, Text message, ...);
  void* (*allocate)(std::size_t count, std::size_t size);
  void (*release)(void* memory);
  void (*step_finished)(void* environment, int status);
  void* environment;
};

struct EventInfo {
  Bool new_discrete_states_needed;
  Bool terminate_simulation;
  Bool nominals_of_continuous_states_changed;
  Bool values_of_continuous_states_changed;
  Bool next_event_time_defined;
  double next_event_time;
};

}  // namespace volcontact::fmi2
