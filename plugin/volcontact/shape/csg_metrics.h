// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/shape/csg.h"

namespace volcontact {

/// Volume, centroid and inertia of the solid: the bodies of its carved pieces less the tubes, cones
/// and balls cut out of them, where these stand free in closed form; else the quadrature.
VolumeMetrics csg_own_metrics(const Csg& solid);

/// The same from the lengths of lines through the solid, integrated adaptively to 1e-8 of the
/// volume. Tori about more than one direction are left to bisection: to about 1e-4.
VolumeMetrics csg_metrics_by_lines(const Csg& solid);

}  // namespace volcontact
