// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/in_round/round_columns.h"

#include <algorithm>
#include <cmath>

#include "volcontact/pair/mesh_columns/contained.h"
#include "volcontact/pair/mesh_columns/in_round/points_within.h"
#include "volcontact/pair/mesh_columns/layer_depth.h"

namespace volcontact {
namespace {

using Patch = RoundColumnsScratch::Patch;
using Triangle = RoundPieces::Triangle;
using Sliver = RoundPieces::Sliver;

constexpr double kAlmostWhole = 1e-4;  // of B's volume
constexpr double kTipDepth = 1e-4;     // of the depth of a patch: B looks down at its outline
constexpr double kDoubtShare = 0.03;   // of the tolerance, left to the rule on the triangles
// The rule may err by this much of what it differs by from the rough one, where the end of the
// columns has a kink or a vertical tangent within a triangle; 0.03 of it is the median.
constexpr double kRoughError = 5.0;
constexpr double kRoughShare = 0.8;    // of the tolerance, left to that
constexpr double kSliverError = 0.25;  // of their volume; as measured
constexpr double kRestError = 1e-7;    // of V; as measured
constexpr double kSeamError = 1e-4;    // the same where faces of B meet
constexpr double kLooksUp = 1e-9;      // of a plane face: the sine of its slope
constexpr double kSteepShare = 0.02;   // of V, over a triangle that is large
constexpr double kChangeError = 0.03;  // of what the last division changes: error that is left
constexpr double kStarError = 4.0;     // of the doubt of what is seen from a point; as measured
constexpr double kStarShare = 0.1;     // of the tolerance: most that this adds to the doubt
constexpr double kFlat = 1e-9;         // of the area of a patch: what its vector lacks
constexpr double kAlongAxis = 1e-5;    // sine of an angle
constexpr int kMostRounds = 6;         // of divisions of triangles
constexpr double kAlmostAxis = 0.97, kAlmostAcross = 0.3;

std::size_t padded(std::size_t count) { return (count + kLanes - 1) / kLanes * kLanes; }

// Surface integrals over the triangles and slivers of one patch, in Q.
struct PatchSurface {
  Vec3 area_vector = Vec3::Zero(), area_moment = Vec3::Zero();
  double area = 0.0;

  void add(const Vec3& n_dA, const Vec3& middle) {
    area_vector += n_dA;
    area_moment += middle.cross(n_dA);
    area += n_dA.norm();
  }
};

class RoundColumns {
 public:
  RoundColumns(const SurfaceView& a, const ConvexView& b, const Pose& X_AB,
               const InterferenceOptions& options, RoundColumnsScratch& scratch, Interference& out)
      : a_(a),
        b_(b),
        X_AB_(X_AB),
        options_(options),
        s_(scratch),
        out_(out),
        origin_(b.middle(X_AB)) {
    out.total = VolumeMetrics{};
    out.sites.clear();
  }

  bool run() {
    if (bounds_apart()) return true;
    const VolumeMetrics own_b = b_.own_metrics();
    if (!(own_b.volume > 0.0)) return true;
    own_volume_ = own_b.volume;
    if (!round_solid_of(b_, X_QB(), s_.faces, solid_)) return false;
    if (holds_all_of_a()) return add_contained(a_.own, a_.surface_area, 0.0);
    if (!find_round_pieces(*a_.tree, origin_, solid_, options_, s_.search, s_.pieces)) {
      return false;
    }
    if (s_.pieces.whole) return add_contained(a_.own, a_.surface_area, 0.0);
    if (s_.pieces.triangles.empty()) {
      if (winding_around(a_, origin_, s_.cells) <= 0) return true;
      return add_contained(transformed(own_b, X_AB_), 0.0, 0.0);
    }
    sort_by_patch();
    for (Patch& patch : s_.patches) measure(patch);
    add_sites(transformed(own_b, X_QB()));
    VolumeMetrics& total = out_.total;
    if (total.volume_error > options_.tolerance * total.volume) total.status = Status::kApproximate;
    return is_finite(total);
  }

 private:
  Pose X_QB() const { return {X_AB_.rotation, X_AB_.translation - origin_}; }

