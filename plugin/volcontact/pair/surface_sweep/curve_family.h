// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/surface_sweep/face_curve.h"

namespace volcontact {

/// The curves that make up a face: parallel lines in a plane, the rulings of a tube or cone,
/// circles about an axis on an ellipsoid, the section circles of a torus. `u` numbers the curves.
class CurveFamily {
 public:
  /// Of a face, within a box about the origin. empty() when the face does not come there.
  CurveFamily(const SweepFace& face, const Vec3& half);

  bool empty() const { return !(low_ < high_); }
  bool turn() const { return turn_; }  ///< the last curve is the first one
  double low() const { return low_; }
  double high() const { return high_; }

  FaceCurve curve(double u) const;
  /// n dS / (du dt) at the place t of the curve, n out of the face.
  Vec3 element(double u, double t, const Vec3& x) const;
  /// The curve through a place of the face, and where on it.
  void locate(const Vec3& x, double& u, double& t) const;

 private:
  void set_plane(const Vec3& half);
  void set_about_axis(const Vec3& axis, const Vec3& half);
  void set_ball(const Vec3& half);

  const SweepFace& face_;
  Vec3 origin_, e_, f_, axis_;
  Mat3 inverse_;
  double radius_ = 0.0, slope_ = 0.0, scale_ = 0.0;
  double low_ = 0.0, high_ = 0.0;
  bool turn_ = false;
};

}  // namespace volcontact
