// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "volcontact/shape/shapes.h"

namespace volcontact::test {

// Solids written down once more, from their definitions alone: quadric and torus inequalities under
// union, intersection and difference. They share no formula with the shapes of the core, and serve
// the reference integral and the search for poses.

/// Part of a line inside a solid, with the faces that bound it.
struct ReferenceSpan {
  double enter, leave;
  int enter_face, leave_face;
  bool enter_shared = false, leave_shared = false;  ///< both solids have a face there
};

/// Parts of one line, in order.
class ReferenceSpans {
 public:
  int size() const { return size_; }
  const ReferenceSpan& operator[](int i) const { return spans_[static_cast<std::size_t>(i)]; }
  void add(const ReferenceSpan& span) {
    if (span.enter < span.leave && size_ < kMost) spans_[static_cast<std::size_t>(size_++)] = span;
  }
  void clear() { size_ = 0; }

 private:
  static constexpr int kMost = 16;
  std::array<ReferenceSpan, kMost> spans_;
  int size_ = 0;
};

ReferenceSpans both(const ReferenceSpans& a, const ReferenceSpans& b);
ReferenceSpans either(const ReferenceSpans& a, const ReferenceSpans& b);
ReferenceSpans without(const ReferenceSpans& a, const ReferenceSpans& b);

/// F(x) = 1/2 x^T H x + g . x + k <= 0.
struct ReferenceFace {
  Mat3 hessian = Mat3::Zero();
  Vec3 linear = Vec3::Zero();
  double constant = 0.0;
  /// Of a cone, whose F is no convex function: its radius at x is nappe . x + nappe_constant.
  Vec3 nappe = Vec3::Zero();
  double nappe_constant = 0.0;
};

struct ReferenceTerm;

class ReferenceSolid {
 public:
  /// Half-spaces and quadrics that hold together on a convex set; planes come first.
  static ReferenceSolid piece(std::vector<ReferenceFace> faces);
  static ReferenceSolid torus(double major_radius, double minor_radius);
  /// Union of a tube and two balls, as one face: where they meet they are tangent, and rounding
  /// would decide which of them bounds a line.
  static ReferenceSolid capsule(double radius, double half_length, const ReferenceSolid& parts);
  friend ReferenceSolid operator|(const ReferenceSolid& a, const ReferenceSolid& b);
  friend ReferenceSolid operator&(const ReferenceSolid& a, const ReferenceSolid& b);
  friend ReferenceSolid operator-(const ReferenceSolid& a, const ReferenceSolid& b);

  /// The solid placed in W at X_WS.
  ReferenceSolid posed(const Pose& X_WS) const;

  /// Numbers the faces from `first`; returns the next free number.
  int number_faces(int first);

  /// The line (u, v, t), all t.
  ReferenceSpans column(double u, double v) const;

  /// Outward normal of the numbered face at a point of it.
  Vec3 normal(int face, const Vec3& x) const;

  /// 1, or -1 for the face of a member that is cut out of the solid that this is a term of: what is
  /// outward there is inward in that solid.
  double side(int face) const;

  /// The solid as a sum of intersections, from 1 - (1 - a)(1 - b) and a (1 - b): no unions and no
  /// differences are left, so that every term is convex but for tori.
  std::vector<ReferenceTerm> terms() const;

  /// Whether a torus is among its members, which keeps a term from being convex.
  bool has_torus() const;

  /// Keeps in `worst` how far x is outside of the face that it is farthest outside of [m], and the
  /// gradient there, where that is more than `worst` was.
  void cut_at(const Vec3& x, double& worst, Vec3& gradient) const;

 private:
  enum class Kind { kPiece, kTorus, kCapsule, kUnion, kIntersection, kDifference };
  static ReferenceSolid joined(Kind kind, const ReferenceSolid& a, const ReferenceSolid& b);
  ReferenceSpans piece_column(double u, double v) const;
  ReferenceSpans torus_column(double u, double v) const;
  void invert();

  Kind kind_ = Kind::kPiece;
  int first_face_ = 0;
  std::vector<ReferenceFace> faces_;
  double major_radius_ = 0.0, minor_radius_ = 0.0;  // of a capsule: half length and radius
  Pose X_TW_;                                       // of a torus or capsule
  std::vector<ReferenceSolid> parts_;
  bool inverted_ = false;  // of a member: cut out
};

struct ReferenceTerm {
  double sign;
  ReferenceSolid solid;
};

/// The solid of a shape.
ReferenceSolid reference_solid(const Shape& shape);

}  // namespace volcontact::test
