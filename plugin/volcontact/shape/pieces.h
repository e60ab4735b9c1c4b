// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "volcontact/base/types.h"

namespace volcontact {

/// How a face is bent, seen from outside; decides on which side of its tangent planes the solid
/// lies.
enum class Bend : signed char {
  kConeHole = -2,  ///< hessian indefinite, the wall of a conical bore
  kConcave = -1,   ///< hessian negative semidefinite: the wall of a bore
  kFlat = 0,       ///< no hessian
  kConvex = 1,     ///< hessian positive semidefinite: a ball, a cylinder
  kCone = 2,       ///< hessian indefinite, but convex on the one nappe that belongs to the solid
};

/// One face of a solid: the solid lies where F(x) = 1/2 x^T H x + g . x + k <= 0. F may have any
/// scale. A seam is a face between two pieces of one solid: it bounds the piece, but it is not
/// surface.
struct Quadric {
  Mat3 hessian = Mat3::Zero();
  Vec3 linear = Vec3::Zero();
  double constant = 0.0;
  Bend bend = Bend::kFlat;
  bool seam = false;
  /// The nappe of a cone that belongs to the solid is where nappe_offset + nappe . x >= 0.
  Vec3 nappe = Vec3::Zero();
  double nappe_offset = 0.0;

  double operator()(const Vec3& x) const {
    return constant + x.dot(linear) + 0.5 * x.dot(hessian * x);
  }

  /// normal . x <= offset.
  static Quadric plane(const Vec3& normal, double offset);
  static Quadric seam_plane(const Vec3& normal, double offset);
  /// Inside of sum_i weights_i (x_i - center_i)^2 <= level: ball, ellipsoid or round tube.
  static Quadric round(const Vec3& weights, const Vec3& center, double level);
  /// Inside of x^2 + y^2 <= (radius + slope z)^2. It has two nappes: a piece with such a face must
  /// have planes that keep it on the one where radius + slope z >= 0.
  static Quadric cone(double radius, double slope);
  /// The solid outside of this face instead of inside.
  Quadric reversed() const;
};

/// The same face in frame W, given X_SW of the frame S it is written in.
Quadric transformed(const Quadric& face_S, const Pose& X_SW);

/// A solid as a union of pieces with disjoint interiors, each the intersection of its faces. A
/// shape that can be written so offers `void pieces(PieceList&) const`: its overlaps are then cut
/// with the exact faces. docs/theory.md, "Octree".
class PieceList {
 public:
  void clear() { faces_.clear(), ends_.clear(); }
  /// Adds a face to the piece that is being written.
  void add(const Quadric& face) { faces_.push_back(face); }
  /// Ends the piece; the next face begins another one.
  void end_piece() { ends_.push_back(static_cast<int>(faces_.size())); }

  int size() const { return static_cast<int>(ends_.size()); }
  const Quadric* begin(int piece) const {
    return faces_.data() + (piece == 0 ? 0 : ends_[piece - 1]);
  }
  const Quadric* end(int piece) const { return faces_.data() + ends_[piece]; }

 private:
  std::vector<Quadric> faces_;
  std::vector<int> ends_;
};

/// Pieces from the parts that a solid writes: solid.h, "write_parts".
class PieceWriter {
 public:
  explicit PieceWriter(PieceList& list) : list_(list) {}
  /// normal . x <= offset.
  void plane(const Vec3& normal, double offset, bool seam) {
    list_.add(seam ? Quadric::seam_plane(normal, offset) : Quadric::plane(normal, offset));
  }
  /// Within `radius` of the line through `center` along an axis.
  void tube(int axis, double radius, const Vec3& center);
  void ball(double radius, const Vec3& center);
  void end_part() { list_.end_piece(); }

 private:
  PieceList& list_;
};

}  // namespace volcontact
