// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/radial/radial_patches.h"

#include <algorithm>
#include <cmath>

namespace volcontact {
namespace {

constexpr double kDoubtShare = 0.1;   // of the tolerance
constexpr double kDivideShare = 0.3;  // of the mean doubt: parts with more are divided
constexpr int kMostRounds = 12;
constexpr double kOnPlane = 1e-12;         // of the coordinates' size
constexpr double kSamplesPerRadius = 6.0;  // of an edge in a torus
constexpr double kMostSamples = 64.0;
constexpr int kThirds = 40;  // of the way around a minimum

// Corners of a triangle cut by planes.
struct Outline {
  static constexpr int kMost = 24;
  Vec3 corner[kMost];
  int count = 0;
};

class RadialPatches {
 public:
  RadialPatches(const SurfaceView& a, const Pose& X_QA, const RadialSolid& solid,
                const InterferenceOptions& options, RadialScratch& scratch)
      : a_(a), X_QA_(X_QA), solid_(solid), wall_(solid.wall), options_(options), s_(scratch) {}

  RadialReach run() {
    s_.patches.clear();
    s_.parts.clear();
    s_.slot_of_face.clear();
    s_.meets_other.clear();
    find_triangles_at_wall(*a_.tree, X_QA_, solid_, s_.search);
    for (const auto& [slot, inside] : s_.search.found) {
      if (inside) {
        const int face = static_cast<int>(s_.slot_of_face.size());
        s_.parts.push_back(
            {{corner_of(slot, 0), corner_of(slot, 1), corner_of(slot, 2)}, face, true, false, {}});
        s_.slot_of_face.push_back(slot);
        s_.meets_other.push_back(0);
        continue;
      }
      const RadialReach reach = add_triangle(slot);
      if (reach != RadialReach::kDone) return reach;
    }
    const int patches = join_faces(
        *a_.tree, s_.slot_of_face,
        [&](int slot, int e) {
          return edge_inside(corner_of(slot, e), corner_of(slot, (e + 1) % 3));
        },
        s_.joining, s_.patch_of_face);
    s_.patches.resize(static_cast<std::size_t>(patches));
    sort_by_patch();
    for (RadialPatch& patch : s_.patches) {
      if (!measure(patch)) return RadialReach::kBudget;
    }
    return RadialReach::kDone;
  }

 private:
  Vec3 corner_of(int slot, int i) const { return X_QA_ * a_.tree->corner(slot, i); }

  static double over(const SurfacePlane& plane, const Vec3& x) {
    return plane.normal.dot(x) - plane.offset;
  }

  static bool cut_by_plane(const SurfacePlane& plane, Outline& outline) {
    Outline kept;
    for (int i = 0; i < outline.count; ++i) {
      const Vec3 &p = outline.corner[i], &q = outline.corner[i + 1 == outline.count ? 0 : i + 1];
      const double h = over(plane, p), next = over(plane, q);
      if (kept.count + 2 > Outline::kMost) return false;
      if (h <= 0.0) kept.corner[kept.count++] = p;
      if ((h <= 0.0) != (next <= 0.0)) kept.corner[kept.count++] = p + h / (h - next) * (q - p);
    }
    outline = kept;
    return true;
  }

  RadialReach add_triangle(int slot) {
    Outline outline;
    outline.count = 3;
    for (int i = 0; i < 3; ++i) outline.corner[i] = corner_of(slot, i);
    for (const SurfacePlane& plane : solid_.planes) {
      if (!cut_by_plane(plane, outline)) return RadialReach::kBudget;
      if (outline.count < 3) return RadialReach::kDone;
    }
    bool meets_other = false;
    if (drops(outline, meets_other)) return RadialReach::kDone;
    if (is_beside(outline)) return RadialReach::kBeside;
    const int face = static_cast<int>(s_.slot_of_face.size());
    const std::size_t before = s_.parts.size();
    for (int i = 2; i < outline.count; ++i) {
      const Vec3 corner[3] = {outline.corner[0], outline.corner[i - 1], outline.corner[i]};
      if (!divide_at_wall(wall_, corner, face, 0, options_.most_cells, s_.parts))
        return RadialReach::kBudget;
    }
    if (s_.parts.size() == before) return RadialReach::kDone;
    s_.slot_of_face.push_back(slot);
    s_.meets_other.push_back(meets_other ? 1 : 0);
    return static_cast<int>(s_.parts.size()) > options_.most_cells ? RadialReach::kBudget
                                                                   : RadialReach::kDone;
  }

