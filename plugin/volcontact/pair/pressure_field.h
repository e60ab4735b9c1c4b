// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/metrics/volume_metrics.h"
#include "volcontact/pair/clip.h"
#include "volcontact/shape/shapes.h"

namespace volcontact {

/// Elastic layers that both solids carry: psi = min(d_A / s_A, d_B / s_B), d_i the depth below the
/// surface of a solid and s_i the share of the compliance that its layer has, s_A + s_B = 1. The
/// pressure is k_v psi, and what follows is per k_v. docs/theory.md, "The potential formulation".
struct PressureField {
  double energy = 0.0;         ///< int psi dV over the overlap [m^4]
  Vec3 force = Vec3::Zero();   ///< on A, -d energy / d x_A [m^3]
  Vec3 couple = Vec3::Zero();  ///< on A, -d energy / d theta_A about the centroid of the site [m^4]
};

/// Memory of pressure_field(), reused from call to call.
struct PressureScratch {
  /// psi of the layer under one plane face: at_origin + slope . x, falling towards the face.
  struct Layer {
    double at_origin;
    Vec3 slope;
    bool of_a;

    double operator()(const Vec3& x) const { return at_origin + slope.dot(x); }
  };
  ClipScratch clip;
  CutPolytope overlap;
  std::vector<Layer> layers;
};

/// Whether the field of this pair can be integrated: a half-space with anything, boxes and
/// polytopes with each other, and spheres, ellipsoids and capsules with each other.
bool has_pressure_field(const Shape& a, const Shape& b);

/// The field of one site of the pair, whose metrics are `site`, in A's frame.
/// `share_of_a` [-] is s_A, from 0 (A is rigid) to 1. Of a pair with a half-space that one carries
/// the whole field, whatever the share. Exact for half-spaces, boxes and polytopes; a quadrature
/// for round solids, to 1e-5 of the force without capsules, whose seams leave 2e-3. Zero where
/// has_pressure_field() is false.
PressureField pressure_field(const Shape& a, const Shape& b, const Pose& X_AB,
                             const VolumeMetrics& site, double share_of_a,
                             PressureScratch& scratch) noexcept;

}  // namespace volcontact
