// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volcontact/pair/convex/face_set.h"
#include "volcontact/shape/simple_shapes.h"

namespace volcontact {

/// A convex solid whose faces the lines engine knows, through one table of functions, so that the
/// engine is compiled once. It refers to the solid and must not outlive it.
class ConvexView {
 public:
  template <HasFaces S>
  explicit ConvexView(const S& solid)
      : solid_(&solid),
        table_(&kTable<S>),
        bounded_(!std::same_as<S, HalfSpace>),
        round_(HasRoundFaces<S>) {}

  bool bounded() const { return bounded_; }
  bool has_round_faces() const { return round_; }

  /// The farthest point along e, and how far it reaches, of the solid posed in an outer frame.
  Vec3 support(const Pose& X, const Vec3& e) const {
    return X * table_->support(solid_, X.rotation.transpose() * e);
  }
  double support_height(const Pose& X, const Vec3& e) const {
    return e.dot(X.translation) + table_->support_height(solid_, X.rotation.transpose() * e);
  }
  /// The part of the line o + t d inside of the posed solid.
  RayInterval ray(const Pose& X, const Vec3& o, const Vec3& d) const {
    return table_->ray(solid_, X.rotation.transpose() * (o - X.translation),
                       X.rotation.transpose() * d);
  }
  VolumeMetrics own_metrics() const { return table_->own_metrics(solid_); }
  /// A point in the middle of a bounded solid.
  Vec3 middle(const Pose& X) const { return X * table_->middle(solid_); }
  void write_faces(FaceWriter& writer) const { table_->write_faces(solid_, writer); }

 private:
  struct Table {
    Vec3 (*support)(const void*, const Vec3&);
    double (*support_height)(const void*, const Vec3&);
    RayInterval (*ray)(const void*, const Vec3&, const Vec3&);
    VolumeMetrics (*own_metrics)(const void*);
    Vec3 (*middle)(const void*);
    void (*write_faces)(const void*, FaceWriter&);
  };
  template <typename S>
  static constexpr Table kTable = {
      [](const void* s, const Vec3& e) -> Vec3 { return static_cast<const S*>(s)->support(e); },
      [](const void* s, const Vec3& e) { return static_cast<const S*>(s)->support_height(e); },
      [](const void* s, const Vec3& o, const Vec3& d) {
        return static_cast<const S*>(s)->ray(o, d);
      },
      [](const void* s) { return static_cast<const S*>(s)->own_metrics(); },
      [](const void* s) -> Vec3 {
        if constexpr (std::same_as<S, ConvexPolytope>) {
          return static_cast<const S*>(s)->own_metrics().centroid;
        }
        return Vec3::Zero();
      },
      [](const void* s, FaceWriter& writer) { writer.write(*static_cast<const S*>(s)); },
  };

  const void* solid_;
  const Table* table_;
  bool bounded_, round_;
};

}  // namespace volcontact
