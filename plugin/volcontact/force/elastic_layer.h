// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace volcontact {

// From material data to the parameters of the normal laws: docs/theory.md, "Materials". Each throws
// std::invalid_argument on values that no material has.

/// k [N/m^3] of a layer of Young's modulus [Pa] and thickness [m] that may bulge sideways: E / H.
double layer_stiffness(double modulus, double thickness);

/// The same for a layer that may not bulge: (1 - nu) E / ((1 + nu) (1 - 2 nu) H).
double confined_layer_stiffness(double modulus, double thickness, double poisson_ratio);

/// k_v [N/m^3] of two layers in series.
double series_stiffness(double stiffness_a, double stiffness_b);

/// a [s/m] of two layers in series, each with the damping it would have against a rigid body.
double series_damping(double stiffness_a, double damping_a, double stiffness_b, double damping_b);

/// What the first of two layers in series takes of the whole deformation [-].
double share_of_first(double stiffness_a, double stiffness_b);

/// e [-] of two layers in series, each with the restitution it would have against a rigid body, all
/// at one impact speed.
double series_restitution(double stiffness_a, double restitution_a, double stiffness_b,
                          double restitution_b);

}  // namespace volcontact
