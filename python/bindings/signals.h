// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include "volcontact/base/interrupt.h"

namespace volcontact::python {

/// While it lives, Ctrl-C (any signal that Python handles by an exception) ends a long evaluation.
/// To be made where the interpreter lock is released.
class SignalScope {
 private:
  static void check() {
    const nanobind::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) throw nanobind::python_error();
  }
  InterruptScope scope_{&check};
};

}  // namespace volcontact::python
