// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

#include "volcontact/base/types.h"
#include "volcontact/shape/sphere.h"

namespace volcontact {

/// A face plane of solid B as solid A sees it.
struct FaceMet {
  Vec3 normal;    ///< out of B, in A
  double height;  ///< of A's origin over the plane [m]

  /// Of B's plane normal . x = offset.
  static FaceMet of(const Vec3& normal, double offset, const Pose& X_BA) {
    return {X_BA.rotation.transposed_times(normal), normal.dot(X_BA.translation) - offset};
  }
  bool operator==(const FaceMet&) const = default;
};

/// The faces of a solid B of planes that solid A is cut by, and the one that alone cuts what of A
/// is within it. Such an overlap is that of A with the half-space of the face, exactly.
template <typename A>
class FacesMet {
 public:
  FacesMet(const A& a, const Pose& X_BA) : a_(a), X_BA_(X_BA) {}

  /// For B to write: normal . x <= offset.
  void plane(const Vec3& normal, double offset) {
    const FaceMet met = FaceMet::of(normal, offset, X_BA_);
    if (!(met.height + a_.support_height(met.normal) > 0.0)) return;  // A is behind it
    is_apart_ = is_apart_ || !(met.height < a_.support_height(-met.normal));
    if (count_ < kMost) met_[count_] = met;
    ++count_;
  }

  /// A is ahead of a face.
  bool is_apart() const { return is_apart_; }
  /// More faces than are kept.
  bool too_many() const { return count_ > kMost; }
  std::size_t size() const { return count_; }
  const FaceMet& operator[](std::size_t i) const { return met_[i]; }

  /// Whether there is one that alone cuts A; then `X_AH` is the pose of its half-space.
  bool find(Pose& X_AH) const {
    if (too_many()) return false;
    for (std::size_t i = 0; i < count_; ++i) {
      if (!cuts_alone(i)) continue;
      X_AH = {basis_with_z(met_[i].normal), -met_[i].height * met_[i].normal};
      return true;
    }
    return false;
  }

 private:
  static constexpr std::size_t kMost = 4;

  bool cuts_alone(std::size_t i) const {
    for (std::size_t k = 0; k < count_; ++k) {
      if (k != i && met_[k].height + reach_behind(met_[i], met_[k].normal) > 0.0) return false;
    }
    return true;
  }

  // How far along e what of A is behind the face reaches, or more.
  double reach_behind(const FaceMet& face, const Vec3& e) const {
    if constexpr (requires { a_.half_length() + a_.radius(); }) {
      // Only a part of the axis is so near the face that what is around it is behind.
      const double length = a_.half_length(), rise = face.normal.z();
      const double around = a_.support_height(-face.normal) - length * std::abs(rise);
      double from = -length, to = length;
      if (rise > 0.0) to = std::min(to, (around - face.height) / rise);
      if (rise < 0.0) from = std::max(from, (around - face.height) / rise);
      const double lowest = face.height + std::min(from * rise, to * rise);
      return std::max(from * e.z(), to * e.z()) +
             std::min(a_.support_height(e) - length * std::abs(e.z()),
                      reach_of_cap(a_.radius(), lowest, face.normal.dot(e)));
    } else if constexpr (std::is_same_v<A, Sphere>) {
      return reach_of_cap(a_.radius(), face.height, face.normal.dot(e));
    } else {
      return a_.support_height(e);
    }
  }

  // How far what of a ball is behind a face reaches: its middle is at a height over the face, whose
  // normal and the direction have this cosine.
  static double reach_of_cap(double radius, double height, double cosine) {
    if (height <= -radius * cosine) return radius;
    const double rim = std::sqrt(std::max(0.0, (radius - height) * (radius + height)));
    return rim * std::sqrt(std::max(0.0, 1.0 - cosine * cosine)) - height * cosine;
  }

  const A& a_;
  const Pose& X_BA_;
  std::array<FaceMet, kMost> met_;
  std::size_t count_ = 0;
  bool is_apart_ = false;
};

}  // namespace volcontact
