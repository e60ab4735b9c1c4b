// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/base/types.h"

namespace volcontact {

inline double square_of(double x) { return x * x; }

/// Integrals over a section by a half-plane that ends at an edge: y along the edge, rho away from
/// it.
struct EdgeSection {
  double area = 0.0, area_y = 0.0;                           ///< int 1, y
  double rho = 0.0, rho_rho = 0.0, rho_y = 0.0;              ///< int rho times 1, rho, y
  double rho_rho_rho = 0.0, rho_rho_y = 0.0, rho_y_y = 0.0;  ///< int rho times rho^2, rho y, y^2
  double surface = 0.0;               ///< of the solid, per angle of the half-plane
  double flux = 0.0, rho_flux = 0.0;  ///< of the same, across the half-plane: int 1, rho

  /// Of a piece of the outline, counterclockwise: sums of rho^k y^i dy, which are the integrals but
  /// for factors, since rho vanishes along the edge.
  void add(double r, double y, double dy) {
    const double one = r * dy, two = r * one, three = r * two;
    area += one;
    area_y += y * one;
    rho += two;
    rho_y += y * two;
    rho_y_y += y * y * two;
    rho_rho += three;
    rho_rho_y += y * three;
    rho_rho_rho += r * three;
  }
  /// Of a piece of the solid's surface that is `turn` wide per distance from the edge, where the
  /// outward normal has the part `across` against the turn of the half-plane.
  void add_surface(double r, double turn, double across) {
    const double one = turn * r;
    surface += one;
    flux -= across * one;
    rho_flux -= across * r * one;
  }
  EdgeSection& operator+=(const EdgeSection& o) {
    area += o.area, area_y += o.area_y;
    rho += o.rho, rho_rho += o.rho_rho, rho_y += o.rho_y;
    rho_rho_rho += o.rho_rho_rho, rho_rho_y += o.rho_rho_y, rho_y_y += o.rho_y_y;
    surface += o.surface, flux += o.flux, rho_flux += o.rho_flux;
    return *this;
  }
  /// The factors.
  void finish() {
    rho *= 0.5, rho_y *= 0.5, rho_y_y *= 0.5;
    rho_rho *= 1.0 / 3.0, rho_rho_y *= 1.0 / 3.0;
    rho_rho_rho *= 0.25;
  }
};

/// What a half-plane sees of the axis of a capsule: parts along the half-plane, away from the edge,
/// and across it.
struct EdgeView {
  double rho, across, y;  ///< of the middle of the capsule
  double axis_rho, axis_across, axis_y;
  double lean;          ///< of the axis in the half-plane: its length
  double cosine, sine;  ///< its direction there
};

/// A capsule, or a ball, that an edge passes through: its sections by half-planes from the edge.
/// The edge is the z axis, the middle of its part within the solid the origin.
/// docs/theory.md, "Two faces".
struct EdgeSections {
  double radius, half_length;  ///< half length 0: a ball
  Vec3 origin, axis;           ///< of the capsule
  double half_edge;            ///< half the part of the edge within it [m]

  /// By the half-plane at an angle to x about the edge.
  EdgeView view(double cosine, double sine) const;
  EdgeSection at(double cosine, double sine) const;

 private:
  void add_cap(const EdgeView& v, int end, EdgeSection& section) const;
  void add_side(const EdgeView& v, double side, EdgeSection& section) const;
};

}  // namespace volcontact
