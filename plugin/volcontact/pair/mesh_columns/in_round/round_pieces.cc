// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/in_round/round_pieces.h"

#include <algorithm>
#include <cmath>

#include "volcontact/base/interrupt.h"

#define VOLCONTACT_SIMD_KERNEL "volcontact/pair/mesh_columns/in_round/round_search_kernel.inc"
#include "volcontact/base/simd_paths.inc"
#undef VOLCONTACT_SIMD_KERNEL

namespace volcontact {
namespace {

// Of an arc over its chord, where the solid is scaled to be round; a triangle with more is divided.
constexpr double kSag = 0.3;
constexpr int kMostHalvings = 10;     // of an arc
constexpr int kMostPasses = 6;        // over the arcs of a polygon
constexpr double kSlivers = 10.0;     // by the tolerance, of the area of the polygon within
constexpr double kMostSlivers = 0.3;  // the same where it is one of many
constexpr int kMostDivisions = 24;    // of a triangle in four
constexpr double kNeedle = 1.0 / 16;  // width of a triangle over its length
constexpr double kTinySag = 1e-9;     // of the solid's size
constexpr double kRounding = 1e-13;   // the same

// Corners of a plane convex polygon, at most those of a triangle cut by two planes.
struct Outline {
  Vec3 corner[8];
  int count = 0;
  void add(const Vec3& p) { corner[count++] = p; }
  template <typename Height>
  bool has_above(Height&& height) const {
    return std::any_of(corner, corner + count, [&](const Vec3& p) { return height(p) > 0.0; });
  }
};

// Cuts one triangle of A by the faces of B.
class FaceCut {
 public:
  FaceCut(const RoundSolid& solid, int face, double sliver_share, RoundPieces& pieces,
          std::vector<Vec3>& corners)
      : s_(solid), face_(face), sliver_share_(sliver_share), pieces_(pieces), corner_(corners) {}

  void add_inside(const Vec3 (&corner)[3], bool deep) {
    for (int i = 0; i < 3 && !deep; ++i) add_line_of_round(corner[i], corner[i == 2 ? 0 : i + 1]);
    add_triangle(corner[0], corner[1], corner[2]);
  }

  // Cuts by the plane faces, at the seams, then each part by the round face.
  void cut(const Vec3 (&corner)[3]) {
    normal_ = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    if (normal_.isZero(0.0)) return;
    Outline outline;
    for (const Vec3& p : corner) outline.add(p);
    for (int k = 0; k < s_.plane_count; ++k) {
      cut_by_plane([&](const Vec3& x) { return s_.over_plane(k, x); }, outline);
    }
    if (!(s_.half_length > 0.0)) return cut_by_round(outline);
    // The tube of a capsule and its balls apart: across a seam columns do not change smoothly, and
    // over the length of a slender one few would see the balls.
    for (const double way : {1.0, -1.0}) {
      const auto beyond = [&](const Vec3& x) { return way * along_axis(x) - s_.half_length; };
      if (!outline.has_above(beyond)) continue;
      Outline ball = outline;
      cut_by_plane([&](const Vec3& x) { return -beyond(x); }, ball);
      cut_by_round(ball);
      cut_by_plane(beyond, outline);
    }
    in_tube_ = true;
    cut_by_round(outline);
  }

 private:
  double level(const Vec3& x, Vec3& gradient) const { return round_level(s_, x, gradient); }
  // From the middle of a capsule.
  double along_axis(const Vec3& x) const {
    return Vec3::from(s_.axis).dot(x - Vec3::from(s_.center));
  }

  // Leaves what is not above, where `height` is negative.
  template <typename Height>
  static void cut_by_plane(Height&& height, Outline& outline) {
    Outline kept;
    for (int i = 0; i < outline.count; ++i) {
      const Vec3 &p = outline.corner[i], &q = outline.corner[i + 1 == outline.count ? 0 : i + 1];
      const double h = height(p), next = height(q);
      if (h <= 0.0) kept.add(p);
      if ((h <= 0.0) != (next <= 0.0)) kept.add(p + h / (h - next) * (q - p));
    }
    outline = kept;
    if (outline.count < 3) outline.count = 0;
  }

  void cut_by_round(const Outline& outline) {
    for (int i = 2; i < outline.count; ++i) {
      cut_by_round(outline.corner[0], outline.corner[i - 1], outline.corner[i], 0);
    }
  }