  bool bounds_apart() const {
    for (int i = 0; i < 3; ++i) {
      const Vec3 e = Vec3::Unit(i);
      if (b_.support_height(X_AB_, e) <= a_.bounds.min[i] ||
          -b_.support_height(X_AB_, -e) >= a_.bounds.max[i]) {
        return true;
      }
    }
    return false;
  }

  // B is convex: the corners of A's bounds tell.
  bool holds_all_of_a() const {
    for (int corner = 0; corner < 8; ++corner) {
      Vec3 p, gradient;
      for (int i = 0; i < 3; ++i) p[i] = (corner >> i & 1 ? a_.bounds.max : a_.bounds.min)[i];
      p -= origin_;
      if (round_level(solid_, p, gradient) > 0.0) return false;
      for (int k = 0; k < solid_.plane_count; ++k) {
        if (solid_.over_plane(k, p) > 0.0) return false;
      }
    }
    return true;
  }

  bool add_contained(VolumeMetrics own, double area, double counter_area) {
    own.area = area;
    own.counter_area = counter_area;
    own.status = Status::kContained;
    out_.sites.push_back(own);
    out_.total = own;
    return true;
  }

  // Patch after patch, each in the order in which its pieces were found.
  void sort_by_patch() {
    const RoundPieces& pieces = s_.pieces;
    s_.patches.assign(static_cast<std::size_t>(pieces.patch_count), Patch{});
    const auto sort = [&](const auto& items, std::vector<int>& order, auto first, auto last) {
      s_.starts.assign(s_.patches.size() + 1, 0);
      for (const auto& item : items) ++s_.starts[pieces.patch_of_face[item.face] + 1];
      for (std::size_t i = 0; i < s_.patches.size(); ++i) {
        s_.starts[i + 1] += s_.starts[i];
        s_.patches[i].*first = s_.starts[i];
        s_.patches[i].*last = s_.starts[i + 1];
      }
      order.resize(items.size());
      int index = 0;
      for (const auto& item : items) order[s_.starts[pieces.patch_of_face[item.face]]++] = index++;
    };
    sort(pieces.triangles, s_.triangle_order, &Patch::first_triangle, &Patch::last_triangle);
    sort(pieces.slivers, s_.sliver_order, &Patch::first_sliver, &Patch::last_sliver);
  }

  // The metrics of what lies below the patch, down to B's surface. Their volume is negative where
  // the patch is the surface of a cavity, or looks down on all of B.
  void measure(Patch& patch) {
    PatchSurface surface;
    s_.pieces_of_patch.clear();
    for (int k = patch.first_triangle; k < patch.last_triangle; ++k) {
      const Triangle& t = s_.pieces.triangles[s_.triangle_order[k]];
      s_.pieces_of_patch.push_back(t);
      surface.add(0.5 * (t.corner[1] - t.corner[0]).cross(t.corner[2] - t.corner[0]),
                  (t.corner[0] + t.corner[1] + t.corner[2]) / 3.0);
    }
    const std::size_t slivers = static_cast<std::size_t>(patch.last_sliver - patch.first_sliver);
    s_.points.resize(padded(slivers));
    for (std::size_t i = 0; i < slivers; ++i) {
      const Sliver& sliver =
          s_.pieces.slivers[s_.sliver_order[static_cast<std::size_t>(patch.first_sliver) + i]];
      surface.add(sliver.area_vector, sliver.middle);
      for (int k = 0; k < 3; ++k) {
        s_.points.middle[k][i] = sliver.middle[k];
        s_.points.tip[k][i] = sliver.tip[k];
        s_.points.area_vector[k][i] = sliver.area_vector[k];
      }
    }
    find_active_planes();
    Vec3 up = Vec3::UnitZ();
    const double length = surface.area_vector.norm();
    if (length > 1e-12 * surface.area) up = surface.area_vector / length;
    // Beside a wall that leans by next to nothing columns have all lengths within next to nothing.
    if (solid_.has_axis && up.cross(solid_.axis_direction).norm() < kAlongAxis) {
      up = std::copysign(1.0, up.dot(solid_.axis_direction)) * solid_.axis_direction;
    }
    const auto works = [&](const Vec3& direction) {
      return try_direction(direction.normalized(), slivers, surface, patch);
    };
    if (works(up)) return;
    if (solid_.has_axis) {
      const Vec3& axis = solid_.axis_direction;
      const double along = up.dot(axis);
      if (std::abs(along) < kAlmostAcross && works(up - along * axis)) return;
      if (std::abs(along) > kAlmostAxis && works(std::copysign(1.0, along) * axis)) return;
    }
    const Vec3 against = against_outline(slivers);
    if (up.dot(against) > 0.0 && works(against)) return;
    if (!works(-up)) return look_from_point(surface, patch);
    // Seen from behind, a shallow patch is what all of B leaves: its rest is the difference of two
    // large volumes, and a point tells it better.
    const double rest = own_volume_ - std::abs(patch.moments.volume);
    if (patch.volume_error <= options_.tolerance * rest) return;
    const Patch from_behind = patch;
    look_from_point(surface, patch);
    if (!(patch.volume_error < from_behind.volume_error)) patch = from_behind;
  }

