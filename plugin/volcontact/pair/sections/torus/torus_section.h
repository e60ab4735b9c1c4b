// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/pair/sections/section.h"

namespace volcontact {

/// A ring about the z axis, and the faces of a convex body, in the ring's frame. Plain data: see
/// SectionFaces.
struct TorusFaces {
  SectionFaces sections;  ///< the last round face stands for the tube of the ring
  double major = 0.0, minor = 0.0;
  /// Of a cone: y_z = at + rho (per_u cos + per_v sin) + per_t z, positive on its nappe.
  struct Nappe {
    bool cone;
    double at, per_u, per_v, per_t;
  };
  Nappe nappes[SectionFaces::kMaxRounds];
};

/// Sums over sections of the overlap, in the ring's frame and about its center.
struct TorusSums {
  double moments[10];    ///< int dV times 1, x, y, z, xx, xy, yy, xz, yz, zz
  double radial;         ///< int rho dV
  double area;           ///< of the ring's surface in the body
  double vector[3];      ///< int n dS over it
  double moment[2];      ///< x and y of int x cross n dS; that about the axis vanishes
  double least_inside;   ///< least squared distance from the middle of the tube
  double across_rho[3];  ///< int n_rho rho dS over it, times xx, xy, yy of the direction
  SectionSums::OnRound rounds[SectionFaces::kMaxRounds];  ///< of the body in the ring; no zz
  SectionSums::OnPlane* planes;                           ///< as many as there are planes
};

/// The overlap of a ring and a convex body in half-planes through the axis of the ring, eight at a
/// time. There the ring is a disc, the body's faces are lines and arcs, and what they have in
/// common is convex. Columns run along the axis. A section begins in a column inside, found by
/// golden section as their length is a concave function of the place, and is followed as in
/// Sections to either side. docs/theory.md, "Tori".
///
///   V = int dphi int rho (h_top - h_bottom) drho,   rho from the axis of the ring
class TorusSection {
 public:
  /// The faces are those of the body alone, owned by Owner::kB.
  void set(const FaceSet& faces, double major_radius, double minor_radius);
  /// For what set() brings next; as Sections::choose_rule().
  void choose_rule(double tolerance) { sections_.choose_rule(tolerance); }
  /// For what set() brings next; as Sections::look_closer().
  void look_closer() { sections_.look_closer(); }
  const TorusFaces& faces() const { return faces_; }
  /// The plane of the body behind a plane of the sums.
  int plane_face(int i) const { return faces_.sections.planes[i].face; }

  /// For eight directions (cos, sin): the length of about the longest column; not positive where
  /// there is none.
  void probe(SimdPath path, const double* cos, const double* sin, double* length);

  /// Sums over eight half-planes that stand for `angle` each. `section` gets the volume of each per
  /// angle.
  void integrate(SimdPath path, const double* cos, const double* sin, const double* angle,
                 double* section);

  const TorusSums& batch() const { return batch_; }
  const TorusSums& total() const { return total_; }
  void accept_batch();
  void clear() { clear(total_, total_planes_); }

 private:
  void clear(TorusSums& sums, std::vector<SectionSums::OnPlane>& planes) const;

  Sections sections_;
  std::vector<PlaneFace> no_idle_;
  TorusFaces faces_;
  TorusSums batch_, total_;
  std::vector<SectionSums::OnPlane> batch_planes_, total_planes_;
  struct alignas(64) Lane {
    double x[kLanes];
  };
  std::vector<Lane> work_;
};

}  // namespace volcontact
