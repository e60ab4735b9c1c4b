// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/torus_pair/torus_size.h"

namespace volcontact {

/// Sums over a part of the surface of an overlap, about a place of the region it belongs to.
struct TorusFlux {
  Vec3 volume = Vec3::Zero();  ///< int x_i n_i dS, each of them V over a closed surface
  Vec3 first = Vec3::Zero();   ///< int x dV times 4
  Mat3 second = Mat3::Zero();  ///< int x x^T dV times 5
  double area = 0.0;
  Vec3 vector = Vec3::Zero();  ///< int n dS, outwards
  Vec3 moment = Vec3::Zero();  ///< int x cross n dS
  double depth_moment = 0.0;

  /// A piece n dS of the surface at x; `depth` is int s^2 w(s x) ds of the depth w.
  void add(const Vec3& x, const Vec3& n_area, double depth) {
    const double flux = x.dot(n_area);
    volume += x.cwiseProduct(n_area);
    first += flux * x;
    second += outer(flux * x, x);
    area += n_area.norm();
    vector += n_area;
    moment += x.cross(n_area);
    depth_moment += flux * depth;
  }
};

/// int s^2 f(s) ds from 0 to 1, exact for polynomials of degree 5.
template <typename Function>
double integral_from_origin(Function&& f) {
  constexpr double kNodes[] = {0.29499779011150162, 0.65299623396164812, 0.92700597592685027};
  constexpr double kWeights[] = {0.029950703008580698, 0.14624626925986602, 0.15713636106488661};
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) sum += kWeights[i] * f(kNodes[i]);
  return sum;
}

/// A third of the flux of x - origin through the surface of a ring beside an arc of one of its
/// section circles, per angle about its axis.
inline double arc_flux(const TorusSize& ring, const Circle& circle, const Vec3& origin, double low,
                       double high) {
  const Vec3 way = circle.center - origin;
  const double a = circle.u.dot(way), b = circle.v.dot(way);
  const double r = ring.minor, width = high - low;
  const double cos_low = std::cos(low), sin_low = std::sin(low), cos_high = std::cos(high),
               sin_high = std::sin(high);
  const double s = sin_high - sin_low, c = cos_high - cos_low;
  const double cos_2 = 0.5 * (width + sin_high * cos_high - sin_low * cos_low);
  const double sin_cos = 0.5 * (sin_high * sin_high - sin_low * sin_low);
  return r / 3.0 *
         (ring.major * (a * s - b * c + r * width) + r * (a * cos_2 + b * sin_cos + r * s));
}

}  // namespace volcontact
