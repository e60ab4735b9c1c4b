// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/clip.h"

#include <algorithm>
#include <limits>

#include "volcontact/pair/box_faces.h"
#include "volcontact/pair/region_sum.h"
#include "volcontact/pair/separation.h"

namespace volcontact {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// A face with less than this share of the region's surface is rounding noise.
constexpr double kNoFace = 1e-13;
// |S| below this share of the surface is rounding noise: no direction.
constexpr double kNoDirection = 1e-14;

// --- The two solids as planes normal . x <= offset, in A's axes about a local origin near both.

struct AlignedBox {  // the box A
  static constexpr bool kHasUprightSides = true;
  Vec3 half;
  Vec3 origin;
  int size() const { return 6; }
  Vec3 normal(int f) const { return (f & 1 ? 1.0 : -1.0) * Vec3::Unit(f >> 1); }
  double offset(int f) const { return half[f >> 1] - (f & 1 ? origin[f >> 1] : -origin[f >> 1]); }
};

struct PosedBox {  // the box B
  static constexpr bool kHasUprightSides = true;
  const Vec3& half;
  const Mat3& rotation;
  Vec3 center;
  int size() const { return 6; }
  Vec3 normal(int f) const { return box_normal(f, rotation); }
  double offset(int f) const { return half[f >> 1] + normal(f).dot(center); }
};

struct AlignedPolytope {  // the polytope A
  static constexpr bool kHasUprightSides = false;
  const ConvexPolytope& solid;
  Vec3 origin;
  int size() const { return static_cast<int>(solid.faces().size()); }
  const Vec3& normal(int f) const { return solid.faces()[f].normal; }
  double offset(int f) const { return solid.faces()[f].offset - normal(f).dot(origin); }
};

struct PosedPolytope {  // the polytope B
  static constexpr bool kHasUprightSides = false;
  const ConvexPolytope& solid;
  const Mat3& rotation;
  Vec3 translation;
  int size() const { return static_cast<int>(solid.faces().size()); }
  Vec3 normal(int f) const { return rotation * solid.faces()[f].normal; }
  double offset(int f) const { return solid.faces()[f].offset + normal(f).dot(translation); }
};

void start(const PosedBox& b, ClipScratch& scratch) {
  static const PolytopeGraph graph = [] {
    std::vector<Vec3> corners(8);
    place_corners(Vec3::Ones(), Mat3::Identity(), Vec3::Zero(), corners.data());
    std::vector<std::vector<int>> loops;
    for (const auto& loop : kBoxLoops) loops.emplace_back(std::begin(loop), std::end(loop));
    return make_polytope_graph(corners, loops);
  }();
  scratch.polytope.start(graph);
  place_corners(b.half, b.rotation, b.center, scratch.polytope.points().data());
}

void start(const PosedPolytope& b, ClipScratch& scratch) {
  scratch.corners.clear();
  for (const Vec3& v : b.solid.vertices()) {
    scratch.corners.push_back(b.rotation * v + b.translation);
  }
  const PolytopeGraph& graph = b.solid.graph();
  scratch.polytope.start(graph);
  const std::span<Vec3> points = scratch.polytope.points();
  for (std::size_t v = 0; v < points.size(); ++v) points[v] = scratch.corners[graph.corner[v]];
}

// --- Cutting B by A's planes; false when nothing is left. A's faces are numbered after B's,
// `middle` is a point in the middle of B.

Aabb bounds_of(std::span<const Vec3> points) {
  Aabb box{points[0], points[0]};
  for (const Vec3& p : points) {
    box.min = box.min.cwiseMin(p);
    box.max = box.max.cwiseMax(p);
  }
  return box;
}

bool cut(const AlignedBox& a, int face, int first_face, double rounding, CutPolytope& polytope) {
  const int axis = face >> 1;
  const double offset = a.offset(face);
  const auto above = [=](const Vec3& p) { return p[axis] - offset; };
  const auto below = [=](const Vec3& p) { return -p[axis] - offset; };
  return face & 1 ? polytope.cut(above, first_face + face, rounding)
                  : polytope.cut(below, first_face + face, rounding);
}

// The plane that leaves least of B goes first: the later cuts then find little to do.
bool cut(const AlignedBox& a, const Vec3&, int first_face, double rounding, CutPolytope& polytope) {
  const Aabb box = bounds_of(polytope.points());
  int deepest = 0;
  double least = kInfinity;
  for (int f = 0; f < 6; ++f) {
    const int axis = f >> 1;
    const double left = a.offset(f) + (f & 1 ? -box.min[axis] : box.max[axis]);
    const double share = left / (box.max[axis] - box.min[axis]);
    if (share < least) {
      least = share;
      deepest = f;
    }
  }
  if (!cut(a, deepest, first_face, rounding, polytope)) return false;
  for (int f = 0; f < 6; ++f) {
    const int axis = f >> 1;
    const double excess = (f & 1 ? box.max[axis] : -box.min[axis]) - a.offset(f);
    if (f == deepest || !(excess > rounding)) continue;
    if (!cut(a, f, first_face, rounding, polytope)) return false;
  }
  return true;
}

bool cut(const AlignedPolytope& a, int face, int first_face, double rounding,
         CutPolytope& polytope) {
  const Vec3& normal = a.normal(face);
  const double offset = a.offset(face);
  return polytope.cut([&](const Vec3& p) { return normal.dot(p) - offset; }, first_face + face,
                      rounding);
}

bool cut(const AlignedPolytope& a, const Vec3& middle, int first_face, double rounding,
         CutPolytope& polytope) {
  int deepest = 0;
  double highest = -kInfinity;
  for (int f = 0; f < a.size(); ++f) {
    const double height = a.normal(f).dot(middle) - a.offset(f);
    if (height > highest) {
      highest = height;
      deepest = f;
    }
  }
  if (!cut(a, deepest, first_face, rounding, polytope)) return false;
  const Aabb left = bounds_of(polytope.points());
  const Vec3 center = left.center(), half = left.half_sizes();
  for (int f = 0; f < a.size(); ++f) {
    const double reach = a.normal(f).dot(center) + a.normal(f).cwiseAbs().dot(half);
    if (f == deepest || !(reach > a.offset(f))) continue;
    if (!cut(a, f, first_face, rounding, polytope)) return false;
  }
  return true;
}

// --- Measuring what is left.

// A region with its two solids. Everything about the local origin, but sum.origin is the origin of
// the sums and of the depths.
template <typename SolidA, typename SolidB>
class Region {
 public:
  Region(const SolidA& a, const SolidB& b, double rounding, ClipScratch& scratch)
      : a_(a),
        b_(b),
        rounding_(rounding),
        polytope_(scratch.polytope),
        overlay_(scratch.overlay),
        outline_(scratch.outline),
        neighbors_(scratch.neighbors),
        faces_(scratch.polytope.faces()) {}