  void divide(const Vec3& a, const Vec3& b, const Vec3& c, int level) {
    InterruptScope::poll();
    const double ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
    const double least = kNeedle * kNeedle * std::max({ab, bc, ca});
    if (bc < least) return divide_needle(a, b, c, level);
    if (ca < least) return divide_needle(b, c, a, level);
    if (ab < least) return divide_needle(c, a, b, level);
    for (const RoundPieces::Triangle& t : RoundPieces::Triangle{{a, b, c}, face_}.quarters()) {
      cut_by_round(t.corner[0], t.corner[1], t.corner[2], level + 1);
    }
  }
  // In half along its length alone: across it there is nothing to find, as many times as it is cut.
  void divide_needle(const Vec3& tip, const Vec3& b, const Vec3& c, int level) {
    const Vec3 middle_b = 0.5 * (tip + b), middle_c = 0.5 * (tip + c);
    cut_by_round(tip, middle_b, middle_c, level + 1);
    cut_by_round(middle_b, b, c, level + 1);
    cut_by_round(middle_b, c, middle_c, level + 1);
  }

  void cut_by_round(const Vec3& a, const Vec3& b, const Vec3& c, int divisions) {
    const Vec3 corner[3] = {a, b, c};
    std::copy(corner, corner + 3, part_);
    Vec3 gradient;
    bool inside[3];
    int count_inside = 0, count_deep = 0;
    for (int i = 0; i < 3; ++i) {
      const double f = level(corner[i], gradient);
      inside[i] = f <= 0.0;
      count_inside += inside[i] ? 1 : 0;
      count_deep += f <= s_.wall_level ? 1 : 0;
    }
    if (count_inside == 3) return add_inside(corner, count_deep > 1);
    if (count_inside == 0) {
      const Vec3 middle = (a + b + c) / 3.0;
      const double f = level(middle, gradient);
      double least = kInfinity;
      for (const Vec3& p : corner) least = std::min(least, gradient.dot(p - middle));
      if (f + least > 0.0) return;
    }
    // The outline inside: parts of the edges, and arcs from where it leaves to where it enters.
    Vec3 outline[6];
    bool arc_after[6];
    Arc arc[6];
    int count = 0;
    for (int i = 0; i < 3; ++i) {
      const int j = i == 2 ? 0 : i + 1;
      const Vec3 &p = corner[i], d = corner[j] - corner[i];
      RayInterval in{0.0, 1.0};
      if (!inside[i] || !inside[j]) {
        const RayInterval ray = round_interval(s_, p, d);
        if (inside[i]) {
          in.leave = ray.empty() ? 0.0 : std::clamp(ray.leave, 0.0, 1.0);
        } else if (inside[j]) {
          in.enter = ray.empty() ? 1.0 : std::clamp(ray.enter, 0.0, 1.0);
        } else {
          in = {std::max(ray.enter, 0.0), std::min(ray.leave, 1.0)};
          if (ray.empty() || in.empty()) continue;
        }
      }
      outline[count] = inside[i] ? p : Vec3(p + in.enter * d);
      arc_after[count++] = false;
      if (inside[j]) continue;
      outline[count] = p + in.leave * d;
      arc_after[count++] = true;
    }
    // Where the plane only touches, what rounding finds inside would be followed to the last.
    if (divisions == 0 && only_touches(corner, gradient, count == 0 ? kTinySag : kRounding)) return;
    if (count == 0) {
      if (divisions < kMostDivisions && reaches_in(a, b, c)) divide(a, b, c, divisions);
      return;
    }
    for (int i = 0; i < count; ++i) {
      if (!arc_after[i]) continue;
      arc[i] = arc_between(outline[i], outline[i + 1 == count ? 0 : i + 1]);
      if (bends_much(arc[i]) && divisions < kMostDivisions) return divide(a, b, c, divisions);
    }
    add_outline(outline, arc_after, arc, count);
  }

  // Whether the plane of a triangle goes less deep into the round face than `share` of its size.
  // `gradient` is that of the level somewhere on it.
  bool only_touches(const Vec3 (&corner)[3], const Vec3& gradient, double share) const {
    return least_round_level(s_, corner, normal_.normalized()) >=
           -share * s_.size * gradient.norm();
  }

  // Whether a triangle without corners and edges in the solid may hold all of its section.
  bool reaches_in(const Vec3& a, const Vec3& b, const Vec3& c) const {
    // From the middle downhill along the plane: where the level is least, it is not negative for
    // long unless the section is there.
    Vec3 x = (a + b + c) / 3.0, gradient;
    const Vec3 n = normal_.normalized();
    for (int step = 0; step < 4; ++step) {
      const double f = level(x, gradient);
      const double rounding = kRounding * s_.size * gradient.norm();
      if (f <= -rounding) return true;
      const Vec3 slope = gradient - gradient.dot(n) * n;
      const double steepness = slope.squaredNorm();
      double least = kInfinity;
      for (const Vec3& p : {a, b, c}) least = std::min(least, slope.dot(p - x));
      // An edge along the round face would be followed to the last.
      if (f + least > -rounding) return false;
      x -= f / steepness * slope;
    }
    return true;
  }

