// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/torus/torus_exits.h"

#include <algorithm>
#include <cmath>

#include "volcontact/pair/sections/torus/curve_roots.h"

namespace volcontact {
namespace {

constexpr double kOnWall = 1e-9;  // of places on faces, per radius of the ring
constexpr int kMostRoots = 16;    // of a wall: a quadric has at most four
constexpr int kLooks = 12;        // all round the ring
constexpr double kCosine = 0.8660254037844387, kSine = 0.5;  // from each to the next
constexpr int kReachTurns = 3;  // of the direction in which a disc reaches farthest

class TorusExits {
 public:
  TorusExits(const FaceSet& faces, double major, double minor, std::vector<TorusExit>& exits)
      : faces_(faces), major_(major), minor_(minor), exits_(exits) {}

  void run() {
    exits_.clear();
    for (const PlaneFace& plane : faces_.planes) look(plane);
    for (const RoundFace& face : faces_.rounds) look(face);
  }

 private:
  // The disc lies beyond the line of the plane where n_rho R > d + r |n in the half-plane|.
  void look(const PlaneFace& plane) {
    const double n_xy = std::hypot(plane.normal.x(), plane.normal.y());
    if (!(n_xy * major_ - minor_ > plane.offset)) return;
    const double share = (plane.offset + minor_) / (n_xy * major_);
    if (!(share > 0.0)) return;
    const double to = std::atan2(plane.normal.y(), plane.normal.x()), half = std::acos(share);
    exits_.push_back({to - half, to + half, true});
  }

  // Whether the circle in the middle of the ring lies beyond a face all round, or nearly so.
  bool beyond(const RoundFace& face) const {
    Vec3 out = Vec3::UnitX();
    for (int i = 0; i < kLooks; ++i) {
      if (face(major_ * out) < 0.0) return false;
      out = {kCosine * out.x() - kSine * out.y(), kSine * out.x() + kCosine * out.y(), 0.0};
    }
    return true;
  }

  void look(const RoundFace& face) {
    if (beyond(face)) return;
    double roots[kMostRoots];
    int count = 0;
    const auto reach = [&](double angle) { return face(farthest(face, angle)); };
    const auto note = [&](double root) {
      if (count < kMostRoots) roots[count++] = root;
    };
    each_root(reach, -kPi, kPi, CurveEnds::kClosed, note, CloseRoots::kAboutPositive);
    std::sort(roots, roots + count);
    for (int i = 0; i < count; ++i) {
      const double low = roots[i], high = i + 1 < count ? roots[i + 1] : roots[0] + 2.0 * kPi;
      const double middle = 0.5 * (low + high);
      if (!(reach(middle) > 0.0)) continue;
      if (!on_body(face, farthest(face, low)) && !on_body(face, farthest(face, high))) continue;
      exits_.push_back({low, high, face(nearest(face, middle)) > 0.0});
    }
  }

  // Of the rim of a disc, what reaches farthest through a face, and what stays behind it most.
  Vec3 farthest(const RoundFace& face, double angle) const { return on_rim(face, angle, minor_); }
  Vec3 nearest(const RoundFace& face, double angle) const { return on_rim(face, angle, -minor_); }
  Vec3 on_rim(const RoundFace& face, double angle, double radius) const {
    const Vec3 out(std::cos(angle), std::sin(angle), 0.0), middle = major_ * out;
    Vec3 x = middle;
    for (int turn = 0; turn < kReachTurns; ++turn) {
      const Vec3 normal = face.half_gradient(x);
      const double across = normal.dot(out), length = std::hypot(across, normal.z());
      if (!(length > 0.0)) break;
      x = middle + radius / length * (across * out + normal.z() * Vec3::UnitZ());
    }
    return x;
  }

  // Whether a place of a face belongs to the body: not beyond its planes, and of a capsule on the
  // part that the face stands for.
  bool on_body(const RoundFace& face, const Vec3& x) const {
    const double slack = kOnWall * major_;
    for (const PlaneFace& p : faces_.planes) {
      if (!(p.normal.dot(x) <= p.offset + slack)) return false;
    }
    if (face.part == CapsulePart::kNone)
      return !face.cone || (face.map * (x - face.center)).z() > 0.0;
    const Segment& capsule = faces_.capsule[index(face.owner)];
    const double along = capsule.along(x);
    if (face.part == CapsulePart::kTube) return std::abs(along) <= capsule.half_length + slack;
    const double side = face.part == CapsulePart::kTopBall ? 1.0 : -1.0;
    return side * along >= capsule.half_length - slack;
  }

  const FaceSet& faces_;
  double major_, minor_;
  std::vector<TorusExit>& exits_;
};

}  // namespace

void find_torus_exits(const FaceSet& faces, double major_radius, double minor_radius,
                      std::vector<TorusExit>& exits) {
  TorusExits(faces, major_radius, minor_radius, exits).run();
}

}  // namespace volcontact
