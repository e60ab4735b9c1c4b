// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/in_round/star_sums.h"

#include <algorithm>
#include <cmath>

#include "volcontact/base/interrupt.h"
#include "volcontact/pair/quadrature/triangle_rule.h"

namespace volcontact {
namespace {

using namespace triangle_rule;
constexpr int kMostStarRounds = 12;  // of divisions of triangles
constexpr double kSettled = 0.15;    // of the doubt allowed, left behind in each round
// Of the spread of the integrand over a triangle with a rim of the solid in it. Over 4,000 random
// kinks the rule errs by 8e-4 (median) to 2e-2; the errors of many triangles cancel in part.
constexpr double kRimError = 0.002;

// The same where a triangle is wider than it is far from the centre.
constexpr double kWideError = 0.05;

constexpr double kOffArc = 1e-6;  // of the way from the arc to the chord, or to the middle
constexpr double kGaussPlace = 0.7745966692414834;

class Star {
 public:
  Star(const RoundSolid& solid, const Vec3& center) : solid_(solid), center_(center) {}

  // What lies behind a surface element, seen from the centre.
  struct Behind {
    MomentSum sum;
    double depth = 0.0;  // of the end of the ray behind the plane of the element
    int face = 0;        // of the solid, where the ray ends
  };

  // Behind n dA at x.
  Behind behind(const Vec3& x, const Vec3& n_dA) const {
    Behind out;
    MomentSum& sum = out.sum;
    const Vec3 way = x - center_;
    const double r = way.norm();
    if (!(r > 0.0)) return out;
    const Vec3 u = way / r;
    const double across = u.dot(n_dA), solid_angle = -across / (r * r);
    Vec3 normal;
    const double rho = std::max(r, surface_along(u, normal, out.face));
    const double r2 = r * r, rho2 = rho * rho;
    const double k3 = (rho2 * rho - r2 * r) / 3.0, k4 = 0.25 * (rho2 * rho2 - r2 * r2),
                 k5 = 0.2 * (rho2 * rho2 * rho - r2 * r2 * r);
    sum.volume = solid_angle * k3;
    sum.first = solid_angle * (k3 * center_ + k4 * u);
    const Mat3 mixed = outer(center_, u);
    sum.second = solid_angle * (outer(k3 * center_, center_) + k4 * (mixed + mixed.transpose()) +
                                outer(k5 * u, u));
    const double facing = u.dot(normal);
    if (facing > 0.0) sum.counter_area = solid_angle * rho2 / facing;
    const double area = n_dA.norm();
    if (area > 0.0) out.depth = (rho - r) * std::abs(across) / area;
    return out;
  }

  StarSum triangle(const RoundPieces::Triangle& t) const {
    const Vec3(&c)[3] = t.corner;
    const Vec3 area = 0.5 * (c[1] - c[0]).cross(c[2] - c[0]);
    const Vec3 all = c[0] + c[1] + c[2];
    StarSum out;
    const Behind at_middle = behind(all / 3.0, area);
    double outer = 0.0, least = at_middle.sum.volume, most = least;
    double nearest = (all / 3.0 - center_).squaredNorm();
    bool rim = false;
    const auto look = [&](const Vec3& x) {
      const Behind b = behind(x, area);
      nearest = std::min(nearest, (x - center_).squaredNorm());
      rim |= b.face != at_middle.face;
      least = std::min(least, b.sum.volume);
      most = std::max(most, b.sum.volume);
      out.depth = std::max(out.depth, b.depth);
      return b;
    };
    add(kMiddleWeight, at_middle, out);
    for (int i = 0; i < 3; ++i) {
      const Behind far = look(kOuterCorner * c[i] + kOuter * all);
      const Behind near = look(kInnerCorner * c[i] + kInner * all);
      add(kOuterWeight, far, out);
      add(kInnerWeight, near, out);
      outer += far.sum.volume;
      look(c[i] + kOffArc * (all / 3.0 - c[i]));  // on an arc rays end where they begin
    }
    const double rough = kRoughMiddleWeight * at_middle.sum.volume + kRoughOuterWeight * outer;
    // Across a rim of the solid the better rule gains nothing, and both may err by the same.
    // Nor is there a gain where the triangle is wider than it is far away: the integrand falls with
    // the cube of the distance, and the two may agree by chance.
    const double difference = std::abs(out.moments.volume - rough);
    const double width = std::max(
        {(c[1] - c[0]).squaredNorm(), (c[2] - c[1]).squaredNorm(), (c[0] - c[2]).squaredNorm()});
    out.doubt = width > nearest ? std::max(difference, kWideError * (most - least))
                : rim           ? std::max(difference, kRimError * (most - least))
                                : difference / kGain;
    return out;
  }