  // In A's axes, about A's origin given that of the local origin.
  VolumeMetrics measure(const Vec3& local_origin) {
    sum_faces();
    const double surface = sum_.area + sum_.counter_area;
    const double volume_error = 8.0 * kEpsilon * sum_.volume + 2.0 * rounding_ * surface;
    if (!(sum_.volume > volume_error)) return VolumeMetrics{};
    VolumeMetrics m = sum_.metrics();
    m.volume_error = volume_error;
    const Vec3 shift = local_origin + sum_.origin;
    m.centroid += shift;
    const Faces of_a = count_faces(true), of_b = count_faces(false);
    if (of_a.count == 0 || of_b.count == 0) {
      m.status = Status::kContained;
      return m;
    }
    m.area_moment = sum_.area_moment + shift.cross(sum_.area_vector);
    const double length = sum_.area_vector.norm();
    if (!(length > kNoDirection * surface)) return m;
    m.area_vector = sum_.area_vector;
    const Vec3 normal = -sum_.area_vector / length;
    m.depth = extent_along(normal);
    m.depth_moment = depth_moment(normal, of_a, of_b);
    return m;
  }

 private:
  bool is_a(const FaceLoop& face) const { return face.face >= b_.size(); }
  Vec3 normal(const FaceLoop& face) const {
    return is_a(face) ? Vec3(a_.normal(face.face - b_.size())) : Vec3(b_.normal(face.face));
  }
  const Vec3& vertex(const FaceLoop& face, int i) const {
    return polytope_.points()[polytope_.loop_vertices()[face.first + i]];
  }

  void sum_faces() {
    // On a plane of A, so that depths under that plane do not cancel.
    sum_.origin = vertex(faces_[0], 0);
    for (const FaceLoop& face : faces_) {
      if (is_a(face)) sum_.origin = vertex(face, 0);
    }
    const std::span<const Vec3> points = polytope_.points();
    for (FaceLoop& face : faces_) {
      const Vec3 n = normal(face);
      const int* loop = polytope_.loop_vertices().data() + face.first;
      const FaceIntegral integral = sum_.add_face(
          face.count, [=](int i) -> const Vec3& { return points[loop[i]]; }, n, rounding_);
      face.area = integral.area;
      if (is_a(face)) {
        sum_.area += integral.area;
        sum_.area_vector += integral.area * n;
        sum_.area_moment += integral.first.cross(n);
      } else {
        sum_.counter_area += integral.area;
      }
    }
  }

