// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/base/types.h"
#include "volcontact/force/friction.h"
#include "volcontact/force/normal_force.h"
#include "volcontact/metrics/volume_metrics.h"

namespace volcontact {

using Mat6 = Matrix<6, 6>;

/// What is known of the patch of a site, in its plane through the centroid of the volume:
/// coordinates along the first two axes of the frame.
struct PatchMoments {
  double area = 0.0;            ///< |S| [m^2]
  Vec2 offset = Vec2::Zero();   ///< of the patch's centre from there [m]
  Mat2 spread = Mat2::Zero();   ///< mean r r^T over the patch [m^2]
  Mat2 weighed = Mat2::Zero();  ///< mean r r^T over the volume [m^2]
};

/// Area and offset are exact: they are dV/dx and dV/dtheta. The spread follows from the moments of
/// the volume: exactly for a depth that is linear over a patch with a centre of symmetry, and for
/// the shallow cap of a smooth body. docs/theory.md, "Stiffness of a site".
PatchMoments patch_moments(const VolumeMetrics& metrics_W, const Mat3& axes) noexcept;

/// How the wrench on A at a contact site changes when A moves against B: the relative motion is a
/// displacement of A at the centroid and a turn about it, the wrench is the force and the torque
/// about that point of A. docs/theory.md, "Stiffness of a site".
struct SiteTangent {
  Mat3 axes = Mat3::Identity();  ///< of the site in the world, by columns: t_1, t_2, n

  // Of the normal force and the rolling torque; rows and columns: along n, about t_1, about t_2.
  // Symmetric and positive semidefinite.
  Mat3 stiffness = Mat3::Zero();  ///< [N/m, N, N m]
  Mat3 damping = Mat3::Zero();    ///< [N s/m, N s, N m s]

  FrictionSlope friction;  ///< along t_1, along t_2, lever times about n

  /// All of it in the world frame; rows and columns: torque or turn, then force or displacement.
  Mat6 stiffness_W() const;
  Mat6 damping_W() const;
};

/// The tangent of a site from its metrics, the axes t_1, t_2, n, and the derivatives of its laws;
/// `rolling_damping` [N s/m^4] as the normal law gives it, 0 without rolling resistance.
SiteTangent site_tangent(const VolumeMetrics& metrics_W, const Mat3& axes,
                         const NormalSlope& normal, double rolling_damping,
                         const FrictionSlope& friction) noexcept;

}  // namespace volcontact
