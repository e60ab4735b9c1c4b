// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "volcontact/pair/clip/clip.h"
#include "volcontact/pair/interference.h"
#include "volcontact/shape/polytope/face_cells.h"

namespace volcontact {

/// Elastic layers that both solids carry: psi = min(d_A / s_A, d_B / s_B), d_i the depth below the
/// surface of a solid and s_i the share of the compliance that its layer has, s_A + s_B = 1. The
/// pressure is k_v psi, and what follows is per k_v. docs/theory.md, "The potential formulation".
struct PressureField {
  double energy = 0.0;         ///< int psi dV over the overlap [m^4]
  Vec3 force = Vec3::Zero();   ///< on A, -d energy / d x_A [m^3]
  Vec3 couple = Vec3::Zero();  ///< on A, -d energy / d theta_A about the centroid of the site [m^4]
  double error = 0.0;          ///< estimate for the force, where it is not to rounding [m^3]
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
  // Of deeper levels: the solids under the layers and their overlap.
  Shape inner_a = Sphere({}), inner_b = Sphere({});
  std::unique_ptr<InterferenceWorkspace> engines;  ///< made when first wanted
  Interference level;
  /// Cells of the polytopes that were met; a copy of the polytope keeps its data block alive.
  struct CellsOf {
    ConvexPolytope solid;
    std::vector<FaceCell> cells;
  };
  std::vector<CellsOf> cells;
  std::vector<int> stack;  ///< of a walk through a tree
  /// A triangle under a pressure: its corners, and the middles of its sides from each of them on.
  struct Corner {
    Vec3 x;
    double d;  ///< depth in the solid that carries, negative outside
  };
  struct Leaf {
    Corner corners[6];
    Vec3 n;
    double off;  ///< the triangle from its quarters
  };
  std::vector<Leaf> leaves;
  const std::vector<FaceCell>& cells_of(const ConvexPolytope& solid);  ///< made when first wanted
};

/// The site asked for, among all sites of the pair.
struct PressureSite {
  std::span<const VolumeMetrics> sites;  ///< in A's frame
  std::size_t index = 0;
  /// s_A, from 0 (A is rigid) to 1 [-], where both solids can carry a layer. A half-space carries
  /// the whole field, and a solid beside one without layers does.
  double share_of_a = 0.5;
  InterferenceOptions options;  ///< of the overlap

  const VolumeMetrics& metrics() const { return sites[index]; }
  /// The site that a part of the overlap belongs to: the nearest, by the spread of each.
  std::size_t nearest(const Vec3& place) const;
};

/// The field on the solid C that carries it, in C's frame and with the couple about C's origin, as
/// one on A: the other way round where C is B.
PressureField field_on_a(const PressureField& on_carrier, const Pose& X_AC, bool is_a,
                         const Vec3& centroid_A);

/// Whether the field of this pair can be integrated with this engine, and if not, why: a sentence
/// for a message, empty where it can.
std::string why_no_pressure_field(const Shape& a, const Shape& b, Engine engine = Engine::kAuto);
inline bool has_pressure_field(const Shape& a, const Shape& b, Engine engine = Engine::kAuto) {
  return why_no_pressure_field(a, b, engine).empty();
}

/// The field of one site of the pair, in A's frame. Exact for half-spaces, boxes and polytopes;
/// for others a rule whose wrench is the gradient of its energy, or of the integral to `error`.
/// Zero where has_pressure_field() is false.
PressureField pressure_field(const Shape& a, const Shape& b, const Pose& X_AB,
                             const PressureSite& site, PressureScratch& scratch);

}  // namespace volcontact
