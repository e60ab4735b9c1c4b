// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/clip.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "volcontact/pair/separation.h"

namespace volcontact {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// A face with less than this share of the region's surface is rounding noise.
constexpr double kNoFace = 1e-13;
// |S| below this share of the surface is rounding noise: no direction.
constexpr double kNoDirection = 1e-14;

// --- The two solids as planes normal . x <= offset, in A's axes about a local origin near both.

// The half-space A; the local origin lies on its plane.
struct Ground {
  static constexpr bool kIsFlatSided = true;
  int size() const { return 1; }
  Vec3 normal(int) const { return Vec3::UnitZ(); }
  double offset(int) const { return 0.0; }
};

// The box A. Face 2 i + 1 looks along +axis i, face 2 i against it.
struct AlignedBox {
  static constexpr bool kIsFlatSided = true;
  Vec3 half;
  Vec3 origin;
  int size() const { return 6; }
  Vec3 normal(int f) const { return (f & 1 ? 1.0 : -1.0) * Vec3::Unit(f >> 1); }
  double offset(int f) const { return half[f >> 1] - (f & 1 ? origin[f >> 1] : -origin[f >> 1]); }
};

// The box B.
struct PosedBox {
  static constexpr bool kIsFlatSided = true;
  const Vec3& half;
  const Mat3& rotation;
  Vec3 center;
  int size() const { return 6; }
  Vec3 normal(int f) const {
    return f & 1 ? Vec3(rotation.col(f >> 1)) : Vec3(-rotation.col(f >> 1));
  }
  double offset(int f) const { return half[f >> 1] + normal(f).dot(center); }
};

// The polytope A.
struct AlignedPolytope {
  static constexpr bool kIsFlatSided = false;
  const ConvexPolytope& solid;
  Vec3 origin;
  int size() const { return static_cast<int>(solid.faces().size()); }
  Vec3 normal(int f) const { return solid.faces()[f].normal; }
  double offset(int f) const { return solid.faces()[f].offset - normal(f).dot(origin); }
};

// The polytope B.
struct PosedPolytope {
  static constexpr bool kIsFlatSided = false;
  const ConvexPolytope& solid;
  const Mat3& rotation;
  Vec3 translation;
  int size() const { return static_cast<int>(solid.faces().size()); }
  Vec3 normal(int f) const { return rotation * solid.faces()[f].normal; }
  double offset(int f) const { return solid.faces()[f].offset + normal(f).dot(translation); }
};

const PolytopeGraph& box_graph() {
  static const PolytopeGraph graph = [] {
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i) {
      corners.emplace_back(i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0);
    }
    std::vector<std::vector<int>> loops;
    for (int axis = 0; axis < 3; ++axis) {
      const int up = 1 << axis, j = 1 << (axis + 1) % 3, k = 1 << (axis + 2) % 3;
      loops.push_back({0, k, j | k, j});
      loops.push_back({up, up | j, up | j | k, up | k});
    }
    return make_polytope_graph(corners, loops);
  }();
  return graph;
}

void start(const PosedBox& b, CutPolytope& polytope) {
  const PolytopeGraph& graph = box_graph();
  polytope.start(graph);
  const Mat3 edges = b.rotation * b.half.asDiagonal();
  for (int v = 0; v < 8; ++v) {
    const Vec3& sign = graph.points[v];
    polytope.points()[v] = b.center + (sign.x() * edges.col(0) + sign.y() * edges.col(1) +
                                       sign.z() * edges.col(2));
  }
}

void start(const PosedPolytope& b, CutPolytope& polytope) {
  const PolytopeGraph& graph = b.solid.graph();
  polytope.start(graph);
  for (int v = 0; v < polytope.size(); ++v) {
    polytope.points()[v] = b.rotation * graph.points[v] + b.translation;
  }
}

// --- Cutting: false when nothing is left. A's faces are numbered after B's.