  // Whether another bore holds all of it; `meets` when it holds some.
  bool drops(const Outline& outline, bool& meets) const {
    for (const Bore& bore : solid_.others) {
      bool all = true;
      double least = kInfinity;
      Vec3 middle = Vec3::Zero();
      for (int i = 0; i < outline.count; ++i) {
        const Vec3& p = outline.corner[i];
        all &= bore.from_axis(p).norm() <= bore.radius_at(p);
        middle += p / outline.count;
      }
      if (all) return true;
      // The distance from the axis less the radius is convex: not below its tangent.
      const Vec3 out = bore.from_axis(middle);
      const double r = out.norm();
      const Vec3 slope = (r > 0.0 ? Vec3(out / r) : Vec3::Zero()) - bore.slope * bore.axis;
      for (int i = 0; i < outline.count; ++i) {
        least = std::min(least, r - bore.radius_at(middle) + slope.dot(outline.corner[i] - middle));
      }
      meets |= least <= 0.0;
    }
    return false;
  }

  // Whether it reaches, in the solid, a face of the body that the lines do not run along.
  bool is_beside(const Outline& outline) const {
    const auto in_solid = [&](const Vec3& p) { return wall_.level(p) < 0.0; };
    for (std::size_t k = static_cast<std::size_t>(solid_.planes_across); k < solid_.planes.size();
         ++k) {
      const SurfacePlane& plane = solid_.planes[k];
      for (int i = 0; i < outline.count; ++i) {
        const Vec3& p = outline.corner[i];
        const double slack = kOnPlane * (std::abs(plane.offset) + p.cwiseAbs().sum());
        if (over(plane, p) >= -slack && in_solid(p)) return true;
      }
    }
    for (const RoundFace& round : solid_.rounds) {
      for (int i = 0; i < outline.count; ++i) {
        if (round(outline.corner[i]) >= -kOnPlane) return true;
      }
    }
    return false;
  }

  // Whether an edge of the mesh has some of its length in the solid.
  bool edge_inside(const Vec3& p, const Vec3& q) const {
    RayInterval in{0.0, 1.0};
    for (const SurfacePlane& plane : solid_.planes) {
      const double h = over(plane, p), slope = plane.normal.dot(q - p);
      if (slope > 0.0) {
        in.leave = std::min(in.leave, -h / slope);
      } else if (slope < 0.0) {
        in.enter = std::max(in.enter, -h / slope);
      } else if (h > 0.0) {
        return false;
      }
    }
    if (in.empty()) return false;
    const auto level = [&](double t) { return wall_.level(p + t * (q - p)); };
    if (!wall_.torus) return level(in.enter) < 0.0 || level(in.leave) < 0.0;  // concave
    // The least of the samples, and what lies around the least ones.
    const double count = std::ceil(kSamplesPerRadius * (q - p).norm() / wall_.major);
    const int samples = static_cast<int>(std::clamp(count, 4.0, kMostSamples));
    double before = level(0.0), here = before;
    for (int i = 0; i <= samples; ++i) {
      const double after = i < samples ? level((i + 1.0) / samples) : here;
      if (here < 0.0) return true;
      if (here <= before && here <= after &&
          least_between(level, (i - 1.0) / samples, (i + 1.0) / samples) < 0.0) {
        return true;
      }
      before = here;
      here = after;
    }
    return false;
  }

  // The least value of a function with one minimum on a part of [0, 1].
  template <typename Function>
  static double least_between(const Function& f, double low, double high) {
    low = std::max(low, 0.0);
    high = std::min(high, 1.0);
    for (int step = 0; step < kThirds; ++step) {
      const double third = (high - low) / 3.0;
      if (f(low + third) < f(high - third)) {
        high -= third;
      } else {
        low += third;
      }
    }
    return f(0.5 * (low + high));
  }

