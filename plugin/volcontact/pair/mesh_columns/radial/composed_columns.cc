// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/radial/composed_columns.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "volcontact/base/disjoint_sets.h"
#include "volcontact/pair/mesh_columns/contained.h"
#include "volcontact/pair/mesh_columns/layer_depth.h"
#include "volcontact/pair/mesh_columns/radial/bore_plug.h"

namespace volcontact {
namespace {

constexpr double kLeanAcross = 1e-12;        // how far a plane across an axis may lean
constexpr double kRadialError = 8.0;         // of the doubt of a sum along radii; as measured
constexpr double kComposedRestError = 1e-6;  // of V; as measured
constexpr double kSameSeam = 1e-9;   // of the size of a body: a bore through it ends in its faces
constexpr double kDeviations = 4.0;  // from its middle a region reaches no farther
constexpr double kPlacesOnWall[] = {0.5, 0.1, 0.9, 0.3, 0.7};  // of its length
constexpr double kAlongAxis = 0.5;  // share of the area vector: a face is pressed, not the wall

bool holds(const Aabb& bounds, const Vec3& p) {
  return bounds.min.at_most(p) && p.at_most(bounds.max);
}

class ComposedColumns {
 public:
  ComposedColumns(const SurfaceView& a, const Csg& b, const Pose& X_AB,
                  const InterferenceOptions& options, ColumnsScratch& columns,
                  RoundColumnsScratch& round, ComposedColumnsScratch& scratch, Interference& out)
      : a_(a),
        b_(b),
        X_AB_(X_AB),
        options_(options),
        columns_(columns),
        round_(round),
        s_(scratch),
        out_(out) {
    out.total = VolumeMetrics{};
    out.sites.clear();
  }

  bool run() {
    s_.sites.clear();
    const std::vector<CarvedPiece>& pieces = b_.carved_pieces();
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const bool done = std::visit(
          [&](const auto& body) {
            using Body = std::decay_t<decltype(body)>;
            if constexpr (HasFaces<Body>) {
              return add_piece(body, pieces[i], static_cast<int>(i));
            }
            return false;
          },
          pieces[i].body);
      if (!done) return false;
    }
    join_sites();
    for (VolumeMetrics& site : out_.sites) settle_status(site);
    settle_status(out_.total);
    return is_finite(out_.total);
  }

 private:
  // A part of little volume may be known to less than the tolerance of its own, and a sum no better
  // than its parts.
  void settle_status(VolumeMetrics& m) const {
    const bool precise = m.volume_error <= options_.tolerance * m.volume || !m.touching();
    if (!precise) m.status = Status::kApproximate;
    if (precise && m.status == Status::kApproximate) m.status = Status::kOk;
  }

  template <typename Body>
  bool add_piece(const Body& body, const CarvedPiece& piece, int number) {
    const Pose X_ABody = X_AB_ * piece.X_SB;
    const ConvexView view(body);
    if (view.bounded()) {
      for (int i = 0; i < 3; ++i) {
        const Vec3 e = Vec3::Unit(i);
        if (view.support_height(X_ABody, e) <= a_.bounds.min[i] ||
            -view.support_height(X_ABody, -e) >= a_.bounds.max[i]) {
          return true;
        }
      }
    }
    find_bores(piece);
    if (s_.bores.empty()) {
      if (!body_interference(body, X_ABody)) return false;
      for (const VolumeMetrics& site : s_.part.sites) s_.sites.push_back({site, number});
      return true;
    }
    if (!view.bounded() || bores_meet()) return false;
    // Along the radius to the wall; but where a face across it is pressed, the columns of the body
    // tell the depth, as long as what lies in the bore is not nearly all that they find.
    const std::size_t before = s_.sites.size();
    bool presses_wall = true;
    const bool radial = add_radial(view, piece, number, presses_wall);
    if (radial && presses_wall) return true;
    if (!radial) s_.sites.resize(before);
    const std::size_t end = s_.sites.size();
    if (body_interference(body, X_ABody) && add_without_bores(view, piece, number) &&
        (!radial || is_precise(end))) {
      s_.sites.erase(s_.sites.begin() + static_cast<std::ptrdiff_t>(before),
                     s_.sites.begin() + static_cast<std::ptrdiff_t>(end));
      return true;
    }
    s_.sites.resize(end);
    return radial;
  }

