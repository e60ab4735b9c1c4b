// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/shape/csg/csg.h"

namespace volcontact {

/// Volume, centroid and inertia of the solid: the bodies of its carved pieces less the tubes, cones
/// and balls cut out of them, where these stand free in closed form; else the quadrature, with a
/// budget.
VolumeMetrics csg_own_metrics(const Csg& solid);

/// Work that csg_own_metrics spends on lines, in members that a line is cut with (a torus counts
/// 40): about a second.
inline constexpr double kMostLineWork = 4e6;

/// The same from the lengths of lines through the solid, integrated adaptively to 1e-8 of the
/// volume; tori about more than one direction, which are left to bisection, to about 1e-4. Where
/// that takes more than `most_work`: from a fixed number of lines, with Status::kApproximate and an
/// estimate of the error in volume_error. The same bits on every machine.
VolumeMetrics csg_metrics_by_lines(const Csg& solid, double most_work = kInfinity);

}  // namespace volcontact
