// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "volcontact/metrics/volume_metrics.h"
#include "volcontact/pair/closed_form/edge_sections.h"
#include "volcontact/pair/closed_form/faces_met.h"

namespace volcontact {

/// A capsule about the z axis of A, or a ball, cut by two planes that meet in an edge: the overlap
/// is what of it is behind both. docs/theory.md, "Two faces".
///
///   V = int dphi int rho dA
/// over half-planes that turn about the edge from one face to the other, rho the distance from the
/// edge. They cut the overlap in sections whose outline consists of the edge and arcs of circles
/// and ellipses.
///
/// The edge frame E has its origin in the middle of the part of the edge within the solid. Its x
/// axis lies in the first face, y points away from it into the overlap, z along the edge.
class CapsuleAtEdge {
 public:
  /// Half length 0: a ball.
  CapsuleAtEdge(double radius, double half_length, const FaceMet& first, const FaceMet& second);

  /// Whether the edge passes through the solid, and the planes are far from parallel. All below is
  /// for where it does.
  bool is_cut() const { return is_cut_; }

  /// The most of x . e for places x of the overlap, in A.
  double reach(const Vec3& e) const;

  /// Whether the columns along n, which go on to the two faces where the solid has its own top
  /// below them, end behind another face; if in doubt not.
  bool is_roof_behind(const FaceMet& other, const Vec3& n) const;

  /// In A, about A's origin; the depth is the extent along the normal. Zero where a column along
  /// the normal would not end at a face, or where the surface does not come out closed.
  VolumeMetrics metrics() const;

 private:
  struct Sums;
  struct Breaks;
  struct Way;
  struct Scale;

  bool find_edge();
  bool find_middle();
  void find_flat(const Vec3& nearest, const Vec3& out, double depth);
  double way_out(const Vec3& from, const Vec3& along) const;
  bool reaches_in_face(const Vec3& e, int face, double& reach) const;
  bool is_behind(int face, const Vec3& x) const;

  EdgeSection section(double angle) const;
  void add_touches(int end, Breaks& breaks) const;
  Breaks breaks(double normal_angle) const;
  Way way(const Breaks& breaks, int i) const;
  Way way_about(double flat, double scale, double from, double to) const;
  void add_piece(const Way& way, double normal_angle, Sums& sum) const;
  void add_closed(const Way& way, double normal_angle, const Scale& scale, int halvings,
                  Sums& sum) const;
  Sums sums(double normal_angle, const Scale* scale) const;
  static double gap(const Sums& sum, const EdgeSection& from, const EdgeSection& to,
                    const Scale& scale);

  std::array<FaceMet, 2> faces_;
  bool is_cut_ = false;
  Pose X_AE_;
  EdgeSections sections_;    // in E
  double opening_ = 0.0;     // angle between the faces [rad]
  double flat_angle_ = 0.0;  // of a half-plane along the surface that is nearest to the edge [rad]
  double out_angle_ = 0.0;   // of the way out of the solid there [rad]
  double flat_scale_ = 1.0;  // how far from it sections change much [rad]
};

}  // namespace volcontact