  bool is_precise(std::size_t first) const {
    return std::all_of(s_.sites.begin() + static_cast<std::ptrdiff_t>(first), s_.sites.end(),
                       [&](const ComposedColumnsScratch::Site& site) {
                         const VolumeMetrics& m = site.metrics;
                         return m.volume_error <= options_.tolerance * m.volume;
                       });
  }

  template <typename Body>
  bool body_interference(const Body& body, const Pose& X_ABody) {
    if constexpr (HasTriangles<Body>) {
      columns_interference(a_, surface_of(body, columns_.store[1]), X_ABody, options_, columns_,
                           s_.part);
      return true;
    } else if constexpr (HasRoundFaces<Body>) {
      return round_columns(a_, ConvexView(body), X_ABody, options_, round_, s_.part);
    } else {
      columns_interference(a_, body, X_ABody, options_, columns_, s_.part);
      return true;
    }
  }

  // Those that no plane touching the wall keeps off the bounds of A.
  void find_bores(const CarvedPiece& piece) {
    s_.bores.clear();
    const Pose X_BA = X_AB_.inverse();
    for (const Bore& bore : piece.bores) {
      const Vec3 out = bore.from_axis(X_BA * a_.bounds.center());
      const double length = out.norm();
      if (length > 0.0) {
        const Vec3 normal = bore.wall_normal(out / length);
        const Vec3 normal_A = X_AB_.rotation * normal;
        const double nearest = normal.dot(X_BA * a_.bounds.center() - bore.center) -
                               a_.bounds.half_sizes().dot(normal_A.cwiseAbs());
        if (nearest >= bore.radius) continue;
      }
      s_.bores.push_back(bore);
    }
  }

  // Along the radius to the walls. False when the overlap is bounded by other faces as well.
  bool add_radial(const ConvexView& body, const CarvedPiece& piece, int number,
                  bool& presses_wall) {
    std::uint64_t walls = 0, left = 0;  // bores at whose wall there is a patch; that leave one
    if (s_.bores.size() > 64) return false;
    for (std::size_t k = 0; k < s_.bores.size(); ++k) {
      const Pose X_SQ{basis_with_z(s_.bores[k].axis), s_.bores[k].center};
      if (!set_solid(body, piece, k, X_SQ)) return false;
      const Pose X_AQ = X_AB_ * X_SQ;
      if (radial_patches(a_, X_AQ.inverse(), s_.solid, options_, s_.radial) != RadialReach::kDone) {
        return false;
      }
      if (k == 0 && holds_other_faces(body, X_SQ.inverse() * piece.X_SB, X_AQ)) return false;
      bool split = false;
      RadialSum all;
      const std::uint64_t bit = std::uint64_t{1} << k;
      for (const RadialPatch& patch : s_.radial.patches) {
        if (patch.at_wall && patch.at_other) return false;
        if (patch.at_wall) walls |= bit;
        if (!patch.at_wall && patch.at_other) left |= bit;
        if (!patch.at_wall && (patch.at_other || k > 0)) continue;
        const Vec3& area = patch.sum.moments.area_vector;
        presses_wall &= !is_across(area);
        split |= !(patch.sum.moments.volume > 0.0);
        all.moments += patch.sum.moments;
        all.depth_moment += patch.sum.depth_moment;
        all.depth = std::max(all.depth, patch.sum.depth);
        all.doubt += patch.sum.doubt;
      }
      if (split) {
        add_site(all, X_AQ, number);
        continue;
      }
      for (const RadialPatch& patch : s_.radial.patches) {
        if (!patch.at_wall && (patch.at_other || k > 0)) continue;
        add_site(patch.sum, X_AQ, number);
      }
    }
    // Lines run from the wall of one bore: another one that A holds without a patch of its own is
    // no end of theirs, and would be counted as if it were filled.
    const std::uint64_t ends = walls != 0 ? walls : 1;
    for (std::size_t k = 0; k < s_.bores.size() && s_.bores.size() > 1; ++k) {
      if ((ends >> k & 1u) == 0 && holds_wall(body, piece, k)) return false;
    }
    // What one bore leaves to another must have been found there: bores that run into each other
    // may both see the patch behind the other one's wall.
    return left == 0 || (walls & (walls - 1)) != 0 || (walls != 0 && (left & walls) == 0);
  }