  // Where no direction sees the patch whole, a point inside of B does: B is convex.
  void look_from_point(const PatchSurface& surface, Patch& patch) {
    s_.slivers_of_patch.clear();
    for (int k = patch.first_sliver; k < patch.last_sliver; ++k) {
      s_.slivers_of_patch.push_back(s_.pieces.slivers[s_.sliver_order[k]]);
    }
    const StarSum sum = sum_star(solid_, point_off_faces(b_, X_QB(), s_.pieces_of_patch),
                                 s_.pieces_of_patch, s_.slivers_of_patch,
                                 kDoubtShare * options_.tolerance, options_.most_cells, s_.star);
    patch.moments = sum.moments;
    patch.moments.area_vector = surface.area_vector;
    patch.moments.area_moment = surface.area_moment;
    patch.moments.area = surface.area;
    patch.moments.counter_area =
        std::max(std::abs(sum.moments.counter_area), surface.area_vector.norm());
    // The columns of a flat patch run along its normal.
    patch.deep = !(surface.area_vector.norm() > (1.0 - kFlat) * surface.area);
    patch.depth = sum.depth;
    patch.depth_moment = sum.depth_moment;
    const double volume = std::abs(sum.moments.volume);
    const double more =
        std::min((kStarError - 1.0) * sum.doubt, kStarShare * options_.tolerance * volume);
    patch.volume_error = sum.doubt + more + kSliverError * sum.slivers + kSeamError * volume;
  }

  // Which plane faces of B the outline of the patch may run along.
  void find_active_planes() {
    for (int k = 0; k < solid_.plane_count; ++k) {
      double highest = -kInfinity, lowest = kInfinity;
      for (const Triangle& t : s_.pieces_of_patch) {
        for (const Vec3& p : t.corner) {
          const double h = solid_.over_plane(k, p);
          highest = std::max(highest, h);
          lowest = std::min(lowest, h);
        }
      }
      active_[k] = highest > -1e-12 * (std::abs(solid_.offset[k]) - lowest);
    }
  }

  // Down along the mean normals of the faces of B that the outline runs along.
  Vec3 against_outline(std::size_t slivers) const {
    Vec3 round = Vec3::Zero(), gradient;
    for (std::size_t i = 0; i < slivers; ++i) {
      const Vec3 tip(s_.points.tip[0][i], s_.points.tip[1][i], s_.points.tip[2][i]);
      round_level(solid_, tip, gradient);
      round += gradient.normalized();
    }
    Vec3 sum = -round.stableNormalized();
    for (int k = 0; k < solid_.plane_count; ++k) {
      if (active_[k]) sum -= solid_.plane_normal(k);
    }
    return sum.isZero(1e-9) ? Vec3::UnitZ() : Vec3(sum.normalized());
  }

