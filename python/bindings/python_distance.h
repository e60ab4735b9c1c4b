// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace volcontact::python {

/// Forgets what a Python signed distance threw on this thread. Call before the octree may run.
void clear_distance_error();

/// Throws what a Python signed distance threw on this thread since, if anything. Needs the
/// interpreter lock.
void rethrow_distance_error();

}  // namespace volcontact::python
