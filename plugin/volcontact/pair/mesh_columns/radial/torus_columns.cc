// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/radial/torus_columns.h"

#include <algorithm>
#include <cmath>

#include "volcontact/pair/mesh_columns/contained.h"

namespace volcontact {
namespace {

constexpr double kTubeRestError = 1e-6;  // of V; as measured
// Of a tube's radius: planes nearer than the first touch the circle in its middle, which the lines
// begin at. The solid is then looked at from both sides of them, moved by the second.
constexpr double kGrazes = 8e-3, kBothSides = 2e-2;
constexpr double kBothSidesError = 1e-4;  // of V, at least; as measured
constexpr double kFarSidesError = 0.5;    // of what the mean changes by from twice as far
constexpr double kMostChange = 0.2;       // of V, from one side to the other
constexpr double kBeside = 0.05;          // of a tube's radius: so near is by
constexpr int kLooks = 64;                // at the circle
constexpr double kNothing = 1e-9;         // of a volume, by its area and the tube's radius
constexpr double kOnEdge = 1e-13;         // of a place from an edge, per size
constexpr double kBesideEdge = 1e-7;      // of a tube's radius

class TorusColumns {
 public:
  TorusColumns(const SurfaceView& a, const Torus& b, const Pose& X_AB,
               const InterferenceOptions& options, TorusColumnsScratch& scratch, Interference& out)
      : a_(a),
        b_(b),
        X_AB_(X_AB),
        X_BA_(X_AB.inverse()),
        options_(options),
        s_(scratch),
        out_(out) {
    out.total = VolumeMetrics{};
    out.sites.clear();
  }

  bool run() {
    if (bounds_apart(a_.bounds, b_.bounds(), X_AB_) || !(b_.minor_radius() > 0.0)) return true;
    const bool found = find_patches();
    const Vec3 grazing = grazing_normal();
    return grazing.isZero(0.0) ? found && add_sites() : add_from_both_sides(grazing);
  }

 private:
  bool find_patches() {
    const RadialSolid solid{RadialWall(b_), {}, 0, {}, {}};
    return radial_patches(a_, X_BA_, solid, options_, s_.radial) == RadialReach::kDone;
  }

  // The mean normal of the faces that touch the circle in the middle of the tube or hold it, in the
  // torus's frame; zero where none does.
  Vec3 grazing_normal() const {
    const double R = b_.major_radius(), near = kGrazes * b_.minor_radius();
    Vec3 sum = Vec3::Zero();
    for (const auto& [slot, inside] : s_.radial.search.found) {
      Vec3 c[3];
      for (int i = 0; i < 3; ++i) c[i] = X_BA_ * a_.tree->corner(slot, i);
      const Vec3 n = (c[1] - c[0]).cross(c[2] - c[0]).stableNormalized();
      const double across = std::hypot(n.x(), n.y());
      if (std::abs(std::abs(n.dot(c[0])) - R * across) < near && reaches_circle(c, n)) sum += n;
    }
    return sum.isZero(1e-6) ? Vec3::Zero() : Vec3(sum.normalized());
  }

  // Whether the circle comes by a triangle whose plane touches or holds it.
  bool reaches_circle(const Vec3 (&c)[3], const Vec3& n) const {
    const double touch = std::atan2(n.y(), n.x()), slack = kBeside * b_.minor_radius();
    for (int k = 0; k < kLooks; ++k) {  // the place of touch is one, or its opposite
      const double angle = touch + 2.0 * kPi * k / kLooks;
      const Vec3 x = b_.major_radius() * Vec3(std::cos(angle), std::sin(angle), 0.0);
      bool within = std::abs(n.dot(x - c[0])) < slack;
      for (int i = 0; i < 3 && within; ++i) {
        const Vec3 edge = c[(i + 1) % 3] - c[i];
        within = n.dot(edge.cross(x - c[i])) >= -slack * edge.norm();
      }
      if (within) return true;
    }
    return false;
  }

  // V and all that belongs to it change smoothly there; only the lines do not. Twice as far the
  // mean of both sides is four times as far from V.
  bool add_from_both_sides(const Vec3& normal) {
    VolumeMetrics mean, far;
    if (!add_mean(2.0 * kBothSides * normal, far) || !add_mean(kBothSides * normal, mean)) {
      return false;
    }
    const double change = mean.volume - far.volume,
                 scale = 0.5 * (1.0 + change / 3.0 / mean.volume);
    for (double* x :
         {&mean.volume, &mean.area, &mean.counter_area, &mean.depth_moment, &mean.volume_error}) {
      *x *= scale;
    }
    mean.inertia *= scale;
    mean.area_vector *= scale;
    mean.area_moment *= scale;
    mean.volume_error += kFarSidesError * std::abs(change) + kBothSidesError * mean.volume;
    if (mean.volume_error > options_.tolerance * mean.volume) mean.status = Status::kApproximate;
    out_.total = mean;
    out_.sites.assign(mean.touching() ? 1 : 0, mean);
    return is_finite(mean);
  }

