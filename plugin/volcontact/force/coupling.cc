// SPDX-License-Identifier: Apache-2.0
#include "volcontact/force/coupling.h"

#include <algorithm>

namespace volcontact {
namespace {

// The patch as an ellipse in its principal axes, with the pressure
// p ~ (1 - paraboloid) + 2 paraboloid (1 - s^2), s = 1 on the rim.
struct Ellipse {
  Vec3 axis_x;
  Vec3 axis_y;
  double a;  // semi-axes [m], a >= b
  double b;
  double paraboloid;  // its share of the force, 0 to 1
};

// A line has no width to be integrated over; this one differs from it by less than rounding shows.
constexpr double kLeastRatio = 1e-2;

Ellipse ellipse_of(const Vec3& normal, const Patch& patch) {
  const Mat3 basis = basis_with_z(normal);
  const Vec3 x = basis.col(0), y = basis.col(1);
  const double xx = x.dot(patch.second_moment * x) / patch.volume;
  const double yy = y.dot(patch.second_moment * y) / patch.volume;
  const double xy = x.dot(patch.second_moment * y) / patch.volume;
  const double mean = 0.5 * (xx + yy), half = 0.5 * (xx - yy);
  const double deviation = std::hypot(half, xy);
  const double turn = 0.5 * std::atan2(xy, half);
  const double major = std::sqrt(std::max(0.0, mean + deviation));
  const double minor = std::max(std::sqrt(std::max(0.0, mean - deviation)), kLeastRatio * major);
  // <x^2> / a^2 is 1/4 under uniform pressure and 1/6 under the paraboloid.
  const double ratio = patch.area > 0.0 ? kPi * major * minor / patch.area : 0.25;
  const double paraboloid = std::clamp(12.0 * (0.25 - ratio), 0.0, 1.0);
  const double scale = 1.0 / std::sqrt(0.25 - paraboloid / 12.0);
  const Vec3 along = std::cos(turn) * x + std::sin(turn) * y;
  return {along, normal.cross(along), scale * major, scale * minor, paraboloid};
}

// Sums over rays from the pole, in coordinates in which the ellipse is the unit disc.
struct RaySums {
  double x = 0.0;  // of the direction of slip
  double y = 0.0;
  double torque = 0.0;  // about the pole
};

// Angles of the rays. The direction of slip turns within b/a of a right angle.
int rays_for(const Ellipse& e) {
  return std::clamp(8 * static_cast<int>(std::ceil(4.5 * e.a / e.b)), 40, 256);
}

// Adds one ray in direction (c, s) between the distances r1 and r2 from the pole, which stands
// `distance` from the centre; `away` is the cosine of the ray's angle to the way to the centre.
void add_ray(const Ellipse& e, double c, double s, double r1, double r2, double distance,
             double away, double weight, RaySums& sums) {
  const double g = e.paraboloid;
  const double p0 = 1.0 + g - 2.0 * g * distance * distance, p1 = 4.0 * g * distance * away;
  const double p2 = -2.0 * g;
  const auto moments = [&](double r) {
    return std::array{r * r * (p0 / 2.0 + r * (p1 / 3.0 + r * p2 / 4.0)),
                      r * r * r * (p0 / 3.0 + r * (p1 / 4.0 + r * p2 / 5.0))};
  };
  const auto outer = moments(r2), inner = moments(r1);
  const double length = std::sqrt(e.a * e.a * c * c + e.b * e.b * s * s);
  const double force = weight * (outer[0] - inner[0]) / length;
  sums.x -= force * e.b * s;  // normal x (a c, b s)
  sums.y += force * e.a * c;
  sums.torque += weight * (outer[1] - inner[1]) * length;
}

// Rays from a pole at (x, y): equally spaced from inside; from outside in the sine of their angle,
// so that they crowd where they graze the rim.
RaySums sum_rays(const Ellipse& e, double x, double y) {
  RaySums sums;
  const double distance = std::hypot(x, y);
  const double to_x = distance > 0.0 ? -x / distance : 1.0;
  const double to_y = distance > 0.0 ? -y / distance : 0.0;
  const int rays = rays_for(e);
  const bool inside = distance <= 1.0;
  const double step = (inside ? 2.0 * kPi : kPi) / rays;
  for (int i = 0; i < rays; ++i) {
    const double angle = (i + 0.5) * step - (inside ? kPi : 0.5 * kPi);
    if (inside) {
      const double away = std::cos(angle), across = std::sin(angle);
      const double half = std::sqrt(std::max(0.0, 1.0 - distance * distance * across * across));
      add_ray(e, to_x * away - to_y * across, to_y * away + to_x * across, 0.0,
              distance * away + half, distance, away, step / kPi, sums);
    } else {
      const double across = std::sin(angle) / distance, half = std::cos(angle);
      const double away = std::sqrt(1.0 - across * across);
      add_ray(e, to_x * away - to_y * across, to_y * away + to_x * across, distance * away - half,
              distance * away + half, distance, away, step * half / (kPi * distance * away), sums);
    }
  }
  return sums;
}

// Where sliding is faster than spinning by this factor, second order in their ratio is enough.
constexpr double kFarPole = 1e3;

// Friction of unit strength while sliding by far outweighs spinning.
GeneralizedSlip nearly_sliding(const Vec3& slip, double spin, const Vec3& normal,
                               const Patch& patch, double speed) {
  const double sliding = slip.norm(), ratio = spin / sliding;
  const Vec3 along = slip / sliding, across = normal.cross(along);
  const Vec3 moments = patch.second_moment * along / patch.volume;
  const double variance = along.dot(moments), mixed = across.dot(moments);
  return {speed, -(1.0 - 0.5 * ratio * ratio * variance) * along - ratio * ratio * mixed * across,
          -ratio * variance};
}

}  // namespace

GeneralizedSlip integrated_slip(const Vec3& slip, double spin, const Vec3& normal,
                                const Patch& patch) noexcept {
  const double r = patch.gyration_radius;
  const double speed = std::sqrt(slip.squaredNorm() + r * r * spin * spin);
  if (!(speed > 0.0) || !(patch.volume > 0.0)) return {};
  const double sliding = slip.norm();
  const Ellipse e = ellipse_of(normal, patch);
  if (sliding > kFarPole * e.a * std::abs(spin) || !(e.a > 0.0)) {
    return nearly_sliding(slip, spin, normal, patch, speed);
  }
  // The patch turns about the pole, where nothing slips: on a ray from it all slip is parallel.
  const double pole_x = -slip.dot(e.axis_y) / spin, pole_y = slip.dot(e.axis_x) / spin;
  const RaySums sums = sum_rays(e, pole_x / e.a, pole_y / e.b);
  const double sense = spin > 0.0 ? 1.0 : -1.0;
  const double x = -sense * sums.x, y = -sense * sums.y;
  return {speed, x * e.axis_x + y * e.axis_y, -sense * sums.torque + pole_x * y - pole_y * x};
}

}  // namespace volcontact