bool cut(const Ground&, int first_face, double rounding, CutPolytope& polytope) {
  return polytope.cut([](const Vec3& p) { return p.z(); }, first_face, rounding);
}

bool cut(const AlignedBox& a, int face, int first_face, double rounding, CutPolytope& polytope) {
  const int axis = face >> 1;
  const double offset = a.offset(face);
  const auto above = [=](const Vec3& p) { return p[axis] - offset; };
  const auto below = [=](const Vec3& p) { return -p[axis] - offset; };
  return face & 1 ? polytope.cut(above, first_face + face, rounding)
                  : polytope.cut(below, first_face + face, rounding);
}

Aabb bounds_of(std::span<const Vec3> points) {
  Aabb box{points[0], points[0]};
  for (const Vec3& p : points) {
    box.min = box.min.cwiseMin(p);
    box.max = box.max.cwiseMax(p);
  }
  return box;
}

// The plane that leaves least of B first: the later cuts then find little to do.
bool cut(const AlignedBox& a, int first_face, double rounding, CutPolytope& polytope) {
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
  const Vec3 normal = a.normal(face);
  const double offset = a.offset(face);
  return polytope.cut([&](const Vec3& p) { return normal.dot(p) - offset; }, first_face + face,
                      rounding);
}

bool cut(const AlignedPolytope& a, int first_face, double rounding, CutPolytope& polytope) {
  const Vec3 middle = bounds_of(polytope.points()).center();
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
    const Vec3 normal = a.normal(f);
    const double reach = normal.dot(center) + normal.cwiseAbs().dot(half);
    if (f == deepest || !(reach > a.offset(f))) continue;
    if (!cut(a, f, first_face, rounding, polytope)) return false;
  }
  return true;
}

// --- Sums over the faces of the region.

// Sums about a point of the region, and what each face contributes to them.
struct RegionSum {
  Vec3 origin;  // about which all is taken
  double volume = 0.0;
  Vec3 first = Vec3::Zero();
  double xx = 0.0, xy = 0.0, xz = 0.0, yy = 0.0, yz = 0.0, zz = 0.0;
  Vec3 area_vector = Vec3::Zero();
  Vec3 area_moment = Vec3::Zero();
  double area = 0.0;
  double counter_area = 0.0;
  // The faces with more than rounding noise, of A and of B: how many, and one of them.
  int faces_a = 0, faces_b = 0;
  int face_a = -1, face_b = -1;
};

// Area of a face, and the integrals over it: of x, and of x (x . normal), x x^T (x . normal), the
// fluxes whose sums over the closed surface are 4 int x dV and 5 int x x^T dV.
double add_face(std::span<const int> loop, std::span<const Vec3> points, const Vec3& normal,
                double flat, RegionSum& sum, Vec3& first) {
  const Vec3 a = points[loop[0]] - sum.origin;
  const double distance = normal.dot(a);
  Vec3 b = points[loop[1]] - sum.origin;
  double area = 0.0, xx = 0.0, xy = 0.0, xz = 0.0, yy = 0.0, yz = 0.0, zz = 0.0;
  first.setZero();
  const bool in_plane = std::abs(distance) <= flat;  // the origin: no flux, only the area counts
  for (std::size_t i = 2; i < loop.size(); ++i) {
    const Vec3 c = points[loop[i]] - sum.origin;
    const double twice_area = normal.dot((b - a).cross(c - a));
    const Vec3 s = a + b + c;
    area += twice_area;
    first += twice_area * s;
    if (!in_plane) {
      xx += twice_area * (s.x() * s.x() + a.x() * a.x() + b.x() * b.x() + c.x() * c.x());
      xy += twice_area * (s.x() * s.y() + a.x() * a.y() + b.x() * b.y() + c.x() * c.y());
      xz += twice_area * (s.x() * s.z() + a.x() * a.z() + b.x() * b.z() + c.x() * c.z());
      yy += twice_area * (s.y() * s.y() + a.y() * a.y() + b.y() * b.y() + c.y() * c.y());
      yz += twice_area * (s.y() * s.z() + a.y() * a.z() + b.y() * b.z() + c.y() * c.z());
      zz += twice_area * (s.z() * s.z() + a.z() * a.z() + b.z() * b.z() + c.z() * c.z());
    }
    b = c;
  }
  area *= 0.5;
  first *= 1.0 / 6.0;
  if (!in_plane) {
    sum.volume += distance * area / 3.0;
    sum.first += 0.25 * distance * first;
    const double factor = distance / 120.0;
    sum.xx += factor * xx;
    sum.xy += factor * xy;
    sum.xz += factor * xz;
    sum.yy += factor * yy;
    sum.yz += factor * yz;
    sum.zz += factor * zz;
  }
  return area;
}

