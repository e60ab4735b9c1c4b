// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

namespace volcontact::python {

// One function a floor of the core, in floor order.
void bind_metrics(nanobind::module_& m);
void bind_shapes(nanobind::module_& m);
void bind_signed_distance(nanobind::module_& m);
void bind_interference(nanobind::module_& m);
void bind_laws(nanobind::module_& m);
void bind_own_laws(nanobind::module_& m);
void bind_model(nanobind::module_& m);

/// Last: has everything that can be called answer wrong arguments by one line that names them.
void speak_plainly(nanobind::module_& m);

}  // namespace volcontact::python