  // False when the solid looks upwards somewhere on the outline of the patch.
  bool try_direction(const Vec3& up, std::size_t slivers, const PatchSurface& surface,
                     Patch& patch) {
    for (int k = 0; k < solid_.plane_count; ++k) {
      if (active_[k] && solid_.plane_normal(k).dot(up) > kLooksUp) return false;
    }
    s_.parts = s_.pieces_of_patch;
    s_.excess.clear();
    for (int k = 0; k < solid_.plane_count; ++k) {
      split_at_rim(solid_, k, up, s_.parts, s_.divided, s_.excess);
      std::swap(s_.parts, s_.divided);
    }
    RoundSum sum = sum_parts(up);
    // A patch that is all edge on, as the sides of a bar through B, has no columns.
    for (std::size_t i = 0; i < slivers; ++i) {
      if (s_.points.tip_depth[i] > kTipDepth * sum.longest) return false;
    }
    double changed = 0.0;
    for (int round = 0; round < kMostRounds; ++round) {
      const bool first = round == 0 && is_steep(sum);
      if (!first && precise(sum)) break;
      const double before = sum.volume;
      divide_doubtful(sum, first);
      sum = sum_parts(up);
      changed = std::abs(sum.volume - before);
    }
    const double excess_doubt = take_excess(sum) + kChangeError * changed;
    const Vec3 n = surface.area_vector.stableNormalized();
    RoundSum along_n = sum;  // what the depth is about
    if (!n.isZero(0.0) && up.dot(n) < 1.0 - 1e-9 && up.dot(n) > 0.0) along_n = sum_parts(n);
    // Few columns see a steep face of B; no surface is smaller than its area vector.
    patch.moments = {sum.volume,
                     sum.first,
                     sum.second,
                     surface.area_vector,
                     surface.area_moment,
                     surface.area,
                     std::max(std::abs(sum.counter_area), surface.area_vector.norm())};
    patch.depth_moment = along_n.energy;
    patch.depth = longest_column(along_n, n.isZero(0.0) ? up : n);
    patch.volume_error = error_of(sum) + excess_doubt;
    return true;
  }

  // Takes away what the triangles count too much; returns in what doubt that is.
  double take_excess(RoundSum& sum) const {
    double doubt = 0.0;
    for (const RimExcess& excess : s_.excess) {
      sum.volume -= excess.volume;
      sum.first -= excess.volume * excess.middle;
      sum.second -= outer(excess.volume * excess.middle, excess.middle);
      sum.energy -= excess.volume * excess.length;
      doubt += excess.doubt;
    }
    return doubt;
  }

  // Of those that were summed, and of those at the corners of the triangle that has it.
  double longest_column(const RoundSum& sum, const Vec3& up) const {
    double longest = sum.longest;
    for (std::size_t i = 0; i < s_.parts.size(); ++i) {
      if (s_.triangles.longest[i] < sum.longest) continue;
      for (const Vec3& x : s_.parts[i].corner) longest = std::max(longest, column_from(x, up));
      break;
    }
    return longest;
  }
  double column_from(const Vec3& x, const Vec3& up) const {
    double length = round_interval(solid_, x, -up).leave;
    for (int k = 0; k < solid_.plane_count; ++k) {
      const double speed = -solid_.plane_normal(k).dot(up);
      if (speed > 0.0) length = std::min(length, -solid_.over_plane(k, x) / speed);
    }
    return std::isfinite(length) ? length : 0.0;
  }

  double error_of(const RoundSum& sum) const {
    const double volume = std::abs(sum.volume);
    const double rest = solid_.has_axis ? kSeamError : kRestError;
    return kRoughError * sum.difference + kSliverError * sum.slivers + rest * volume;
  }
  bool precise(const RoundSum& sum) const {
    const double volume = std::abs(sum.volume);
    return sum.doubt <= kDoubtShare * options_.tolerance * volume &&
           kRoughError * sum.difference <= kRoughShare * options_.tolerance * volume;
  }

  RoundSum sum_parts(const Vec3& up) {
    s_.triangles.resize(padded(s_.parts.size()));
    std::size_t i = 0;
    for (const Triangle& t : s_.parts) s_.triangles.set(i++, t.corner[0], t.corner[1], t.corner[2]);
    return sum_round_columns(solid_, up, s_.triangles, s_.points, s_.search.path);
  }