  // The piece in the frame Q of its bore k. False when its body has faces without a formula here.
  bool set_solid(const ConvexView& body, const CarvedPiece& piece, std::size_t k,
                 const Pose& X_SQ) {
    const Pose X_QBody = X_SQ.inverse() * piece.X_SB;
    s_.faces.clear();
    FaceWriter writer(s_.faces, X_QBody, Owner::kB);
    body.write_faces(writer);
    if (s_.faces.capsule[1].present) return false;
    RadialSolid& solid = s_.solid;
    solid.wall = RadialWall(s_.bores[k]);
    solid.rounds.assign(s_.faces.rounds.begin(), s_.faces.rounds.end());
    solid.planes.clear();
    for (const bool across : {true, false}) {
      for (const PlaneFace& plane : s_.faces.planes) {
        if ((1.0 - std::abs(plane.normal.z()) < kLeanAcross) != across) continue;
        solid.planes.push_back({plane.normal, plane.offset});
      }
      if (across) solid.planes_across = static_cast<int>(solid.planes.size());
    }
    solid.others.clear();
    for (std::size_t i = 0; i < s_.bores.size(); ++i) {
      if (i != k) solid.others.push_back(transformed(s_.bores[i], X_SQ));
    }
    return true;
  }

  // Whether a face to which no lines run lies in A without being cut by its surface.
  bool holds_other_faces(const ConvexView& body, const Pose& X_QBody, const Pose& X_AQ) {
    const auto in_a = [&](const Vec3& normal) {
      const Vec3 p = X_AQ * body.support(X_QBody, normal);
      return holds(a_.bounds, p) && winding_around(a_, p, columns_.cells) != 0;
    };
    const std::vector<SurfacePlane>& planes = s_.solid.planes;
    for (std::size_t i = static_cast<std::size_t>(s_.solid.planes_across); i < planes.size(); ++i) {
      if (in_a(planes[i].normal)) return true;
    }
    return !s_.solid.rounds.empty() && in_a(Vec3::UnitX());
  }

  // Whether A holds the wall of bore k half way through the body; of bores about one axis, where it
  // is a wall.
  bool holds_wall(const ConvexView& body, const CarvedPiece& piece, std::size_t k) {
    const Pose X_SQ{basis_with_z(s_.bores[k].axis), s_.bores[k].center};
    if (!set_solid(body, piece, k, X_SQ)) return false;
    const Pose X_QBody = X_SQ.inverse() * piece.X_SB, X_AQ = X_AB_ * X_SQ;
    const Vec3 up = Vec3::UnitZ();
    const std::optional<BorePlug> plug =
        bore_plug(s_.solid, -body.support_height(X_QBody, -up), body.support_height(X_QBody, up));
    if (!plug) return false;
    for (const double part : kPlacesOnWall) {
      const double z = (1.0 - part) * plug->low + part * plug->high;
      const Vec3 p(s_.solid.wall.radius + s_.solid.wall.slope * z, 0.0, z);
      const bool is_wall = std::none_of(
          s_.solid.others.begin(), s_.solid.others.end(),
          [&](const Bore& other) { return other.from_axis(p).norm() <= other.radius_at(p); });
      const Vec3 p_A = X_AQ * p;
      if (is_wall) return holds(a_.bounds, p_A) && winding_around(a_, p_A, columns_.cells) != 0;
    }
    return false;
  }

  // Whether a face across the axis is what pushes, and not the wall, which may be a cone.
  bool is_across(const Vec3& area) const {
    const double slope = std::abs(s_.solid.wall.slope), wall = slope / std::hypot(1.0, slope);
    return std::abs(area.z()) > std::max(kAlongAxis, 0.5 * (1.0 + wall)) * area.norm();
  }

  void add_site(RadialSum sum, const Pose& X_AQ, int number) {
    if (!(sum.moments.volume > 0.0)) return;
    // The faces across the axis close what the wall leaves open.
    sum.moments.counter_area =
        std::max(std::max(0.0, sum.moments.counter_area) + std::abs(sum.moments.area_vector.z()),
                 sum.moments.area_vector.norm());
    VolumeMetrics m = sum.moments.metrics();
    // From the wall of a cone columns along the normal are shorter than those across the axis.
    const double slant = std::hypot(1.0, s_.solid.wall.slope);
    m.depth_moment = sum.depth_moment / slant;
    m.depth = sum.depth / slant;
    if (is_across(m.area_vector)) {
      // Of a layer as thick everywhere.
      m.depth = m.volume / m.area_vector.norm();
      m.depth_moment = 0.5 * m.volume * m.depth;
    }
    m.volume_error = kRadialError * sum.doubt + kComposedRestError * m.volume;
    s_.sites.push_back({transformed(m, X_AQ), number});
  }