  // The faces of one solid that are more than rounding noise: how many, and one of them.
  struct Faces {
    int count = 0;
    const FaceLoop* one = nullptr;
  };
  Faces count_faces(bool of_a) const {
    const double no_face = kNoFace * (sum_.area + sum_.counter_area);
    Faces faces;
    for (const FaceLoop& face : faces_) {
      if (is_a(face) != of_a || !(face.area > no_face)) continue;
      if (faces.count == 0 || faces.one->face != face.face) ++faces.count;
      faces.one = &face;
    }
    return faces;
  }

  double extent_along(const Vec3& direction) const {
    double low = kInfinity, high = -kInfinity;
    for (const Vec3& p : polytope_.points()) {
      const double height = direction.dot(p);
      low = std::min(low, height);
      high = std::max(high, height);
    }
    return high - low;
  }

  double depth_moment(const Vec3& normal, const Faces& of_a, const Faces& of_b) {
    // With one face of a solid in the region, columns reach to its plane. The sides of a polytope
    // may lean inwards and end them earlier, but that shows only where the other solid overhangs.
    if (of_a.count == 1 && (SolidA::kHasUprightSides || !has_overhang(*of_a.one))) {
      return depth_under(*of_a.one);
    }
    if (of_b.count == 1 && (SolidB::kHasUprightSides || !has_overhang(*of_b.one))) {
      return depth_under(*of_b.one);
    }
    return overlay_energy(normal);
  }

  // int (distance below the plane of a face) dV.
  double depth_under(const FaceLoop& face) const {
    const Vec3 n = normal(face);
    return n.dot(vertex(face, 0) - sum_.origin) * sum_.volume - n.dot(sum_.first);
  }

  // Whether the other solid looks along this face's normal somewhere.
  bool has_overhang(const FaceLoop& of) const {
    const Vec3 n = normal(of);
    return std::any_of(faces_.begin(), faces_.end(), [&](const FaceLoop& face) {
      return is_a(face) != is_a(of) && normal(face).dot(n) > kNoFace;
    });
  }

  // Height of the plane normal . x = offset over the (u, v) plane, all in the columns' frame C.
  static HeightPlane height_of(const Vec3& normal, double offset) {
    return {offset / normal.z(), -normal.x() / normal.z(), -normal.y() / normal.z()};
  }
  // So steep along the columns that it has no shadow.
  static bool is_steep(const Vec3& normal) { return std::abs(normal.z()) < kNoFace; }

  // The general case. A lies on the side of the normal, above.
  double overlay_energy(const Vec3& contact_normal) {
    const Mat3 R_CA = basis_with_z(contact_normal).transpose();
    overlay_.start(a_.size() + b_.size());
    for (const FaceLoop& face : faces_) add_to_overlay(face, R_CA);
    if (overlay_.has_overhang()) {
      for_planes(b_, R_CA, true, [&](const HeightPlane& plane) { overlay_.add_ceiling(plane); });
      for_planes(a_, R_CA, false, [&](const HeightPlane& plane) { overlay_.add_floor(plane); });
    }
    return overlay_.energy();
  }

  void add_to_overlay(const FaceLoop& face, const Mat3& R_CA) {
    const Vec3 n = R_CA * normal(face);
    if (is_steep(n)) return;
    const bool upper = n.z() > 0.0;
    outline_.clear();
    neighbors_.clear();
    Vec3 p = Vec3::Zero();
    for (int i = 0; i < face.count; ++i) {
      p = R_CA * (vertex(face, i) - sum_.origin);
      outline_.push_back(p.head<2>());
      neighbors_.push_back(polytope_.face_across(face.first + i));
    }
    const HeightPlane height = height_of(n, n.dot(p));
    if (upper) {
      overlay_.add_upper(height, is_a(face), outline_);
    } else {
      overlay_.add_lower(face.face, height, !is_a(face), outline_, neighbors_);
    }
  }

  template <typename Solid, typename Visit>
  void for_planes(const Solid& solid, const Mat3& R_CA, bool upper, Visit&& visit) const {
    for (int f = 0; f < solid.size(); ++f) {
      const Vec3 normal_A = solid.normal(f), n = R_CA * normal_A;
      if (is_steep(n) || (n.z() > 0.0) != upper) continue;
      visit(height_of(n, solid.offset(f) - normal_A.dot(sum_.origin)));
    }
  }

