// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adaptor/memory/mocap_row.h"
#include "adaptor/mujoco/mujoco_compat.h"
#include "volcontact/base/types.h"

// Mocap bodies are moved by hand, and MuJoCo takes them to stand still. Their velocity here is
// their motion over the last step, and so is that of what hangs on them, besides its own.

namespace volcontact::adaptor {

/// Faster than this, or further in a step than its own size, a mocap body was not moved but put
/// elsewhere [m/s].
inline constexpr double kFastestMocap = 10.0;

/// The mocap bodies of one evaluation.
class MocapMotion {
 public:
  MocapMotion() = default;
  /// `rows`: MocapRow::kNumbers for each mocap body.
  explicit MocapMotion(double* rows) : rows_(rows) {}

  MocapRow row(int mocap) const { return {rows_ + mocap * MocapRow::kNumbers}; }

  /// The motion of a point that hangs on the body, in the world, which no degree of freedom makes.
  Twist at(const mjModel* m, const mjData* d, int body, const Vec3& point) const;

  /// Reads where the mocap bodies are, `elapsed` seconds after `before`, and how they came there.
  /// Null: nobody knows. With `goes_on` they move as then: between the stages of one step.
  void read(const mjModel* m, const mjData* d, const MocapMotion* before, double elapsed,
            bool goes_on) const;

  /// The contacts' force and torque on a body at a point.
  void add_load(const mjModel* m, const mjData* d, int body, const Vec3& point, const Vec3& force,
                const Vec3& torque) const;

  /// Work that the bodies did on the contacts when they moved here, `elapsed` seconds, under the
  /// loads of `before` [J].
  double work_since(const mjModel* m, const MocapMotion& before, double elapsed) const;

 private:
  static int mocap_of(const mjModel* m, int body) { return m->body_mocapid[m->body_rootid[body]]; }

  double* rows_ = nullptr;
};

}  // namespace volcontact::adaptor