  // The sum of what comes of the torus moved both ways, by so many of its tube's radii.
  bool add_mean(const Vec3& way, VolumeMetrics& sum) {
    double volumes[2];
    for (const int side : {0, 1}) {
      const Vec3 moved = (side == 0 ? 1.0 : -1.0) * b_.minor_radius() * way;
      const Pose X{X_AB_.rotation, X_AB_.translation + X_AB_.rotation * moved};
      TorusColumns aside(a_, b_, X, options_, s_, out_);
      if (!aside.find_patches() || !aside.add_sites()) return false;
      volumes[side] = out_.total.volume;
      sum = sum + out_.total;
    }
    return std::abs(volumes[1] - volumes[0]) <= kMostChange * sum.volume && sum.touching();
  }

  bool add_sites() {
    MomentSum inside;
    double depth_moment = 0.0;
    const std::vector<RadialPatch>& patches = s_.radial.patches;
    if (!add_arcs(inside, depth_moment)) return false;
    bool apart = inside.volume == 0.0;
    for (const RadialPatch& patch : patches) apart &= patch.sum.moments.volume > 0.0;
    if (apart) {
      for (const RadialPatch& patch : patches) add_site(patch.sum);
    } else {
      RadialSum all;
      all.moments = inside;
      all.depth_moment = depth_moment;
      all.depth = inside.volume != 0.0 ? b_.minor_radius() : 0.0;
      for (const RadialPatch& patch : patches) {
        all.moments += patch.sum.moments;
        all.depth_moment += patch.sum.depth_moment;
        all.depth = std::max(all.depth, patch.sum.depth);
        all.doubt += patch.sum.doubt;
      }
      // Less than nothing: the circle crosses the surface where faces meet, and none has counted
      // it.
      const MomentSum& m = all.moments;
      if (m.volume < -kNothing * b_.minor_radius() * m.area) return false;
      add_site(all);
    }
    VolumeMetrics& total = out_.total;
    const bool crosses = std::any_of(patches.begin(), patches.end(),
                                     [](const RadialPatch& patch) { return patch.at_wall; });
    if (!crosses && total.touching()) total.status = Status::kContained;
    if (total.volume_error > options_.tolerance * total.volume) total.status = Status::kApproximate;
    for (VolumeMetrics& site : out_.sites) site.status = total.status;
    return is_finite(total);
  }

  void add_site(RadialSum sum) {
    if (!(sum.moments.volume > 0.0)) return;
    const double least = sum.moments.area_vector.norm();  // of any surface
    sum.moments.area = std::max(least, sum.moments.area);
    sum.moments.counter_area = std::max(least, sum.moments.counter_area);
    VolumeMetrics m = sum.moments.metrics();
    m.depth_moment = sum.depth_moment;
    m.depth = sum.depth;
    m.volume_error = sum.doubt + kTubeRestError * m.volume;
    out_.sites.push_back(transformed(m, X_AB_));
    out_.total = out_.total + out_.sites.back();
  }

  // Where the circle in the middle of the tube passes through a triangle, moved along its axis to
  // z. False where it passes nearer to an edge than that.
  bool add_crossings(const Vec3 (&c)[3], double z, double on_edge) {
    const double R = b_.major_radius();
    if (std::min({c[0].z(), c[1].z(), c[2].z()}) > z ||
        std::max({c[0].z(), c[1].z(), c[2].z()}) < z) {
      return true;
    }
    const Vec3 n = (c[1] - c[0]).cross(c[2] - c[0]);
    const double reach = R * std::hypot(n.x(), n.y()), height = n.dot(c[0]) - n.z() * z;
    if (!(std::abs(height) < reach)) return true;
    const double middle = std::atan2(n.y(), n.x()), half = std::acos(height / reach);
    for (const double side : {-1.0, 1.0}) {
      double angle = middle + side * half;
      const Vec3 x(R * std::cos(angle), R * std::sin(angle), z);
      bool within = true, near = false;
      for (int i = 0; i < 3; ++i) {
        const Vec3 edge = c[(i + 1) % 3] - c[i], way = x - c[i];
        const double side_of_edge = n.dot(edge.cross(way));
        const double rounding = on_edge * n.norm() * edge.norm() * (R + c[i].norm());
        within &= side_of_edge >= -rounding;
        near |= side_of_edge < rounding;
      }
      if (!within) continue;
      if (near) return false;
      if (angle < 0.0) angle += 2.0 * kPi;
      if (angle >= 2.0 * kPi) angle -= 2.0 * kPi;
      // n . x falls behind the nearer side of the plane's normal.
      s_.crossings.push_back({angle, side > 0.0});
    }
    return true;
  }