  // Of a sliver, where rays end on the round face from arc to chord: that falls evenly to nought at
  // the arc. Where they pass a rim on the way, and be it a hair from the arc, it does not: then a
  // rule on either side of the rim tells.
  StarSum sliver(const RoundPieces::Sliver& s) const {
    StarSum out;
    const auto at = [&](double y) { return behind(s.tip + y * (s.middle - s.tip), s.area_vector); };
    const Behind at_chord = at(1.0), at_arc = at(kOffArc);
    if (at_arc.face < 0 && at_chord.face < 0) {
      add(kSliverShare, at_chord, out);
    } else {
      double from = 0.0, rim = 0.0, to = 1.0;
      if (at_arc.face != at_chord.face) {
        for (rim = 0.5; to - from > kOffArc; rim = 0.5 * (from + to)) {
          (at(rim).face == at_chord.face ? to : from) = rim;
        }
      }
      // Of the area, w^3 is farther from the arc than y = 1 - w^2.
      const double w = std::sqrt(1.0 - rim);
      add_part(at, 0.0, w, out);
      add_part(at, w, 1.0, out);
    }
    out.slivers = std::abs(out.moments.volume);
    return out;
  }

  static void add(double weight, const Behind& b, StarSum& sum) {
    add(weight, b.sum, sum.moments);
    sum.depth = std::max(sum.depth, b.depth);
    sum.depth_moment += 0.5 * weight * std::abs(b.sum.volume) * b.depth;
  }
  static void add(double weight, const MomentSum& m, MomentSum& sum) {
    sum.volume += weight * m.volume;
    sum.first += weight * m.first;
    sum.second += weight * m.second;
    sum.counter_area += weight * m.counter_area;
  }

 private:
  // Which plane face ends the ray, or -1.
  int cut_by_planes(const Vec3& u, double& leave) const {
    int plane = -1;
    for (int k = 0; k < solid_.plane_count; ++k) {
      const double slope = solid_.plane_normal(k).dot(u);
      const double at = -solid_.over_plane(k, center_) / slope;
      if (slope > 0.0 && at < leave) leave = at, plane = k;
    }
    return plane;
  }
  // How far the surface is from the centre along u, its outward normal there, and which face that
  // is: a plane one by its number, others below nought.
  double surface_along(const Vec3& u, Vec3& normal, int& plane) const {
    double leave = round_interval(solid_, center_, u).leave;
    plane = cut_by_planes(u, leave);
    if (plane >= 0) {
      normal = solid_.plane_normal(plane);
      return leave;
    }
    const Vec3 end = center_ + leave * u;
    round_level(solid_, end, normal);
    normal = normal.stableNormalized();
    // The tube of a capsule and its balls: -1, -2 and -3.
    const double along = Vec3::from(solid_.axis).dot(end - Vec3::from(solid_.center));
    if (solid_.half_length > 0.0 && std::abs(along) > solid_.half_length) {
      plane = along > 0.0 ? -2 : -3;
    }
    return leave;
  }

  // Three points on a part of a sliver.
  template <typename At>
  static void add_part(const At& at, double from, double to, StarSum& out) {
    if (!(to > from)) return;
    for (int i = -1; i <= 1; ++i) {
      const double w = 0.5 * (from + to) + 0.5 * (to - from) * i * kGaussPlace;
      const double weight = 0.5 * (to - from) * (i == 0 ? 8.0 / 9.0 : 5.0 / 9.0);
      add(3.0 * w * w * weight, at(1.0 - w * w), out);
    }
  }

  const RoundSolid& solid_;
  const Vec3 center_;
};

void add(const StarSum& part, StarSum& sum) {
  Star::add(1.0, part.moments, sum.moments);
  sum.doubt += part.doubt;
  sum.slivers += part.slivers;
  sum.depth = std::max(sum.depth, part.depth);
  sum.depth_moment += part.depth_moment;
}

}  // namespace

StarSum sum_star(const RoundSolid& solid, const Vec3& center,
                 const std::vector<RoundPieces::Triangle>& triangles,
                 const std::vector<RoundPieces::Sliver>& slivers, double share, int most,
                 StarScratch& scratch) {
  const Star star(solid, center);
  StarSum settled;
  for (const RoundPieces::Sliver& sliver : slivers) {
    add(star.sliver(sliver), settled);
  }
  scratch.parts = triangles;
  for (int round = 0;; ++round) {
    StarSum all = settled;
    scratch.sums.clear();
    for (const RoundPieces::Triangle& t : scratch.parts) {
      InterruptScope::poll();
      scratch.sums.push_back(star.triangle(t));
      add(scratch.sums.back(), all);
    }
    const double allowed = share * std::abs(all.moments.volume);
    if (all.doubt <= allowed || round == kMostStarRounds ||
        static_cast<int>(scratch.parts.size()) > most) {
      return all;
    }
    // In four, but for those whose doubts will not add up to much.
    const double least = kSettled * allowed / static_cast<double>(scratch.parts.size());
    scratch.divided.clear();
    for (std::size_t i = 0; i < scratch.parts.size(); ++i) {
      if (scratch.sums[i].doubt < least) {
        add(scratch.sums[i], settled);
        continue;
      }
      for (const RoundPieces::Triangle& part : scratch.parts[i].quarters())
        scratch.divided.push_back(part);
    }
    std::swap(scratch.parts, scratch.divided);
  }
}

}  // namespace volcontact
