// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "volcontact/base/check.h"
#include "volcontact/base/fields.h"
#include "volcontact/shape/pieces.h"
#include "volcontact/shape/solid.h"

namespace volcontact {

/// Box about the origin whose edges and corners are rounded: all points within `radius` of the box
/// that is smaller by it. Throws std::invalid_argument on values out of range and on a radius above
/// the smallest half size.
class RoundedBox {
 public:
  static constexpr const char* kName = "rounded_box";
  struct Params {
    Vec3 half_sizes = Vec3::Ones();
    double radius = 0.1;
  };
  static constexpr std::array kFields{
      Field<Params>{"half_sizes", "m", &Params::half_sizes, kPositive,
                    "half the lengths from face to face"},
      Field<Params>{"radius", "m", &Params::radius, kPositive,
                    "of the edges and corners, no more than the smallest half size"}};

  explicit RoundedBox(const Params& params);
  const Params& params() const { return p_; }
  const Vec3& half_sizes() const { return p_.half_sizes; }
  double radius() const { return p_.radius; }

  Aabb bounds() const { return {-p_.half_sizes, p_.half_sizes}; }
  Vec3 support(const Vec3& e) const {
    Vec3 corner;
    for (int i = 0; i < 3; ++i) corner[i] = std::copysign(inner_[i], e[i]);
    return corner + p_.radius * e.normalized();
  }
  double support_height(const Vec3& e) const {
    return inner_.dot(e.cwiseAbs()) + p_.radius * e.norm();
  }
  double signed_distance(const Vec3& p) const {
    const Vec3 excess = p.cwiseAbs() - inner_;
    const Vec3 outside = excess.cwiseMax(0.0);
    return outside.norm() + std::min(excess.maxCoeff(), 0.0) - p_.radius;
  }
  Vec3 gradient(const Vec3& p) const;
  RayInterval ray(const Vec3& o, const Vec3& d) const;
  double volume() const {
    const double r = p_.radius, r2 = r * r, disc = kPi * r2, ball = 4.0 / 3.0 * kPi * r * r2;
    const double a[3] = {inner_.x(), inner_.y(), inner_.z()};
    return 8.0 * a[0] * a[1] * a[2] + 8.0 * r * (a[0] * a[1] + a[1] * a[2] + a[2] * a[0]) +
           2.0 * disc * (a[0] + a[1] + a[2]) + ball;
  }
  VolumeMetrics own_metrics() const;
  void pieces(PieceList& list) const;
  /// A box with two of the slabs around it, the other four, twelve edges and eight corners; those
  /// of no thickness left out.
  template <typename Writer>
  void write_parts(Writer& writer) const {
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          const bool is_slab_of_first = x != 0 && y == 0 && z == 0;
          if (!is_slab_of_first) write_part(Vec3(x, y, z), writer);
        }
      }
    }
  }

 private:
  // The part whose places lie outside of the inner box along the axes where `side` is 1 or -1.
  template <typename Writer>
  void write_part(const Vec3& side, Writer& writer) const {
    const auto outside = static_cast<int>(side.cwiseAbs().sum());
    for (int i = 0; i < 3; ++i) {
      const bool spans_all = outside == 0 && i == 0;
      if (side[i] == 0.0 && inner_[i] == 0.0 && !spans_all) return;
    }
    for (int i = 0; i < 3; ++i) {
      const Vec3 out = Vec3::Unit(i);
      if (side[i] == 0.0) {
        const bool is_surface = outside == 0 && i == 0;
        const double offset = is_surface ? p_.half_sizes[i] : inner_[i];
        writer.plane(out, offset, !is_surface);
        writer.plane(-out, offset, !is_surface);
        continue;
      }
      writer.plane(-side[i] * out, -inner_[i], true);
      if (outside == 1) writer.plane(side[i] * out, p_.half_sizes[i], false);
      if (outside == 2 && side[(i + 1) % 3] != 0.0) {
        writer.tube((i + 2) % 3, p_.radius, inner_.cwiseProduct(side));
      }
    }
    if (outside == 3) writer.ball(p_.radius, inner_.cwiseProduct(side));
    writer.end_part();
  }
  static RayInterval within(const Vec3& half, const Vec3& o, const Vec3& d);
  // Within `radius` of a centre, or of an axis through it, along which `mask` is 0, else 1. From
  // the nearest point: no cancellation for far origins.
  RayInterval round(const Vec3& mask, const Vec3& center, const Vec3& o, const Vec3& d) const;
  RayInterval edge(int axis, const Vec3& center, const Vec3& o, const Vec3& d) const;

  Params p_;
  Vec3 inner_;  // half sizes of the box that the centres of the corners span
};

static_assert(ConvexSolid<RoundedBox>);

}  // namespace volcontact