std::span<const int> loop_of(const FaceLoop& face, const CutPolytope& polytope) {
  return {polytope.loop_vertices().data() + face.first, static_cast<std::size_t>(face.count)};
}

template <typename SolidA, typename SolidB>
Vec3 normal_of(int face, const SolidA& a, const SolidB& b) {
  return face < b.size() ? b.normal(face) : a.normal(face - b.size());
}

template <typename SolidA, typename SolidB>
RegionSum sum_faces(std::span<FaceLoop> faces, const SolidA& a, const SolidB& b,
                    const CutPolytope& polytope, double flat) {
  RegionSum sum;
  // A vertex of the last cut: on A's plane, so that depths under that plane do not cancel.
  sum.origin = polytope.points()[0];
  for (const FaceLoop& face : faces) {
    if (face.face >= b.size()) sum.origin = polytope.points()[loop_of(face, polytope)[0]];
  }
  for (FaceLoop& face : faces) {
    const Vec3 normal = normal_of(face.face, a, b);
    Vec3 first;
    face.area = add_face(loop_of(face, polytope), polytope.points(), normal, flat, sum, first);
    if (face.face >= b.size()) {
      sum.area += face.area;
      sum.area_vector += face.area * normal;
      sum.area_moment += first.cross(normal);
    } else {
      sum.counter_area += face.area;
    }
  }
  const double no_face = kNoFace * (sum.area + sum.counter_area);
  for (const FaceLoop& face : faces) {
    if (!(face.area > no_face)) continue;
    const bool is_a = face.face >= b.size();
    int& count = is_a ? sum.faces_a : sum.faces_b;
    int& last = is_a ? sum.face_a : sum.face_b;
    if (last != face.face) ++count;
    last = face.face;
  }
  return sum;
}

// --- Depth along the normal.

double extent_along(const Vec3& direction, std::span<const Vec3> points) {
  double low = kInfinity, high = -kInfinity;
  for (const Vec3& p : points) {
    const double height = direction.dot(p);
    low = std::min(low, height);
    high = std::max(high, height);
  }
  return high - low;
}

// int (distance below the plane of a face) dV.
double depth_under(const Vec3& normal, const Vec3& point, const RegionSum& sum) {
  return normal.dot(point - sum.origin) * sum.volume - normal.dot(sum.first);
}

// Whether a solid other than the one with that face looks along the face's normal somewhere: then
// columns end before they reach the face.
template <typename SolidA, typename SolidB>
bool has_overhang(const Vec3& normal, bool face_is_a, std::span<const FaceLoop> faces,
                  const SolidA& a, const SolidB& b) {
  return std::any_of(faces.begin(), faces.end(), [&](const FaceLoop& face) {
    const bool is_a = face.face >= b.size();
    return is_a != face_is_a && normal_of(face.face, a, b).dot(normal) > kNoFace;
  });
}

const Vec3& point_on(int face, std::span<const FaceLoop> faces, const CutPolytope& polytope) {
  const auto found = std::find_if(faces.begin(), faces.end(),
                                  [=](const FaceLoop& loop) { return loop.face == face; });
  return polytope.points()[loop_of(*found, polytope)[0]];
}

