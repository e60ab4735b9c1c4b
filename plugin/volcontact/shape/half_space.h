// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "volcontact/base/fields.h"
#include "volcontact/shape/pieces.h"
#include "volcontact/shape/solid.h"

namespace volcontact {

/// Everything at or below the plane z = 0 of its frame, as MuJoCo's plane.
class HalfSpace {
 public:
  static constexpr bool kPlanesOnly = true;
  static constexpr const char* kName = "half_space";
  struct Params {};
  static constexpr std::array<Field<Params>, 0> kFields{};

  HalfSpace() = default;
  explicit HalfSpace(const Params&) {}

  Aabb bounds() const { return {Vec3::Constant(-kInfinity), Vec3(kInfinity, kInfinity, 0.0)}; }
  Vec3 support(const Vec3& e) const {
    if (is_up(e)) return Vec3::Zero();
    return Vec3::Constant(kInfinity);
  }
  double support_height(const Vec3& e) const { return is_up(e) ? 0.0 : kInfinity; }
  double signed_distance(const Vec3& p) const { return p.z(); }
  Vec3 gradient(const Vec3&) const;
  RayInterval ray(const Vec3& o, const Vec3& d) const;
  double volume() const { return kInfinity; }
  VolumeMetrics own_metrics() const;
  void pieces(PieceList& list) const;

  template <typename Writer>
  void write_faces(Writer& writer) const {
    writer.plane(Vec3::UnitZ(), 0.0);
  }

 private:
  static bool is_up(const Vec3& e) { return e.x() == 0.0 && e.y() == 0.0 && e.z() > 0.0; }
};

static_assert(ConvexSolid<HalfSpace>);

}  // namespace volcontact