  // Faces and parts, patch after patch, each in the order in which they were found.
  void sort_by_patch() {
    const std::size_t patches = s_.patches.size();
    s_.starts.assign(patches + 1, 0);
    for (const int patch : s_.patch_of_face) ++s_.starts[patch + 1];
    for (std::size_t i = 0; i < patches; ++i) {
      s_.starts[i + 1] += s_.starts[i];
      s_.patches[i].first = s_.starts[i];
      s_.patches[i].last = s_.starts[i + 1];
    }
    s_.face_order.resize(s_.patch_of_face.size());
    for (std::size_t i = 0; i < s_.patch_of_face.size(); ++i) {
      s_.face_order[s_.starts[s_.patch_of_face[i]]++] = static_cast<int>(i);
    }
    s_.starts.assign(patches + 1, 0);
    for (const RadialPart& part : s_.parts) ++s_.starts[s_.patch_of_face[part.face] + 1];
    for (std::size_t i = 0; i < patches; ++i) s_.starts[i + 1] += s_.starts[i];
    s_.part_order.resize(s_.parts.size());
    std::vector<int>& next = s_.joining.parent;
    next.assign(s_.starts.begin(), s_.starts.end());
    for (std::size_t i = 0; i < s_.parts.size(); ++i) {
      s_.part_order[next[s_.patch_of_face[s_.parts[i].face]]++] = static_cast<int>(i);
    }
  }

  bool measure(RadialPatch& patch) {
    const std::size_t index = static_cast<std::size_t>(&patch - s_.patches.data());
    s_.parts_here.clear();
    for (int k = s_.starts[index]; k < s_.starts[index + 1]; ++k) {
      s_.parts_here.push_back(s_.parts[s_.part_order[k]]);
      patch.at_wall |= !s_.parts_here.back().inside;
    }
    for (int k = patch.first; k < patch.last; ++k) {
      patch.at_other |= s_.meets_other[s_.face_order[k]] != 0;
    }
    for (int round = 0;; ++round) {
      patch.sum = sum_parts();
      const double most = kDoubtShare * options_.tolerance * std::abs(patch.sum.moments.volume);
      if (patch.sum.doubt <= most || round == kMostRounds) return true;
      if (static_cast<int>(s_.parts_here.size()) > options_.most_cells) return true;
      if (!divide_doubtful(patch.sum.doubt)) return false;
    }
  }

  RadialSum sum_parts() {
    s_.pieces.clear();
    s_.doubts.assign(s_.parts_here.size(), 0.0);
    int number = 0;
    for (const RadialPart& part : s_.parts_here) add_pieces(part, number++, s_.pieces);
    s_.pieces.end();
    return sum_radial_columns(wall_, s_.pieces, s_.search.path, s_.doubts);
  }

  bool divide_doubtful(double doubt) {
    const double least = kDivideShare * doubt / static_cast<double>(s_.parts_here.size());
    s_.divided.clear();
    for (std::size_t i = 0; i < s_.parts_here.size(); ++i) {
      const RadialPart& part = s_.parts_here[i];
      if (s_.doubts[i] <= least) {
        s_.divided.push_back(part);
        continue;
      }
      const Vec3(&c)[3] = part.corner;
      const int j = edge_to_divide(wall_, part), k = (j + 1) % 3, l = (j + 2) % 3;
      const Vec3 middle = 0.5 * (c[j] + c[k]);
      const Vec3 halves[2][3] = {{c[j], middle, c[l]}, {middle, c[k], c[l]}};
      for (const Vec3(&half)[3] : halves) {
        if (part.inside) {
          s_.divided.push_back({{half[0], half[1], half[2]}, part.face, true, false, {}});
        } else if (!divide_at_wall(wall_, half, part.face, 0, 4 * options_.most_cells,
                                   s_.divided)) {
          return false;
        }
      }
    }
    std::swap(s_.parts_here, s_.divided);
    return true;
  }

  const SurfaceView& a_;
  const Pose& X_QA_;
  const RadialSolid& solid_;
  const RadialWall& wall_;
  const InterferenceOptions& options_;
  RadialScratch& s_;
};

}  // namespace

RadialReach radial_patches(const SurfaceView& a, const Pose& X_QA, const RadialSolid& solid,
                           const InterferenceOptions& options, RadialScratch& scratch) {
  return RadialPatches(a, X_QA, solid, options, scratch).run();
}

}  // namespace volcontact