// Height over the (u, v) plane of the plane normal . x = offset; all in the columns' frame.
HeightPlane height_of(const Vec3& normal, double offset) {
  return {offset / normal.z(), -normal.x() / normal.z(), -normal.y() / normal.z()};
}

// A face this steep along the columns has no shadow.
bool is_steep(const Vec3& normal) { return std::abs(normal.z()) < kNoFace; }

template <typename Solid>
void add_planes(const Solid& solid, bool upper, const Mat3& R_AC, const Vec3& origin,
                std::vector<HeightPlane>& planes) {
  for (int f = 0; f < solid.size(); ++f) {
    const Vec3 normal_A = solid.normal(f), normal = R_AC.transpose() * normal_A;
    if (is_steep(normal) || (normal.z() > 0.0) != upper) continue;
    planes.push_back(height_of(normal, solid.offset(f) - normal_A.dot(origin)));
  }
}

// The general case: upper faces over lower faces. A lies on the side of the normal, above.
template <typename SolidA, typename SolidB>
double overlay_energy(const Vec3& normal, std::span<const FaceLoop> faces, const SolidA& a,
                      const SolidB& b, const CutPolytope& polytope, const RegionSum& sum,
                      ColumnScene& scene) {
  const Mat3 R_AC = basis_with_z(normal);
  scene.clear();
  std::vector<Eigen::Vector2d>& outline = scene.work[0];
  bool overhang = false;
  for (const FaceLoop& face : faces) {
    const Vec3 normal_C = R_AC.transpose() * normal_of(face.face, a, b);
    if (is_steep(normal_C)) continue;
    const bool upper = normal_C.z() > 0.0, is_a = face.face >= b.size();
    outline.clear();
    Vec3 point_C = Vec3::Zero();
    for (int v : loop_of(face, polytope)) {
      point_C = R_AC.transpose() * (polytope.points()[v] - sum.origin);
      outline.push_back(point_C.head<2>());
    }
    if (!upper) std::reverse(outline.begin(), outline.end());
    overhang |= upper == is_a;
    scene.add_face(upper, height_of(normal_C, normal_C.dot(point_C)), upper == is_a, outline);
  }
  if (overhang) {
    add_planes(b, true, R_AC, sum.origin, scene.ceiling);
    add_planes(a, false, R_AC, sum.origin, scene.floor);
  }
  return column_energy(scene);
}

template <typename SolidA, typename SolidB>
double depth_moment_of(const Vec3& normal, std::span<const FaceLoop> faces, const SolidA& a,
                       const SolidB& b, const RegionSum& sum, ClipScratch& scratch) {
  const CutPolytope& polytope = scratch.polytope;
  // With one face of a solid in the region, columns reach to its plane. Sides of a polytope that
  // lean inwards could end them earlier, but only where the other solid overhangs.
  if (sum.faces_a == 1) {
    const Vec3 n = normal_of(sum.face_a, a, b);
    if (SolidA::kIsFlatSided || !has_overhang(n, true, faces, a, b)) {
      return depth_under(n, point_on(sum.face_a, faces, polytope), sum);
    }
  }
  if (sum.faces_b == 1) {
    const Vec3 n = normal_of(sum.face_b, a, b);
    if (SolidB::kIsFlatSided || !has_overhang(n, false, faces, a, b)) {
      return depth_under(n, point_on(sum.face_b, faces, polytope), sum);
    }
  }
  return overlay_energy(normal, faces, a, b, polytope, sum, scratch.columns);
}

VolumeMetrics metrics_of(const RegionSum& sum) {
  VolumeMetrics m;
  m.volume = sum.volume;
  const Vec3 c = sum.first / sum.volume;
  m.centroid = c;
  const double xx = sum.xx - sum.first.x() * c.x(), yy = sum.yy - sum.first.y() * c.y(),
               zz = sum.zz - sum.first.z() * c.z(), xy = sum.xy - sum.first.x() * c.y(),
               xz = sum.xz - sum.first.x() * c.z(), yz = sum.yz - sum.first.y() * c.z();
  m.inertia << yy + zz, -xy, -xz, -xy, xx + zz, -yz, -xz, -yz, xx + yy;
  m.area = sum.area;
  m.counter_area = sum.counter_area;
  return m;
}