  bool in_triangle(const Vec3& x) const {
    for (int i = 0; i < 3; ++i) {
      const Vec3 edge = part_[i == 2 ? 0 : i + 1] - part_[i];
      if (normal_.dot(edge.cross(x - part_[i])) < -1e-9 * normal_.norm() * edge.squaredNorm()) {
        return false;
      }
    }
    return true;
  }

  // An arc of the round face in the plane of the triangle, from p to q.
  struct Arc {
    Vec3 p, q, tip;  // the tip is the point farthest from the chord, nearly
    double sag;      // and so far from it
    double chord() const { return (q - p).norm(); }
  };

  // Of a slender solid an arc along it is as flat as it may be, and yet half of the section.
  bool bends_much(const Arc& arc) const {
    const Vec3 way = scaled(arc.tip - 0.5 * (arc.p + arc.q));
    return arc.sag > kTinySag * s_.size &&
           way.squaredNorm() > kSag * kSag * scaled(arc.q - arc.p).squaredNorm();
  }
  // In the frame in which the round face is that of a ball, tube or cone of unit size.
  Vec3 scaled(const Vec3& d) const {
    const Vec3 axis = Vec3::from(s_.axis);
    const Vec3 x = in_tube_ ? Vec3(d - axis.dot(d) * axis) : d;
    return {Vec3::from(s_.map[0]).dot(x), Vec3::from(s_.map[1]).dot(x),
            Vec3::from(s_.map[2]).dot(x)};
  }

  // An arc does not leave the triangle: what is found beyond is the far side of a section that is
  // touched in a point.
  Arc arc_between(const Vec3& p, const Vec3& q) const {
    const Vec3 middle = 0.5 * (p + q), outward = (q - p).cross(normal_);
    const Arc none{p, q, middle, 0.0};
    const double length = outward.norm();
    if (!(length > 0.0)) return none;
    const RayInterval ray = round_interval(s_, middle, outward / length);
    const double sag = ray.empty() || !std::isfinite(ray.leave) ? 0.0 : std::max(0.0, ray.leave);
    const Arc arc{p, q, middle + sag / length * outward, sag};
    return in_triangle(arc.tip) ? arc : none;
  }

  void add_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    pieces_.triangles.push_back({{a, b, c}, face_});
  }

  // Appends the points of the arc after p, before q, and the slivers that they leave, none of them
  // larger than `most` where halving can help it.
  void add_arc(const Arc& arc, double most, int halvings) {
    if (!(arc.sag > 0.0)) {
      if (s_.has_axis && arc.chord() > 0.0) add_empty_sliver(arc.p, arc.q);
      return;
    }
    const double area = 2.0 / 3.0 * arc.chord() * arc.sag;
    if (area > most && halvings < kMostHalvings) {
      add_arc(arc_between(arc.p, arc.tip), most, halvings + 1);
      corner_.push_back(arc.tip);
      add_arc(arc_between(arc.tip, arc.q), most, halvings + 1);
      return;
    }
    pieces_.slivers.push_back({0.5 * (arc.p + arc.q), area * unit_, arc.tip, face_});
  }

  // No sliver beside a straight line of the round face, but the outline runs there.
  void add_empty_sliver(const Vec3& p, const Vec3& q) {
    const Vec3 middle = 0.5 * (p + q);
    pieces_.slivers.push_back({middle, Vec3::Zero(), middle, face_});
  }

  // An edge that runs along the round face may be inside by rounding alone.
  void add_line_of_round(const Vec3& p, const Vec3& q) {
    if (!s_.has_axis) return;
    for (const Vec3& x : {p, Vec3(0.5 * (p + q)), q}) {
      Vec3 gradient;
      if (level(x, gradient) <= s_.wall_level) return;
    }
    if (p != q) add_empty_sliver(p, q);
  }