  // The overlap with the body, in `s_.part`, less what of it lies in the bores.
  bool add_without_bores(const ConvexView& body, const CarvedPiece& piece, int number) {
    std::swap(s_.whole, s_.part);
    VolumeMetrics rest = s_.whole.total;
    double counter_area = rest.counter_area;
    bool reached = false;
    if (!rest.touching()) return true;
    for (std::size_t k = 0; k < s_.bores.size(); ++k) {
      if (!stands_alone(k)) return false;
      const Pose X_SQ{basis_with_z(s_.bores[k].axis), s_.bores[k].center};
      if (!set_solid(body, piece, k, X_SQ) ||
          !subtract(body, X_SQ.inverse() * piece.X_SB, X_AB_ * X_SQ, rest, counter_area, reached)) {
        return false;
      }
    }
    if (!reached) {
      for (const VolumeMetrics& site : s_.whole.sites) s_.sites.push_back({site, number});
      return true;
    }
    // What was taken off is an estimate; no surface is smaller than its area vector.
    rest.counter_area = std::max(counter_area, rest.area_vector.norm());
    set_depth_of_layer(rest);  // what was taken off tells nothing of the longest column left
    if (!(rest.volume > 0.0)) return rest.volume_error < options_.tolerance * s_.whole.total.volume;
    s_.sites.push_back({rest, number});
    return true;
  }

  // Whether bores run into each other in A, other than about one axis: the lines from the wall of
  // one then pass through the other.
  bool bores_meet() const {
    for (std::size_t k = 1; k < s_.bores.size(); ++k) {
      for (std::size_t i = 0; i < k; ++i) {
        if (!about_one_axis(s_.bores[i], s_.bores[k]) && !are_apart(s_.bores[i], s_.bores[k])) {
          return true;
        }
      }
    }
    return false;
  }

  static bool about_one_axis(const Bore& a, const Bore& b) {
    return a.axis.cross(b.axis).norm() < kLeanAcross &&
           a.from_axis(b.center).norm() < kSameSeam * (a.radius + b.radius + a.center.norm());
  }

  // Whether a plane keeps two bores apart within the bounds of A, or all along if they are tubes.
  bool are_apart(const Bore& a, const Bore& b) const {
    const Vec3 across = a.axis.cross(b.axis);
    const double lean = across.norm();
    const Vec3 between =
        lean > kLeanAcross ? Vec3(across / lean) : a.from_axis(b.center).normalized();
    const double distance = std::abs(between.dot(b.center - a.center));
    return distance >= widest(a) + widest(b);
  }

  // The largest radius within the bounds of A.
  double widest(const Bore& bore) const {
    if (!bore.is_cone()) return bore.radius;
    const Pose X_BA = X_AB_.inverse();
    const Vec3 axis_A = X_AB_.rotation * bore.axis;
    const double top =
        bore.height(X_BA * a_.bounds.center()) + a_.bounds.half_sizes().dot(axis_A.cwiseAbs());
    return bore.slope * std::max(0.0, top);
  }

  // Whether a bore has nothing in common with those before it.
  bool stands_alone(std::size_t k) const {
    const Bore& bore = s_.bores[k];
    for (std::size_t i = 0; i < k; ++i) {
      const Bore& other = s_.bores[i];
      if (bore.is_cone() || other.is_cone() || bore.axis.cross(other.axis).norm() > kLeanAcross ||
          bore.from_axis(other.center).norm() < bore.radius + other.radius) {
        return false;
      }
    }
    return true;
  }

  // Takes away what A and the bore within the body have in common. The solid is set.
  bool subtract(const ConvexView& body, const Pose& X_QBody, const Pose& X_AQ, VolumeMetrics& rest,
                double& counter_area, bool& reached) {
    const Vec3 up = Vec3::UnitZ();
    const std::optional<BorePlug> plug =
        bore_plug(s_.solid, -body.support_height(X_QBody, -up), body.support_height(X_QBody, up));
    if (!plug || !plug_interference(*plug, X_AQ * plug->pose())) return false;
    const VolumeMetrics& inside = s_.part.total;
    if (!inside.touching()) return true;
    if (!plug->exact) return false;
    reached = true;
    rest = without(rest, inside);
    // Of the plug's surface its ends go, and its wall comes.
    const double ends = std::abs((X_AQ.rotation * up).dot(inside.area_vector));
    counter_area += inside.counter_area - 2.0 * ends;
    return true;
  }

