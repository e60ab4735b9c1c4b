// SPDX-License-Identifier: Apache-2.0
#pragma once

// Metrics of the region that the cuts have left. Part of clip.cc.
#include <algorithm>
#include <span>
#include <vector>

#include "volcontact/base/fields.h"
#include "volcontact/pair/clip/clip.h"
#include "volcontact/pair/quadrature/region_sum.h"

namespace volcontact::clipping {

// A face with less than this share of the region's surface is rounding noise.
inline constexpr double kNoFace = 1e-13;
// |S| below this share of the surface is rounding noise: no direction.
inline constexpr double kNoDirection = 1e-14;

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
        columns_(scratch.columns),
        in_columns_(scratch.in_columns),
        normals_(scratch.normals),
        outline_(scratch.outline),
        neighbors_(scratch.neighbors),
        faces_(scratch.polytope.faces()) {}

  // In A's axes, about A's origin given that of the local origin.
  VolumeMetrics measure(const Vec3& local_origin) {
    sum_faces();
    const double surface = sum_.area + sum_.counter_area;
    if (!(sum_.volume > sum_.volume_error(rounding_))) return sum_.none(rounding_);
    VolumeMetrics m = sum_.metrics(rounding_);
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
    return std::max(0.0, n.dot(vertex(face, 0) - sum_.origin) * sum_.volume - n.dot(sum_.first));
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
    columns_.start(a_.size() + b_.size());
    in_columns_.clear();
    for (const Vec3& p : polytope_.points()) in_columns_.push_back(R_CA * (p - sum_.origin));
    normals_.clear();
    for (const FaceLoop& face : faces_) normals_.push_back(R_CA * normal(face));
    const FaceLoop* top = largest_top();
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      if (&faces_[i] != top) add_to_columns(faces_[i], normals_[i]);
    }
    if (top) {
      const Vec3& n = normals_[static_cast<std::size_t>(top - faces_.data())];
      const HeightPlane height = height_of(n, n.dot(in_columns_[first_vertex(*top)]));
      return std::max(0.0, depth_under(*top) / n.z() - columns_.value_above(height));
    }
    if (columns_.has_overhang()) {
      for_planes(b_, R_CA, true, [&](const HeightPlane& plane) { columns_.add_ceiling(plane); });
      for_planes(a_, R_CA, false, [&](const HeightPlane& plane) { columns_.add_floor(plane); });
    }
    return columns_.value();
  }

  int first_vertex(const FaceLoop& face) const { return polytope_.loop_vertices()[face.first]; }

  // The face at which most columns end, all but few as a rule; none where there is an overhang.
  const FaceLoop* largest_top() const {
    const FaceLoop* top = nullptr;
    double largest = 0.0;  // shadow
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      const FaceLoop& face = faces_[i];
      const Vec3& n = normals_[i];
      if (is_steep(n)) continue;
      const bool upper = n.z() > 0.0;
      if (upper == is_a(face)) return nullptr;
      if (upper && face.area * n.z() > largest) {
        largest = face.area * n.z();
        top = &face;
      }
    }
    return top;
  }

  void add_to_columns(const FaceLoop& face, const Vec3& n) {
    if (is_steep(n)) return;
    const bool upper = n.z() > 0.0;
    const int* const loop = polytope_.loop_vertices().data() + face.first;
    const Vec3* const points = in_columns_.data();
    outline_.clear();
    for (int i = 0; i < face.count; ++i) outline_.push_back(points[loop[i]].template head<2>());
    const Vec3& p = points[loop[face.count - 1]];
    const HeightPlane height = height_of(n, n.dot(p));
    if (upper) {
      columns_.add_upper(height, is_a(face), outline_);
    } else {
      neighbors_.clear();
      for (int i = face.first; i < face.first + face.count; ++i) {
        neighbors_.push_back(polytope_.face_across(i));
      }
      columns_.add_lower(face.face, height, !is_a(face), outline_, neighbors_);
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
  ColumnEnergy& columns_;
  std::vector<Vec3>& in_columns_;
  std::vector<Vec3>& normals_;  // of the faces, in the columns' frame
  std::vector<Vec2>& outline_;
  std::vector<int>& neighbors_;
  std::span<FaceLoop> faces_;
  RegionSum sum_;
};

}  // namespace volcontact::clipping
