// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/in_round/round_rims.h"

#include <algorithm>
#include <cmath>

namespace volcontact {
namespace {

using Piece = RoundPieces::Triangle;

constexpr double kLeastSlope = 1e-6;      // of a plane that lines meet
constexpr double kSag = 0.3;              // of the rim's image over its chord; more is divided
constexpr double kRimSliverShare = 0.01;  // between image and chords, of twice the triangle's area
constexpr int kMostDivisions = 5, kMostHalvings = 5;
constexpr double kLeastSag = 1e-12;  // of the solid's size; less is rounding
constexpr double kFold = 1e-6;       // of the triangle's area, that counts twice
constexpr double kExcessError = 0.25;
constexpr double kSeenSag = 0.058;  // of the height of a triangle: its rule sees what lies beyond

// The image of a rim: the lines from x end on the plane face where level(x) < 0, convex.
class RimImage {
 public:
  RimImage(const RoundSolid& s, int k, const Vec3& up, std::vector<RimExcess>& excess)
      : s_(s),
        excess_(excess),
        up_(up),
        n_(s.plane_normal(k)),
        center_(Vec3::from(s.rim_center[k])),
        square_(s.rim_radius[k] * s.rim_radius[k]),
        speed_(-n_.dot(up)),
        offset_(s.offset[k]) {}

  bool present() const { return speed_ > kLeastSlope && square_ > 0.0; }
  double level(const Vec3& x) const { return foot(x).squaredNorm() - square_; }

  void split(const Piece& t, int divisions, std::vector<Piece>& parts) {
    double f[3];
    int inside = 0;
    for (int i = 0; i < 3; ++i) {
      f[i] = level(t.corner[i]);
      inside += f[i] < 0.0 ? 1 : 0;
    }
    if (inside == 3 || (inside == 0 && beside(t))) return parts.push_back(t);
    if (inside == 0) {
      if (divisions == kMostDivisions) return parts.push_back(t);
      return divide(t, divisions, parts);
    }
    // The corner alone on its side, and the other two.
    int alone = 0;
    for (int i = 0; i < 3; ++i) {
      if ((f[i] < 0.0) == (inside == 1)) alone = i;
    }
    const Vec3 &a = t.corner[alone], &b = t.corner[(alone + 1) % 3], &c = t.corner[(alone + 2) % 3];
    // A second arc cuts the side across.
    if (inside == 1 && divisions < kMostDivisions && dips(b, c)) return divide(t, divisions, parts);
    const Vec3 p = crossing(a, b, f[alone]), q = crossing(a, c, f[alone]);
    const Vec3 normal = (b - a).cross(c - a);
    const double chord = (q - p).norm(), sag = (onto_rim(p, q, normal) - 0.5 * (p + q)).norm();
    if (sag > kSag * chord && divisions < kMostDivisions) return divide(t, divisions, parts);
    int halvings = 0;
    for (double sliver = sag * chord;
         halvings < kMostHalvings && sliver > kRimSliverShare * normal.norm(); sliver *= 0.25) {
      ++halvings;
    }
    // Fans from the corner alone and from the middle of the side across.
    const Vec3 across = 0.5 * (b + c);
    Vec3 arc[(1 << kMostHalvings) + 1];
    int count = 0;
    arc[count++] = p;
    walk(p, q, normal, halvings, [&](const Vec3& next) { arc[count++] = next; });
    arc[count++] = q;
    if (divisions < kMostDivisions &&
        (is_hidden(arc, count, normal, a, 1.0) || is_hidden(arc, count, normal, across, -1.0))) {
      return divide(t, divisions, parts);
    }
    for (int i = 0; i + 1 < count; ++i) {
      add_excess(arc[i], arc[i + 1], normal, a, across);
      parts.push_back({{a, arc[i], arc[i + 1]}, t.face});
      parts.push_back({{across, arc[i + 1], arc[i]}, t.face});
    }
    parts.push_back({{across, p, b}, t.face});
    parts.push_back({{across, c, q}, t.face});
  }

 private:
  // Along the line to the plane, from the middle of the rim.
  Vec3 foot(const Vec3& x) const {
    const Vec3 d = x - center_;
    return d + n_.dot(d) / speed_ * up_;
  }

  // The point of the rim's image over the middle of a chord.
  Vec3 onto_rim(const Vec3& p, const Vec3& q, const Vec3& normal) const {
    const Vec3 middle = 0.5 * (p + q), outward = (q - p).cross(normal).stableNormalized();
    const Vec3 from = foot(middle), way = foot(middle + outward) - from;
    const double square = way.squaredNorm(), half = from.dot(way);
    const double f = from.squaredNorm() - square_;
    const double root = half * half - square * f;
    if (!(root >= 0.0) || !(square > 0.0)) return middle;
    // The root next to the chord.
    const double t = -f / (half + std::copysign(std::sqrt(root), half));
    return std::isfinite(t) ? Vec3(middle + t * outward) : middle;
  }