// Metrics of what the cuts have left, moved from the local origin to A's.
template <typename SolidA, typename SolidB>
VolumeMetrics measure(const SolidA& a, const SolidB& b, const Vec3& local_origin, double rounding,
                      ClipScratch& scratch) {
  const std::span<FaceLoop> faces = scratch.polytope.faces();
  const RegionSum sum = sum_faces(faces, a, b, scratch.polytope, rounding);
  const double volume_error =
      8.0 * kEpsilon * sum.volume + 2.0 * rounding * (sum.area + sum.counter_area);
  if (!(sum.volume > volume_error)) return VolumeMetrics{};

  VolumeMetrics m = metrics_of(sum);
  const Vec3 shift = local_origin + sum.origin;
  m.centroid += shift;
  m.volume_error = volume_error;
  if (sum.faces_a == 0 || sum.faces_b == 0) {
    m.status = Status::kContained;
    return m;
  }
  const double length = sum.area_vector.norm();
  m.area_moment = sum.area_moment + shift.cross(sum.area_vector);
  if (!(length > kNoDirection * (sum.area + sum.counter_area))) return m;
  m.area_vector = sum.area_vector;
  const Vec3 normal = -sum.area_vector / length;
  m.depth = extent_along(normal, scratch.polytope.points());
  m.depth_moment = depth_moment_of(normal, faces, a, b, sum, scratch);
  return m;
}

// --- Cheap answers.

// The whole of a solid, inside the other.
VolumeMetrics contained(const VolumeMetrics& own, const Pose& pose, double surface, bool is_a,
                        double rounding) {
  VolumeMetrics m = transformed(own, pose);
  (is_a ? m.area : m.counter_area) = surface;
  m.volume_error = 8.0 * kEpsilon * m.volume + rounding * surface;
  m.status = Status::kContained;
  return m;
}

double surface_of(const Box& box) {
  const Vec3& h = box.half_sizes();
  return 8.0 * (h.x() * h.y() + h.y() * h.z() + h.z() * h.x());
}

// Rounding error of a position in the local frame, where coordinates reach this far.
double rounding_at(double reach) { return 4.0 * kEpsilon * reach; }

// Local origin for a pair: the point of A's bounds nearest to B's frame.
Vec3 nearest_in(const Aabb& bounds, const Vec3& p) {
  return p.cwiseMax(bounds.min).cwiseMin(bounds.max);
}

}  // namespace

VolumeMetrics clip(const HalfSpace&, const Box& b, const Pose& X_AB,
                   ClipScratch& scratch) noexcept {
  const double height = X_AB.translation.z();
  const double reach = X_AB.rotation.row(2).cwiseAbs().dot(b.half_sizes());
  if (!(height < reach) || b.half_sizes().minCoeff() <= 0.0) return VolumeMetrics{};
  const double rounding = rounding_at(std::abs(height) + b.half_sizes().sum());
  if (height <= -reach) {
    VolumeMetrics m = contained(b.own_metrics(), X_AB, surface_of(b), false, rounding);
    m.depth = 2.0 * reach;
    m.depth_moment = -height * m.volume;
    return m;
  }
  const Vec3 origin(X_AB.translation.x(), X_AB.translation.y(), 0.0);
  const PosedBox box{b.half_sizes(), X_AB.rotation, Vec3(0.0, 0.0, height)};
  start(box, scratch.polytope);
  if (!cut(Ground{}, box.size(), rounding, scratch.polytope)) return VolumeMetrics{};
  return measure(Ground{}, box, origin, rounding, scratch);
}