  // With as many points on the arcs as make the slivers small beside the polygon within them.
  void add_outline(const Vec3* outline, const bool* arc_after, const Arc* arc, int count) {
    const std::size_t before = pieces_.slivers.size();
    unit_ = normal_.normalized();
    double most = kInfinity;
    for (int pass = 0; pass < kMostPasses; ++pass) {
      pieces_.slivers.resize(before);
      corner_.clear();
      for (int i = 0; i < count; ++i) {
        corner_.push_back(outline[i]);
        if (arc_after[i]) {
          add_arc(arc[i], most, 0);
        } else {
          add_line_of_round(outline[i], outline[i + 1 == count ? 0 : i + 1]);
        }
      }
      double area = 0.0, slivers = 0.0;
      for (std::size_t i = 2; i < corner_.size(); ++i) {
        area += 0.5 * unit_.dot((corner_[i - 1] - corner_[0]).cross(corner_[i] - corner_[0]));
      }
      for (std::size_t i = before; i < pieces_.slivers.size(); ++i) {
        slivers += pieces_.slivers[i].area_vector.norm();
      }
      if (slivers <= sliver_share_ * area) break;
      most = sliver_share_ * (area + slivers) / 8.0;
    }
    for (std::size_t i = 2; i < corner_.size(); ++i) {
      add_triangle(corner_[0], corner_[i - 1], corner_[i]);
    }
  }

  const RoundSolid& s_;
  const int face_;
  const double sliver_share_;
  RoundPieces& pieces_;
  Vec3 normal_, unit_;
  Vec3 part_[3];          // of the triangle, that is cut by the round face now
  bool in_tube_ = false;  // of a capsule
  std::vector<Vec3>& corner_;
};

// Whether some part of an edge lies in the solid.
bool edge_inside(const RoundSolid& s, const Vec3& p, const Vec3& q) {
  RayInterval in = round_interval(s, p, q - p);
  if (in.empty()) return false;
  in = {std::max(0.0, in.enter), std::min(1.0, in.leave)};
  for (int k = 0; k < s.plane_count; ++k) {
    const double h = s.over_plane(k, p), slope = s.plane_normal(k).dot(q - p);
    if (slope > 0.0) {
      in.leave = std::min(in.leave, -h / slope);
    } else if (slope < 0.0) {
      in.enter = std::max(in.enter, -h / slope);
    } else if (h > 0.0) {
      return false;
    }
  }
  return !in.empty();
}

std::size_t triangle_count(const ObbTree& tree) {
  std::size_t count = 0;
  for (const ObbTree::Leaf& leaf : tree.leaves) count += static_cast<std::size_t>(leaf.count);
  return count;
}

}  // namespace

bool find_round_pieces(const ObbTree& tree, const Vec3& origin, const RoundSolid& solid,
                       const InterferenceOptions& options, RoundSearchScratch& scratch,
                       RoundPieces& pieces) {
  const auto corner_of = [&](int slot, int i) -> Vec3 { return tree.corner(slot, i) - origin; };
  VOLCONTACT_SIMD_CALL(scratch.path, find_triangles_near, tree, origin, solid, scratch);
  // The columns at the rim of a patch are short, and the more triangles it has, the less of it are
  // those at the rim.
  const double many = static_cast<double>(scratch.found.size());
  const double share = std::min(kMostSlivers, options.tolerance * std::max(kSlivers, many));
  pieces.triangles.clear();
  pieces.slivers.clear();
  pieces.slot_of_face.clear();
  pieces.patch_count = 0;
  bool uncut = !scratch.found.empty();
  for (const auto& [slot, inside, deep] : scratch.found) {
    const int face = static_cast<int>(pieces.slot_of_face.size());
    const std::size_t before = pieces.triangles.size() + pieces.slivers.size();
    const Vec3 corner[3] = {corner_of(slot, 0), corner_of(slot, 1), corner_of(slot, 2)};
    FaceCut cut(solid, face, share, pieces, scratch.corners);
    if (inside && !(solid.half_length > 0.0)) {
      cut.add_inside(corner, deep);
    } else {
      cut.cut(corner);
    }
    uncut &= inside;
    // A section as thin as its arcs has slivers alone.
    if (pieces.triangles.size() + pieces.slivers.size() > before) {
      pieces.slot_of_face.push_back(slot);
    }
    if (static_cast<int>(pieces.triangles.size()) > options.most_cells) return false;
  }
  pieces.whole = uncut && scratch.found.size() == triangle_count(tree);
  if (!pieces.whole) {
    pieces.patch_count = join_faces(
        tree, pieces.slot_of_face,
        [&](int slot, int e) {
          return edge_inside(solid, corner_of(slot, e), corner_of(slot, (e + 1) % 3));
        },
        scratch.joining, pieces.patch_of_face);
  }
  return true;
}

}  // namespace volcontact