  const SolidA& a_;
  const SolidB& b_;
  const double rounding_;
  const CutPolytope& polytope_;
  ColumnOverlay& overlay_;
  std::vector<Eigen::Vector2d>& outline_;
  std::vector<int>& neighbors_;
  std::span<FaceLoop> faces_;
  RegionSum sum_;
};

template <typename SolidA, typename SolidB>
VolumeMetrics clip_solids(const SolidA& a, const SolidB& b, const Vec3& middle, double rounding,
                          ClipScratch& scratch) {
  start(b, scratch);
  if (!cut(a, middle, b.size(), rounding, scratch.polytope)) return VolumeMetrics{};
  return Region<SolidA, SolidB>(a, b, rounding, scratch).measure(a.origin);
}

// The whole of a box, inside the other solid.
VolumeMetrics contained(const Box& box, const Pose& X_AX, bool is_a, double rounding) {
  VolumeMetrics m = transformed(box.own_metrics(), X_AX);
  const double surface = surface_of(box);
  (is_a ? m.area : m.counter_area) = surface;
  m.volume_error = 8.0 * kEpsilon * m.volume + rounding * surface;
  m.status = Status::kContained;
  return m;
}

// Whether a box lies in another one; pose of its axes and centre in those of the outer one.
bool lies_in(const Vec3& half, const Vec3& outer_half, const Mat3& R, const Vec3& p) {
  return ((p.cwiseAbs() + R.cwiseAbs() * half).array() <= outer_half.array()).all();
}

// The point of A's bounds nearest to the middle of B: sums about the origin of A would lose digits
// when A is large.
Vec3 nearest_in(const Aabb& bounds, const Vec3& p) {
  return p.cwiseMax(bounds.min).cwiseMin(bounds.max);
}

// Rounding error of a position where coordinates reach this far.
double rounding_at(double reach) { return 4.0 * kEpsilon * reach; }

}  // namespace

VolumeMetrics clip(const Box& a, const Box& b, const Pose& X_AB, ClipScratch& scratch) noexcept {
  const Vec3 &half_a = a.half_sizes(), &half_b = b.half_sizes(), &p_AB = X_AB.translation;
  const Mat3& R_AB = X_AB.rotation;
  if (boxes_apart(half_a, half_b, R_AB, p_AB)) return VolumeMetrics{};
  if (half_a.minCoeff() <= 0.0 || half_b.minCoeff() <= 0.0) return VolumeMetrics{};
  const AlignedBox planes{half_a, nearest_in(a.bounds(), p_AB)};
  const PosedBox box{half_b, R_AB, p_AB - planes.origin};
  const double rounding = rounding_at(box.center.lpNorm<1>() + half_b.sum());
  if (lies_in(half_b, half_a, R_AB, p_AB)) return contained(b, X_AB, false, rounding);
  const Mat3 R_BA = R_AB.transpose();
  if (lies_in(half_a, half_b, R_BA, R_BA * p_AB)) return contained(a, Pose{}, true, rounding);
  return clip_solids(planes, box, box.center, rounding, scratch);
}

VolumeMetrics clip(const Box& a, const ConvexPolytope& b, const Pose& X_AB,
                   ClipScratch& scratch) noexcept {
  const Aabb bounds = b.bounds();
  const Vec3 p_AM = X_AB * bounds.center(), half_b = bounds.half_sizes();
  if (boxes_apart(a.half_sizes(), half_b, X_AB.rotation, p_AM)) return VolumeMetrics{};
  if (a.half_sizes().minCoeff() <= 0.0) return VolumeMetrics{};
  const AlignedBox planes{a.half_sizes(), nearest_in(a.bounds(), p_AM)};
  const PosedPolytope polytope{b, X_AB.rotation, X_AB.translation - planes.origin};
  const double rounding =
      rounding_at((p_AM - planes.origin).lpNorm<1>() + bounds.center().lpNorm<1>() + half_b.sum());
  return clip_solids(planes, polytope, p_AM - planes.origin, rounding, scratch);
}

VolumeMetrics clip(const ConvexPolytope& a, const ConvexPolytope& b, const Pose& X_AB,
                   ClipScratch& scratch) noexcept {
  const Aabb bounds_a = a.bounds(), bounds_b = b.bounds();
  const Vec3 half_a = bounds_a.half_sizes(), half_b = bounds_b.half_sizes();
  const Vec3 p_AM = X_AB * bounds_b.center();
  if (boxes_apart(half_a, half_b, X_AB.rotation, p_AM - bounds_a.center())) return VolumeMetrics{};
  const AlignedPolytope planes{a, nearest_in(bounds_a, p_AM)};
  const PosedPolytope polytope{b, X_AB.rotation, X_AB.translation - planes.origin};
  const double rounding =
      rounding_at((p_AM - planes.origin).lpNorm<1>() + bounds_b.center().lpNorm<1>() +
                  half_b.sum() + bounds_a.center().lpNorm<1>() + half_a.sum());
  return clip_solids(planes, polytope, p_AM - planes.origin, rounding, scratch);
}

}  // namespace volcontact
