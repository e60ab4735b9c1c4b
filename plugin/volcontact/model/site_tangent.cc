// SPDX-License-Identifier: Apache-2.0
#include "volcontact/model/site_tangent.h"

#include <algorithm>
#include <cmath>

namespace volcontact {
namespace {

// The mean of q q^T with q = (1, y, -x), which is how a point (x, y) of the plane moves along n.
Mat3 mean_square(const Vec2& mean, const Mat2& spread) {
  return {1.0,       mean.y(),      -mean.x(),      //
          mean.y(),  spread(1, 1),  -spread(0, 1),  //
          -mean.x(), -spread(0, 1), spread(0, 0)};
}

// Of the rows and columns along n, about t_1, about t_2, and of friction: along t_1 and t_2, about
// n.
Mat6 in_world(const Mat3& axes, const Mat3& normal, double along, double about) {
  const Mat3 turn(normal(1, 1), normal(1, 2), 0.0, normal(2, 1), normal(2, 2), 0.0, 0.0, 0.0,
                  about);
  Mat3 both = Mat3::Zero();
  both.col(2) = {normal(1, 0), normal(2, 0), 0.0};
  const Mat3 push = Vec3(along, along, normal(0, 0)).asDiagonal();
  const Mat3 to_site = axes.transpose();
  const Mat3 beside = axes * both * to_site;
  Mat6 m;
  m.set_block(0, 0, axes * turn * to_site);
  m.set_block(0, 3, beside);
  m.set_block(3, 0, beside.transpose());
  m.set_block(3, 3, axes * push * to_site);
  return m;
}

}  // namespace

PatchMoments patch_moments(const VolumeMetrics& metrics_W, const Mat3& axes) noexcept {
  PatchMoments patch;
  patch.area = metrics_W.area_vector.norm();
  if (!(patch.area > 0.0) || !(metrics_W.volume > 0.0)) return patch;
  const Vec3 &t_1 = axes.col(0), &t_2 = axes.col(1), &n = axes.col(2);
  // T about the centroid, per area: (r x n) of the patch's centre r, turned round.
  const Vec3 turned =
      (metrics_W.centroid.cross(metrics_W.area_vector) - metrics_W.area_moment) / patch.area;
  const Vec3 centre = n.cross(turned);
  const Mat3 second = metrics_W.second_moment();
  const Vec3 along_1 = second * t_1, along_2 = second * t_2;
  const double mixed = t_1.dot(along_2);
  patch.offset = {t_1.dot(centre), t_2.dot(centre)};
  patch.weighed = Mat2(t_1.dot(along_1), mixed, mixed, t_2.dot(along_2)) / metrics_W.volume;

  // About the patch's centre the volume and the patch have the same second moments where the depth
  // is linear. A smooth body pushed in has those of a paraboloid, 2/3 of an ellipse's; which of the
  // two it is shows in the area.
  const Mat2 square = outer(patch.offset, patch.offset);
  const Mat2 about_centre = patch.weighed + square;
  const double ratio = kPi * std::sqrt(std::max(0.0, about_centre.determinant())) / patch.area;
  const double paraboloid = std::clamp(12.0 * (0.25 - ratio), 0.0, 1.0);
  patch.spread = 0.25 / (0.25 - paraboloid / 12.0) * about_centre + square;
  return patch;
}

Mat6 SiteTangent::stiffness_W() const {
  return in_world(axes, stiffness, friction.stiffness,
                  friction.stiffness * friction.lever * friction.lever);
}

Mat6 SiteTangent::damping_W() const {
  return in_world(axes, damping, friction.damping,
                  friction.damping * friction.lever * friction.lever);
}

SiteTangent site_tangent(const VolumeMetrics& metrics_W, const Mat3& axes,
                         const NormalSlope& normal, double rolling_damping,
                         const FrictionSlope& friction) noexcept {
  const PatchMoments patch = patch_moments(metrics_W, axes);
  SiteTangent tangent;
  tangent.axes = axes;
  tangent.friction = friction;
  tangent.stiffness = normal.stiffness * patch.area * mean_square(patch.offset, patch.spread);
  tangent.damping = rolling_damping * metrics_W.volume * mean_square(Vec2::Zero(), patch.weighed);
  tangent.damping(0, 0) = normal.damping;
  return tangent;
}

}  // namespace volcontact
