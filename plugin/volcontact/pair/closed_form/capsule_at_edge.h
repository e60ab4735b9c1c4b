// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "volcontact/metrics/volume_metrics.h"
#include "volcontact/pair/closed_form/faces_met.h"

namespace volcontact {

/// A capsule about the z axis of A, or a ball, cut by two planes that meet in an edge: the overlap
/// is what of it is behind both. docs/theory.md, "Two faces".
///
/// Half-planes that turn about the edge from one face to the other cut the overlap in sections,
/// which are bounded by the edge and by arcs of circles and ellipses. In a section the integrals are
/// line integrals along these arcs; over the angle they are summed by a Gauss rule.
///
/// The edge frame E has its origin in the middle of the part of the edge within the solid. Its x
/// axis lies in the first face, away from the edge, y is into the solid of the faces, z along the
/// edge.
class CapsuleAtEdge {
 public:
  /// Half length 0: a ball.
  CapsuleAtEdge(double radius, double half_length, const FaceMet& first, const FaceMet& second);

  /// Whether the edge passes through the solid, and the planes are neither parallel nor nearly so.
  /// All below is for where it does.
  bool is_cut() const { return is_cut_; }

  /// How far the overlap extends along a direction of A, from A's origin.
  double reach(const Vec3& e) const;

  /// In A, about A's origin. Zero where a column along the normal would not end on the faces, or
  /// where the surface found is not closed.
  VolumeMetrics metrics() const;

 private:
  struct Section;
  struct Sums;
  struct Breaks;
  struct View;
  struct Way;
  struct Scale;

  bool find_edge(const FaceMet& first, const FaceMet& second);
  void find_middle();
  double way_out(const Vec3& from, const Vec3& along) const;
  double reach_in_face(const Vec3& e, int face, bool& within) const;
  bool is_behind(int face, const Vec3& x) const;

  View view(double angle) const;
  Section section(double angle) const;
  void add_cap(const View& view, int end, Section& s) const;
  void add_side(const View& view, double side, Section& s) const;
  Breaks breaks(double normal_angle) const;
  Way way(const Breaks& breaks, int i) const;
  void add_piece(const Way& way, double normal_angle, Sums& sum) const;
  void add_closed(const Way& way, double normal_angle, const Scale* scale, int halvings,
                  Sums& sum) const;
  Sums sums(double normal_angle, const Scale* scale) const;
  static double gap(const Sums& sum, const Section& from, const Section& to, const Scale& scale);

  double radius_, half_length_;
  std::array<FaceMet, 2> faces_;
  bool is_cut_ = false;
  Pose X_AE_;
  double opening_ = 0.0;     // angle between the faces [rad]
  double half_edge_ = 0.0;   // half the part of the edge within the solid [m]
  Vec3 origin_ = {}, axis_ = {};  // of A, in E
  double flat_angle_ = 0.0;  // of a half-plane along the surface that is nearest to the edge [rad]
  double flat_scale_ = 1.0;  // how far from it sections change much [rad]
};

}  // namespace volcontact