VolumeMetrics clip(const HalfSpace&, const ConvexPolytope& b, const Pose& X_AB,
                   ClipScratch& scratch) noexcept {
  const Vec3 down_B = -X_AB.rotation.row(2).transpose();
  const double height = X_AB.translation.z();
  if (!(height < b.support_height(down_B))) return VolumeMetrics{};
  const Aabb bounds = b.bounds();
  const double size = bounds.min.cwiseAbs().cwiseMax(bounds.max.cwiseAbs()).sum();
  const double rounding = rounding_at(std::abs(height) + size);
  const double reach = b.support_height(-down_B);
  if (height <= -reach) {
    VolumeMetrics m = contained(b.own_metrics(), X_AB, b.surface_area(), false, rounding);
    m.depth = reach + b.support_height(down_B);
    m.depth_moment = -m.centroid.z() * m.volume;
    return m;
  }
  const Vec3 origin(X_AB.translation.x(), X_AB.translation.y(), 0.0);
  const PosedPolytope polytope{b, X_AB.rotation, Vec3(0.0, 0.0, height)};
  start(polytope, scratch.polytope);
  if (!cut(Ground{}, polytope.size(), rounding, scratch.polytope)) return VolumeMetrics{};
  return measure(Ground{}, polytope, origin, rounding, scratch);
}

VolumeMetrics clip(const Box& a, const Box& b, const Pose& X_AB, ClipScratch& scratch) noexcept {
  const Vec3 &half_a = a.half_sizes(), &half_b = b.half_sizes(), &p_AB = X_AB.translation;
  const Mat3& R_AB = X_AB.rotation;
  if (boxes_apart(half_a, half_b, R_AB, p_AB)) return VolumeMetrics{};
  if (half_a.minCoeff() <= 0.0 || half_b.minCoeff() <= 0.0) return VolumeMetrics{};
  const Vec3 origin = nearest_in(a.bounds(), p_AB);
  const PosedBox box{half_b, R_AB, p_AB - origin};
  const double rounding = rounding_at(box.center.lpNorm<1>() + half_b.sum());
  if (((p_AB.cwiseAbs() + R_AB.cwiseAbs() * half_b).array() <= half_a.array()).all()) {
    return contained(b.own_metrics(), X_AB, surface_of(b), false, rounding);
  }
  const Mat3 R_BA = R_AB.transpose();
  if ((((R_BA * p_AB).cwiseAbs() + R_BA.cwiseAbs() * half_a).array() <= half_b.array()).all()) {
    return contained(a.own_metrics(), Pose{}, surface_of(a), true, rounding);
  }
  const AlignedBox planes{half_a, origin};
  start(box, scratch.polytope);
  if (!cut(planes, box.size(), rounding, scratch.polytope)) return VolumeMetrics{};
  return measure(planes, box, origin, rounding, scratch);
}

VolumeMetrics clip(const Box& a, const ConvexPolytope& b, const Pose& X_AB,
                   ClipScratch& scratch) noexcept {
  const Aabb bounds = b.bounds();
  const Vec3 p_AM = X_AB * bounds.center(), half_b = bounds.half_sizes();
  if (boxes_apart(a.half_sizes(), half_b, X_AB.rotation, p_AM)) return VolumeMetrics{};
  if (a.half_sizes().minCoeff() <= 0.0) return VolumeMetrics{};
  const AlignedBox planes{a.half_sizes(), nearest_in(a.bounds(), p_AM)};
  const PosedPolytope polytope{b, X_AB.rotation, X_AB.translation - planes.origin};
  const double rounding = rounding_at((p_AM - planes.origin).lpNorm<1>() +
                                      bounds.center().lpNorm<1>() + half_b.sum());
  start(polytope, scratch.polytope);
  if (!cut(planes, polytope.size(), rounding, scratch.polytope)) return VolumeMetrics{};
  return measure(planes, polytope, planes.origin, rounding, scratch);
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
  start(polytope, scratch.polytope);
  if (!cut(planes, polytope.size(), rounding, scratch.polytope)) return VolumeMetrics{};
  return measure(planes, polytope, planes.origin, rounding, scratch);
}

}  // namespace volcontact