  // Whether columns from large triangles end on steep faces. There both rules may err by the same,
  // on all triangles at once where these are alike: then a first division tells.
  bool is_steep(const RoundSum& sum) const {
    const double least = kSteepShare * std::abs(sum.volume);
    return std::any_of(s_.triangles.steep.begin(), s_.triangles.steep.end(),
                       [&](double steep) { return steep > least; });
  }

  // In four, those that hold most of the doubt, and those from which columns end on steep faces if
  // `steep`.
  void divide_doubtful(const RoundSum& sum, bool steep) {
    const double least = 0.3 * sum.doubt / static_cast<double>(s_.parts.size());
    const double steepest = steep ? kSteepShare * std::abs(sum.volume) : kInfinity;
    s_.divided.clear();
    for (std::size_t i = 0; i < s_.parts.size(); ++i) {
      const Triangle& t = s_.parts[i];
      if (s_.triangles.doubt[i] < least && s_.triangles.steep[i] <= steepest) {
        s_.divided.push_back(t);
        continue;
      }
      for (const Triangle& part : t.quarters()) s_.divided.push_back(part);
    }
    std::swap(s_.parts, s_.divided);
  }

  // Each patch splits B in two; inside of A is what lies below all of them, where below a patch
  // with a negative volume means: but for that volume. What is common to all cancels in whole
  // copies of B, of which there are as many as make the volume possible.
  void add_sites(const VolumeMetrics& own_b) {
    double volume = 0.0;
    int copies = 0;
    for (const Patch& patch : s_.patches) {
      volume += patch.moments.volume;
      if (patch.moments.volume < 0.0) ++copies;
    }
    const bool split = copies > 0;
    const double share = volume / own_b.volume + copies;
    const double whole = std::round(share);
    // Next to a whole number rounding has decided; then a point of B does.
    if (std::abs(share - whole) < kAlmostWhole) {
      const bool filled =
          winding_around(a_, origin_ + point_off_edges(b_, X_QB(), s_.pieces.triangles), s_.cells) >
          0;
      copies += (filled ? 1 : 0) - static_cast<int>(whole);
    } else {
      copies -= static_cast<int>(std::floor(share));
    }
    if (copies == 0 && !split) {
      for (const Patch& patch : s_.patches) add_site(patch);
    } else {
      add_site(joined(own_b, copies));
    }
  }

  // All patches, and copies of B, whose metrics are in Q.
  Patch joined(const VolumeMetrics& own_b, int copies) const {
    Patch all{};
    all.deep = true;
    const Vec3 first = copies * own_b.volume * own_b.centroid;
    all.moments.volume = copies * own_b.volume;
    all.moments.first = first;
    all.moments.second = copies * own_b.second_moment() + outer(first, own_b.centroid);
    for (const Patch& patch : s_.patches) {
      all.moments += patch.moments;
      all.volume_error += patch.volume_error;
    }
    return all;
  }

  void add_site(const Patch& patch) {
    if (!(patch.moments.volume > 0.0)) return;
    VolumeMetrics m = patch.moments.metrics();
    m.depth_moment = patch.depth_moment;
    m.depth = patch.depth;
    if (patch.deep) set_depth_of_layer(m);
    m.volume_error = patch.volume_error;
    out_.sites.push_back(transformed(m, Pose{Mat3::Identity(), origin_}));
    out_.total = out_.total + out_.sites.back();
  }

  const SurfaceView& a_;
  const ConvexView& b_;
  const Pose& X_AB_;
  const InterferenceOptions& options_;
  RoundColumnsScratch& s_;
  Interference& out_;
  const Vec3 origin_;
  RoundSolid solid_;
  bool active_[2] = {false, false};
  double own_volume_ = 0.0;  // of B
};

}  // namespace

bool round_columns(const SurfaceView& a, const ConvexView& b, const Pose& X_AB,
                   const InterferenceOptions& options, RoundColumnsScratch& scratch,
                   Interference& out) {
  return RoundColumns(a, b, X_AB, options, scratch, out).run();
}

}  // namespace volcontact