  // Between a chord and the image the lines are those of the face beyond the image. The two lengths
  // differ by nothing at the image, and by more and more to the chord.
  void add_excess(const Vec3& p, const Vec3& q, const Vec3& normal, const Vec3& a, const Vec3& b) {
    const Vec3 middle = 0.5 * (p + q), tip = onto_rim(p, q, normal), way = tip - middle;
    const double chord = (q - p).norm(), sag = way.norm();
    if (!(sag > kLeastSag * s_.size)) return;
    const Vec3& apex = way.dot(a - middle) > 0.0 ? a : b;
    const auto more = [&](const Vec3& x) { return std::abs(to_plane(x) - to_round(x)); };
    const double half = more(middle + 0.5 * way), all = more(middle);
    if (!(half < kInfinity && all < kInfinity)) return;
    // The mean over a parabola of what is nought at the arc, `half` and `all` nearer to the chord.
    const double mean = 0.4 * (4.0 * half - all) + (8.0 / 35.0) * (2.0 * all - 4.0 * half);
    const double area = 2.0 / 3.0 * chord * sag * normal.dot(up_) / normal.norm();
    const double length = to_plane(tip);
    const double volume = area * mean;
    if (sag * chord < kSeenSag * (p - apex).cross(q - apex).norm()) {
      excess_.push_back(
          {middle + 0.6 * way - length * up_, volume, length, kExcessError * std::abs(volume)});
    } else {  // nothing to take off, or all of it
      excess_.push_back({middle, 0.0, 0.0, std::abs(volume)});
    }
  }

  // Lengths of the lines down.
  double to_plane(const Vec3& x) const { return (offset_ - n_.dot(x)) / speed_; }
  double to_round(const Vec3& x) const { return round_interval(s_, x, -up_).leave; }

  template <typename Visit>
  void walk(const Vec3& p, const Vec3& q, const Vec3& normal, int halvings,
            const Visit& visit) const {
    if (halvings == 0) return;
    const Vec3 tip = onto_rim(p, q, normal);
    walk(p, tip, normal, halvings - 1, visit);
    visit(tip);
    walk(tip, q, normal, halvings - 1, visit);
  }

  // Convex: its tangent in the middle is a bound.
  bool beside(const Piece& t) const {
    const Vec3 middle = foot((t.corner[0] + t.corner[1] + t.corner[2]) / 3.0);
    double least = kInfinity;
    for (const Vec3& p : t.corner) least = std::min(least, middle.dot(foot(p) - middle));
    return middle.squaredNorm() - square_ + 2.0 * least > 0.0;
  }

  // Whether a part of the arc hides behind another one from x, which sees it turn by `sign`.
  static bool is_hidden(const Vec3* arc, int count, const Vec3& normal, const Vec3& x,
                        double sign) {
    for (int i = 0; i + 1 < count; ++i) {
      const double area = sign * (arc[i] - x).cross(arc[i + 1] - x).dot(normal);
      if (area < -kFold * normal.squaredNorm()) return true;
    }
    return false;
  }

  // Whether the line between a and b, both outside, passes inside.
  bool dips(const Vec3& a, const Vec3& b) const {
    const Vec3 from = foot(a), way = foot(b) - from;
    const double square = way.squaredNorm(), at = -from.dot(way);
    if (!(at > 0.0 && at < square)) return false;
    return (from + at / square * way).squaredNorm() < square_;
  }

  // Between a and b, on different sides; f is the level at a.
  Vec3 crossing(const Vec3& a, const Vec3& b, double f) const {
    const Vec3 from = foot(a), way = foot(b) - from;
    const double square = way.squaredNorm(), half = from.dot(way);
    const double root = std::sqrt(std::max(0.0, half * half - square * f));
    // From outside the near root, from inside the far one.
    const double q = f < 0.0 ? -half + root : -half - root;
    const double t = square > 0.0 ? q / square : 0.5;
    return a + std::clamp(t, 0.0, 1.0) * (b - a);
  }

  void divide(const Piece& t, int divisions, std::vector<Piece>& parts) {
    for (const Piece& part : t.quarters()) split(part, divisions + 1, parts);
  }

  const RoundSolid& s_;
  std::vector<RimExcess>& excess_;
  const Vec3& up_;
  const Vec3 n_, center_;
  const double square_, speed_, offset_;
};

}  // namespace

void split_at_rim(const RoundSolid& solid, int k, const Vec3& up,
                  const std::vector<Piece>& triangles, std::vector<Piece>& parts,
                  std::vector<RimExcess>& excess) {
  parts.clear();
  RimImage rim(solid, k, up, excess);
  if (!rim.present()) {
    parts = triangles;
    return;
  }
  for (const Piece& t : triangles) rim.split(t, 0, parts);
}

}  // namespace volcontact
