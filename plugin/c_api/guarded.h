// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

#include "c_api/volcontact.h"
#include "volcontact/base/types.h"

namespace volcontact::c_api {

/// Keeps the text for vc_error(). Never throws.
int fail(int code, const char* text) noexcept;

/// The text of the last failure in this thread.
const char* message() noexcept;

/// Keeps the text of the exception that is handled; its code.
int fail_by_exception() noexcept;

/// Runs what may throw: its result, or an error code. No exception leaves the interface.
template <typename Function>
int guarded(Function&& function) noexcept {
  try {
    return function();
  } catch (...) {
    return fail_by_exception();
  }
}

/// Like require, but the message is only made where it is needed: an evaluation allocates nothing.
template <typename Message>
void check(bool condition, Message&& message) {
  if (!condition) throw std::invalid_argument(message());
}

/// Throws std::invalid_argument naming function and argument where the pointer is null.
void require_given(const void* pointer, const char* function, const char* argument);

/// A pose from 16 numbers, identity from null. Throws std::invalid_argument where they are no
/// rotation and translation; `name` is for the message.
Pose pose_from(const double* matrix, const char* name);
void copy_pose(const Pose& pose, double* matrix) noexcept;

/// Throws std::invalid_argument where a number is not finite.
Twist twist_from(const double* numbers, const char* name);

/// Copies as much as there is room for, with a final zero; returns the length of all of it.
int copy_text(const std::string& text, char* buffer, int capacity) noexcept;

}  // namespace volcontact::c_api
