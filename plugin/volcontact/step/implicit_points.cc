// SPDX-License-Identifier: Apache-2.0
// The points at which ImplicitStep has a patch borne.
#include <algorithm>
#include <cmath>

#include "volcontact/base/sizes.h"
#include "volcontact/base/symmetric_eigen.h"
#include "volcontact/step/explicit_bounds.h"
#include "volcontact/step/implicit_step.h"

namespace volcontact {
namespace {

// What lies below this bound is left to the explicit force; in between it is shared.
constexpr double kSoftNumber = 0.2 * kStiffNumber;

double implicit_share(double stiffness_number) {
  return std::clamp((stiffness_number - kSoftNumber) / (kStiffNumber - kSoftNumber), 0.0, 1.0);
}

// How much a point settles that comes out of the overlap at `speed`, where free motion changes
// speeds by `fall` in a step: what is as slow as a few of these.
double settling(double speed, double fall) {
  constexpr double kSettles = 5.0, kBounces = 10.0;
  if (!(fall > 0.0) || speed >= kBounces * fall) return 0.0;
  if (speed <= kSettles * fall) return 1.0;
  return (kBounces - speed / fall) / (kBounces - kSettles);
}

// Numerical damping of what settles, as a multiple of h K: with less a box rocks from edge to edge
// for ever.
constexpr double kSettling = 1.5;

// The same of all where the force is held while positions move with the mean of the velocities
// before and after the step: without it a stiff contact overshoots, and lifts off again and again.
double holding(double stiffness_number) {
  constexpr double kMost = 2.0, kHalf = 10.0;
  return kMost * stiffness_number / (stiffness_number + kHalf);
}

}  // namespace

// The points of a patch and what each bears: f = f_0 - D (u' - u) - h K u', with the damping's
// share of f_0 taken out again, so that the constant is what a motionless contact would bear.
void ImplicitStep::place_points(Site& site, const Mat3& mobility, const Vec3& falling,
                                double resting, ImplicitParts parts, double step) {
  const SiteReport& report = site.report->sites[site.index];
  const SiteTangent& tangent = site.tangent;
  const double k = tangent.stiffness(0, 0), damping = tangent.damping(0, 0);
  const double force = report.normal_force - damping * report.approach_speed;
  const Vec3 torque = tangent.axes.transpose() * site.report->inputs[site.index].elastic_torque;
  // The patch's centre and spread, back from the stiffness: k (1, y, -x) (1, y, -x)'.
  Vec2 centre = Vec2::Zero();
  Mat2 spread = Mat2::Zero();
  if (k > 0.0) {
    centre = Vec2(-tangent.stiffness(0, 2), tangent.stiffness(0, 1)) / k;
    const Mat2 about_centroid(tangent.stiffness(2, 2), -tangent.stiffness(1, 2),
                              -tangent.stiffness(1, 2), tangent.stiffness(1, 1));
    spread = about_centroid / k - outer(centre, centre);
  }
  // Where the force acts, times the force.
  const Vec2 moment(-torque[1], torque[0]);
  const auto principal = symmetric_eigen(spread);
  const double number = step * step * k;
  const double share =
      parts == ImplicitParts::kStiff ? implicit_share(number * mobility(0, 0)) : 1.0;

  Vec2 place = Vec2::Zero();  // of all points together
  if (force > 0.0) place = moment / force;
  double reach[2] = {0.0, 0.0}, lean[2] = {0.0, 0.0};
  bool split[2] = {false, false};
  for (int i = 0; i < 2; ++i) {
    const Vec2 axis = principal.vectors.col(i);
    const double square = std::max(0.0, principal.values[i]);
    const Vec2 turn(axis[1], -axis[0]);
    const double turn_number = number * square * turn.dot(mobility.block<2, 2>(1, 1) * turn);
    split[i] = square > 0.0 && (parts != ImplicitParts::kStiff || turn_number > kSoftNumber);
    if (!split[i]) continue;
    reach[i] = std::sqrt(square);
    const double at = axis.dot(centre);
    place += (at - axis.dot(place)) * axis;
    lean[i] = (axis.dot(moment) - force * at) / reach[i];
  }
  const int count = (split[0] ? 2 : 1) * (split[1] ? 2 : 1);
  site.point_count = 0;
  double sum = 0.0;
  for (const double s0 : {-1.0, 1.0}) {
    if (!split[0] && s0 > 0.0) continue;
    for (const double s1 : {-1.0, 1.0}) {
      if (!split[1] && s1 > 0.0) continue;
      const Vec2 at = place + s0 * reach[0] * principal.vectors.col(0) +
                      s1 * reach[1] * principal.vectors.col(1);
      Point& point = site.points[size(site.point_count++)];
      point.motion = {1.0, at.y(), -at.x()};
      point.pushes = true;
      point.constant = std::max(0.0, (force + s0 * lean[0] + s1 * lean[1]) / count);
      sum += point.constant;
    }
  }
  const double kept = sum > 0.0 ? std::max(0.0, force) / sum : 1.0;
  const double per_force = force > 0.0 ? 1.0 / force : 0.0;
  const double per_speed = k > 0.0 ? count / (k * step) : 0.0;  // out of its depth within the step
  for (int i = 0; i < site.point_count; ++i) {
    Point& point = site.points[size(i)];
    point.full = point.constant *= kept;
    const double weight = force > 0.0 ? per_force * point.constant : 1.0 / count;
    const double fall = std::max(std::abs(point.motion.dot(falling)), resting);
    const double settles = settling(per_speed * point.constant, fall);
    const double extra = parts == ImplicitParts::kHeld
                             ? std::max(settles, holding(number * mobility(0, 0)))
                             : kSettling * settles;
    point.slope = step * share * (1.0 + extra) * k / count + damping * weight;
  }
  // Damping of turns about the axes along which there is one point only.
  site.rolls.setZero();
  for (int i = 0; i < 2; ++i) {
    if (split[i]) continue;
    const Vec2 axis = principal.vectors.col(i);
    const Vec3 turn(0.0, axis[1], -axis[0]);
    const double about = std::max(0.0, turn.dot(tangent.damping * turn));
    site.rolls += outer(about * turn, turn);
  }
}

void ImplicitStep::make_points(ImplicitParts parts, double step, double resting) {
  for (std::size_t i = 0; i < island_.size(); ++i) {
    const Vec3 falling = (space_.free_velocity(i) - space_.velocity(i)).head<3>();
    place_points(site(i), space_.mobility(i).block<3, 3>(0, 0), falling, resting, parts, step);
  }
}

}  // namespace volcontact
