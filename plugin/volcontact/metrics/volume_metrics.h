// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/base/types.h"

namespace volcontact {

/// What the numbers of a VolumeMetrics are worth. Ordered: a sum takes the worst.
enum class Status : int {
  kOk = 0,           ///< within `volume_error`
  kContained = 1,    ///< one solid inside the other: the volume is right, there is no direction
  kApproximate = 2,  ///< a budget ended the refinement: `volume_error` exceeds the tolerance
  kUnbounded = 3,    ///< the overlap has no finite volume: zero metrics
  kInvalid = 4,      ///< non-finite pose or size: zero metrics
};

const char* to_string(Status status);

/// Metrics of the interference volume Omega = A intersect B, expressed in one frame and about its
/// origin. docs/theory.md, "Volume metrics".
struct VolumeMetrics {
  double volume = 0.0;              ///< V [m^3]
  Vec3 centroid = Vec3::Zero();     ///< of Omega [m]
  Mat3 inertia = Mat3::Zero();      ///< about the centroid, unit density [m^5]
  Vec3 area_vector = Vec3::Zero();  ///< S = int n_A dS over A's surface inside B = dV/dx_A [m^2]
  Vec3 area_moment = Vec3::Zero();  ///< T = int x cross n_A dS, same surface = dV/dtheta_A [m^3]
  double area = 0.0;                ///< of A's surface inside B [m^2]
  double counter_area = 0.0;        ///< of B's surface inside A [m^2]
  double depth_moment = 0.0;        ///< int L^2/2 dA, L = column length along the normal [m^4]
  double depth = 0.0;               ///< longest column along the normal [m]
  double volume_error = 0.0;        ///< bound (or estimate, see the engine) of |error of V| [m^3]
  Status status = Status::kOk;

  bool touching() const { return volume > 0.0; }
  bool operator==(const VolumeMetrics&) const = default;

  /// Contact normal on A, from B to A: -S/|S|; zero when S vanishes.
  Vec3 normal() const {
    // A closed surface sums to rounding, which has a direction too: (|S| / V^(2/3))^3 of it.
    constexpr double kRounding = 1e-39;
    const double length = area_vector.norm();
    const bool has_direction = length * length * length > kRounding * volume * volume;
    return has_direction ? Vec3(-area_vector / length) : Vec3::Zero();
  }

  /// |S| / area of the smaller of the two surfaces, 1 for a flat patch; when small, the normal
  /// means little (a plate pierced by a peg).
  double flatness() const;

  /// int (x - c)(x - c)^T dV about the centroid [m^5].
  Mat3 second_moment() const;
};

/// The same metrics expressed in W and about W's origin, given X_WF of the present frame F.
VolumeMetrics transformed(const VolumeMetrics& metrics_F, const Pose& X_WF);
/// In place.
void transform(const Pose& X_WF, VolumeMetrics& metrics);

/// The same region seen with the roles of A and B exchanged, in the same frame: S and T change sign
/// because the whole surface of Omega is closed.
VolumeMetrics reversed(const VolumeMetrics& metrics);
/// In place.
void reverse(VolumeMetrics& metrics);

/// Metrics of the union of two disjoint regions of one pair, in one frame: everything adds,
/// the inertia by the parallel axis theorem; depth is the larger one, status the worse one.
VolumeMetrics operator+(const VolumeMetrics& a, const VolumeMetrics& b);

/// Raw sums an engine accumulates, about the origin of its working frame.
struct MomentSum {
  double volume = 0.0;              ///< int 1 dV
  Vec3 first = Vec3::Zero();        ///< int x dV
  Mat3 second = Mat3::Zero();       ///< int x x^T dV
  Vec3 area_vector = Vec3::Zero();  ///< int n_A dS
  Vec3 area_moment = Vec3::Zero();  ///< int x cross n_A dS
  double area = 0.0;
  double counter_area = 0.0;

  MomentSum& operator+=(const MomentSum& other);

  /// Metrics without the depth fields; zero volume gives zero metrics.
  VolumeMetrics metrics() const;
};

/// All numbers finite.
bool is_finite(const VolumeMetrics& metrics);

}  // namespace volcontact
