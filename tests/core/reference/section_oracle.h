// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "volcontact/metrics/volume_metrics.h"

namespace volcontact::test {

/// A body of revolution about z: rings between the radii `inner` and `outer`, which may change
/// smoothly between the `breaks`. `slant` is the length of the profile per length of the axis.
template <typename Outer, typename Inner, typename OuterSlant, typename InnerSlant>
struct Revolution {
  std::vector<long double> breaks;
  Outer outer;
  Inner inner;
  OuterSlant outer_slant;
  InnerSlant inner_slant;
};
template <typename... T>
Revolution(std::vector<long double>, T...) -> Revolution<T...>;

/// The part of a body of revolution B below z = 0 of A, from its sections across its axis: discs
/// cut by a chord. Extended precision, and a fine quadrature between all places where the chord
/// enters or leaves a disc: an oracle that shares no formula with the engines. The axis must not
/// stand upright in A. Without `depth`, `status` and the flat ends' areas.
template <typename Body>
VolumeMetrics sections_below(const Body& body, const Pose& X_AB) {
  using Real = long double;
  const Vec3 axis = X_AB.rotation.col(2);
  const Real k = axis.z(), s = std::hypot(Real(axis.x()), Real(axis.y()));
  const Real ux = axis.x() / s, uy = axis.y() / s, height = X_AB.translation.z();
  const auto chord = [&](Real q) { return -(height + k * q) / s; };  // p of the plane

  // Breaks where the chord touches a disc.
  std::vector<Real> breaks = body.breaks;
  for (std::size_t i = 1; i < body.breaks.size(); ++i) {
    constexpr int kSteps = 3000;
    const Real from = body.breaks[i - 1], to = body.breaks[i];
    for (int kind = 0; kind < 4; ++kind) {
      const auto touch = [&](Real q) {
        return chord(q) + (kind & 1 ? 1 : -1) * (kind & 2 ? body.outer(q) : body.inner(q));
      };
      for (int j = 0; j < kSteps; ++j) {
        Real low = from + (to - from) * j / kSteps, high = from + (to - from) * (j + 1) / kSteps;
        const bool sign = touch(low) > 0;
        if (sign == (touch(high) > 0)) continue;
        for (int n = 0; n < 70; ++n) {
          const Real middle = (low + high) / 2;
          ((touch(middle) > 0) == sign ? low : high) = middle;
        }
        breaks.push_back(low);
      }
    }
  }
  std::sort(breaks.begin(), breaks.end());

  Real volume = 0, p_1 = 0, q_1 = 0, pp = 0, pq = 0, qq = 0, rr = 0, depth = 0;
  Real cut = 0, cut_p = 0, cut_q = 0, side = 0;
  const auto add_disc = [&](Real weight, Real q, Real r, Real slant, Real sign) {
    const Real c = std::clamp(r > 0 ? -chord(q) / r : Real(0), Real(-1), Real(1));
    const Real angle = std::acos(c), sn = std::sqrt((1 - c) * (1 + c)), cube = sn * sn * sn;
    const Real area = weight * sign * r * r * (angle - sn * c);
    const Real moment = -weight * sign * r * r * r * cube * 2 / 3;
    volume += area;
    p_1 += moment;
    q_1 += area * q;
    pp += area * r * r / 4 + weight * sign * r * r * r * r * cube * c / 2;
    pq += moment * q;
    qq += area * q * q;
    rr += area * r * r / 4 - weight * sign * r * r * r * r * cube * c / 6;
    depth -= s * moment + (k * q + height) * area;
    side += weight * 2 * r * angle * slant;
    const Real line = weight * sign * 2 * r * sn / s;
    cut += line;
    cut_p += line * chord(q);
    cut_q += line * q;
  };
  constexpr Real kNodes[] = {0.339981043584856264802665759103L, 0.861136311594052575223946488893L};
  constexpr Real kWeights[] = {0.652145154862546142626936050778L,
                               0.347854845137453857373063949222L};
  const Real quarter_turn = std::acos(Real(0));
  for (std::size_t i = 1; i < breaks.size(); ++i) {
    // q = from + range sin^2(x): square roots at the ends become smooth.
    const Real from = breaks[i - 1], range = breaks[i] - from;
    if (!(range > 0)) continue;
    constexpr int kPanels = 60;
    const Real width = quarter_turn / kPanels;
    for (int j = 0; j < kPanels; ++j) {
      for (int n = 0; n < 4; ++n) {
        const Real x = width * (j + (1 + (n & 1 ? kNodes[n / 2] : -kNodes[n / 2])) / 2);
        const Real q = from + range * std::sin(x) * std::sin(x);
        const Real weight = width / 2 * kWeights[n / 2] * range * std::sin(2 * x);
        add_disc(weight, q, body.outer(q), body.outer_slant(q), 1);
        if (body.inner(q) > 0) add_disc(weight, q, body.inner(q), body.inner_slant(q), -1);
      }
    }
  }

  VolumeMetrics m;
  if (!(volume > 0)) return m;
  const auto place = [&](Real p, Real q) {  // relative to B's origin, in A
    const Real forward = s * q - k * p;
    return Vec3(double(forward * ux), double(forward * uy), double(s * p + k * q));
  };
  const Vec3 &c = X_AB.translation, e_p = place(1, 0), e_q = place(0, 1),
             e_r = Vec3(double(uy), double(-ux), 0.0);
  m.volume = double(volume);
  m.centroid = c + place(p_1 / volume, q_1 / volume);
  const double v_pp = double(pp - p_1 * p_1 / volume), v_qq = double(qq - q_1 * q_1 / volume),
               v_pq = double(pq - p_1 * q_1 / volume);
  const Mat3 second = v_pp * outer(e_p, e_p) + v_qq * outer(e_q, e_q) +
                      double(rr) * outer(e_r, e_r) + v_pq * (outer(e_p, e_q) + outer(e_q, e_p));
  m.inertia = second.trace() * Mat3::Identity() - second;
  m.area = double(cut);
  m.area_vector = Vec3(0, 0, m.area);
  m.area_moment = (place(cut_p, cut_q) + m.area * c).cross(Vec3::UnitZ());
  m.counter_area = double(side);
  m.depth_moment = double(depth);
  return m;
}

}  // namespace volcontact::test
