// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace volcontact::python {

/// Raises what a law written in Python raised during the evaluation before, if it did.
void rethrow_law_error();

}  // namespace volcontact::python
