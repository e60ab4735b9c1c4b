// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <memory>
#include <utility>
#include <vector>

#include "volcontact/base/check.h"
#include "volcontact/base/fields.h"
#include "volcontact/shape/solid.h"

namespace volcontact {

/// What a user writes to bring a solid of his own: `Aabb bounds() const`, a box that holds it [m],
/// and `double signed_distance(const Vec3& p) const` [m], negative inside, both in the solid's
/// frame. signed_distance must not throw, and may be called by several threads at once.
template <typename S>
concept UserSolid = std::copy_constructible<S> && requires(const S& solid, const Vec3& p) {
  { solid.bounds() } -> std::same_as<Aabb>;
  { solid.signed_distance(p) } -> std::same_as<double>;
};

class SignedDistance;

/// A SignedDistance is none: asked whether it can be copied, it would ask this of itself.
template <typename S>
concept OtherUserSolid = !std::same_as<S, SignedDistance> && UserSolid<S>;

/// A user's solid among the shapes:
///
///     struct Gyroid {
///       Aabb bounds() const { return {Vec3::Constant(-0.1), Vec3::Constant(0.1)}; }
///       double signed_distance(const Vec3& p) const;
///     };
///     const Shape shape = SignedDistance(Gyroid{}, {.lipschitz = 1.3, .curvature = 90.0});
///
/// It meets every other shape through the octree. The function need not be a distance, only
/// negative inside and no steeper than `lipschitz`: the bounds of the volume are certain when that
/// is. With `curvature` they are of second order and meet a per cent; without, of first
/// order, and the status is `approximate` below a few per cent, though the volume itself is better
/// than that. docs/theory.md, "Solids with a signed distance".
class SignedDistance {
 public:
  static constexpr const char* kName = "signed_distance";
  struct Params {
    double lipschitz = 1.0;  ///< nowhere is the function steeper [-]
    /// Bound of its second derivatives in any direction [1/m], where
    /// |function| < lipschitz^2 / (2 curvature). A ball of radius r has 1.5/r.
    double curvature = kInfinity;
  };

  /// Where the numbers come from.
  class Source {
   public:
    virtual ~Source() = default;
    virtual Aabb bounds() const = 0;
    virtual void evaluate(const Vec3* points, int count, double* distances) const noexcept = 0;
    /// False where evaluate() has to wait for a lock that a time step must not wait for.
    virtual bool serves_steps() const { return true; }
  };

  template <OtherUserSolid S>
  explicit SignedDistance(S solid) : SignedDistance(std::move(solid), Params{}) {}
  template <OtherUserSolid S>
  SignedDistance(S solid, const Params& params)
      : SignedDistance(std::make_shared<const SourceOf<S>>(std::move(solid)), params) {}
  SignedDistance(std::shared_ptr<const Source> source, const Params& params);

  const Params& params() const { return p_; }
  const Source& source() const { return *source_; }

  Aabb bounds() const { return bounds_; }
  /// Of the bounds.
  double support_height(const Vec3& e) const;
  double signed_distance(const Vec3& p) const {
    double f;
    signed_distances(&p, 1, &f);
    return f;
  }
  /// Never more than the distances from the surface, at `count` points at once.
  void signed_distances(const Vec3* points, int count, double* distances) const {
    source_->evaluate(points, count, distances);
    if (p_.lipschitz == 1.0) return;
    for (int i = 0; i < count; ++i) distances[i] /= p_.lipschitz;
  }
  double bend_bound() const { return p_.curvature / p_.lipschitz; }
  /// By central differences.
  Vec3 gradient(const Vec3& p) const;
  /// Unknown: volume -1.
  VolumeMetrics own_metrics() const {
    VolumeMetrics unknown;
    unknown.volume = -1.0;
    return unknown;
  }

 private:
  template <typename S>
  class SourceOf final : public Source {
   public:
    explicit SourceOf(S solid) : solid_(std::move(solid)) {}
    Aabb bounds() const override { return solid_.bounds(); }
    void evaluate(const Vec3* points, int count, double* distances) const noexcept override {
      for (int i = 0; i < count; ++i) distances[i] = solid_.signed_distance(points[i]);
    }

   private:
    S solid_;
  };

  std::shared_ptr<const Source> source_;
  Params p_;
  Aabb bounds_;
};

static_assert(Solid<SignedDistance>);

}  // namespace volcontact
