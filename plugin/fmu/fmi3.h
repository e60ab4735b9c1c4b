// SPDX-License-Identifier: Apache-2.0
#pragma once

// The types of FMI 3.0 (fmi-standard.org) that its functions take, in our own words.

#include <cstddef>
#include <cstdint>

#if defined(_WIN32)
#define FMI3_EXPORT extern "C" __declspec(dllexport)
#else
#define FMI3_EXPORT extern "C" __attribute__((visibility("default")))
#endif

namespace volcontact::fmi3 {

using Handle = void*;
using Reference = std::uint32_t;
using Text = const char*;
using Environment = void*;
using Log = void (*)(Environment environment, int status, Text category, Text message);
using IntermediateUpdate = void (*)(Environment environment, double time, bool set_requested,
                                    bool get_allowed, bool step_finished, bool can_return_early,
                                    bool* early_return_requested, double* early_return_time);

}  // namespace volcontact::fmi3