  bool find_crossings(double z, double on_edge) {
    s_.crossings.clear();
    for (const auto& [slot, inside] : s_.radial.search.found) {
      Vec3 c[3];
      for (int i = 0; i < 3; ++i) c[i] = X_BA_ * a_.tree->corner(slot, i);
      if (!add_crossings(c, z, on_edge)) return false;
    }
    return true;
  }

  // The crossings of all triangles; where the circle passes through an edge, and rounding decides
  // which of the two faces it meets, perhaps none, those of a circle beside it.
  void find_crossings() {
    const double beside = kBesideEdge * b_.minor_radius();
    for (const double z : {0.0, beside, -1.7 * beside}) {
      if (find_crossings(z, kOnEdge)) return;
    }
    find_crossings(0.0, 0.0);
  }

  // What lies around those arcs of the circle that are inside of the mesh: the lines to the wall
  // begin at the circle where they meet no triangle. False when the crossings contradict each
  // other, as next to an edge.
  bool add_arcs(MomentSum& sum, double& depth_moment) {
    find_crossings();
    auto& crossings = s_.crossings;
    if (crossings.empty()) {
      const Vec3 p = X_AB_ * Vec3(b_.major_radius(), 0.0, 0.0);
      if (winding_around(a_, p, s_.cells) > 0) add_arc(0.0, 2.0 * kPi, sum, depth_moment);
      return true;
    }
    std::sort(crossings.begin(), crossings.end(),
              [](const auto& x, const auto& y) { return x.angle < y.angle; });
    const std::size_t count = crossings.size();
    for (std::size_t i = 0; i < count; ++i) {
      const auto &here = crossings[i], &next = crossings[(i + 1) % count];
      if (here.enters == next.enters) return false;
      if (!here.enters) continue;
      const double end = i + 1 == count ? next.angle + 2.0 * kPi : next.angle;
      add_arc(here.angle, end, sum, depth_moment);
    }
    return true;
  }

  void add_arc(double from, double to, MomentSum& sum, double& depth_moment) const {
    const double R = b_.major_radius(), a2 = b_.minor_radius() * b_.minor_radius();
    const double disc = kPi * a2, ring = 0.25 * kPi * a2 * a2, angle = to - from;
    const double sine = std::sin(to) - std::sin(from), cosine = std::cos(to) - std::cos(from);
    const double sine2 = std::sin(2.0 * to) - std::sin(2.0 * from);
    const double squares = std::sin(to) * std::sin(to) - std::sin(from) * std::sin(from);
    sum.volume += disc * R * angle;
    sum.first += (disc * R * R + ring) * Vec3(sine, -cosine, 0.0);
    const double across = disc * R * R * R + 3.0 * R * ring;
    sum.second(0, 0) += across * 0.5 * (angle + 0.5 * sine2);
    sum.second(1, 1) += across * 0.5 * (angle - 0.5 * sine2);
    sum.second(0, 1) += across * 0.5 * squares;
    sum.second(1, 0) += across * 0.5 * squares;
    sum.second(2, 2) += ring * R * angle;
    sum.counter_area += 2.0 * kPi * b_.minor_radius() * R * angle;
    depth_moment += R * kPi * a2 * b_.minor_radius() / 3.0 * angle;
  }

  const SurfaceView& a_;
  const Torus& b_;
  const Pose X_AB_;
  const Pose X_BA_;
  const InterferenceOptions& options_;
  TorusColumnsScratch& s_;
  Interference& out_;
};

}  // namespace

bool torus_columns(const SurfaceView& a, const Torus& b, const Pose& X_AB,
                   const InterferenceOptions& options, TorusColumnsScratch& scratch,
                   Interference& out) {
  return TorusColumns(a, b, X_AB, options, scratch, out).run();
}

}  // namespace volcontact