  bool plug_interference(const BorePlug& plug, const Pose& X_APlug) {
    const double half = plug.half_length();
    if (plug.is_cylinder()) {
      const Cylinder cylinder({.radius = plug.top, .half_length = half});
      return round_columns(a_, ConvexView(cylinder), X_APlug, options_, round_, s_.part);
    }
    const Frustum frustum(
        {.bottom_radius = plug.bottom, .top_radius = plug.top, .half_length = half});
    return round_columns(a_, ConvexView(frustum), X_APlug, options_, round_, s_.part);
  }

  // Whether two regions lie next to each other at a seam, judged by where their volume is.
  static bool are_neighbours(const VolumeMetrics& a, const VolumeMetrics& b) {
    const Mat3 of_a = a.second_moment() / a.volume, of_b = b.second_moment() / b.volume;
    const Vec3 way = b.centroid - a.centroid;
    const double length = way.norm();
    if (!(length > 0.0)) return true;
    const Vec3 e = way / length;
    return length <= kDeviations * (std::sqrt(std::max(0.0, e.dot(of_a * e))) +
                                    std::sqrt(std::max(0.0, e.dot(of_b * e))));
  }

  bool share_seam(int p, int q) const {
    const std::vector<CarvedPiece>& pieces = b_.carved_pieces();
    for (const Seam& one : pieces[static_cast<std::size_t>(p)].seams) {
      for (const Seam& two : pieces[static_cast<std::size_t>(q)].seams) {
        if ((one.normal + two.normal).norm() < kSameSeam &&
            std::abs(one.offset + two.offset) < kSameSeam * (1.0 + std::abs(one.offset))) {
          return true;
        }
      }
    }
    return false;
  }

  // Regions on the two sides of a seam are one site.
  void join_sites() {
    const int n = static_cast<int>(s_.sites.size());
    std::vector<int>& of = s_.site_of;
    make_sets(of, s_.sites.size());
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < i; ++j) {
        if (s_.sites[i].piece == s_.sites[j].piece) continue;
        if (!share_seam(s_.sites[i].piece, s_.sites[j].piece)) continue;
        if (!are_neighbours(s_.sites[i].metrics, s_.sites[j].metrics)) continue;
        join_sets(of, i, j);
      }
    }
    for (int site = 0; site < n; ++site) {
      if (of[site] != site) continue;
      VolumeMetrics sum = s_.sites[site].metrics;
      for (int i = site + 1; i < n; ++i) {
        if (root_of(of, i) == site) sum = sum + s_.sites[i].metrics;
      }
      // Areas are estimated apart from S, and no surface has less area than S is long.
      const double least = sum.area_vector.norm();
      sum.area = std::max(sum.area, least);
      sum.counter_area = std::max(sum.counter_area, least);
      out_.total = out_.sites.empty() ? sum : out_.total + sum;
      out_.sites.push_back(sum);
    }
  }

  const SurfaceView& a_;
  const Csg& b_;
  const Pose& X_AB_;
  const InterferenceOptions& options_;
  ColumnsScratch& columns_;
  RoundColumnsScratch& round_;
  ComposedColumnsScratch& s_;
  Interference& out_;
};

}  // namespace

bool has_columns_pieces(const Csg& solid) {
  const std::vector<CarvedPiece>& pieces = solid.carved_pieces();
  return !pieces.empty() && std::all_of(pieces.begin(), pieces.end(), [](const CarvedPiece& piece) {
    return piece.bores.size() == piece.carved.size() && !std::holds_alternative<Torus>(piece.body);
  });
}

bool composed_columns(const SurfaceView& a, const Csg& b, const Pose& X_AB,
                      const InterferenceOptions& options, ColumnsScratch& columns,
                      RoundColumnsScratch& round, ComposedColumnsScratch& scratch,
                      Interference& out) {
  return ComposedColumns(a, b, X_AB, options, columns, round, scratch, out).run();
}

}  // namespace volcontact
