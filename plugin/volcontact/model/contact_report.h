// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "volcontact/base/types.h"
#include "volcontact/force/normal_force.h"
#include "volcontact/force/patch.h"
#include "volcontact/metrics/volume_metrics.h"

namespace volcontact {

/// One number for each way in which a contact dissipates.
struct ByChannel {
  double normal = 0.0;
  double roll = 0.0;
  double slide = 0.0;
  double spin = 0.0;

  double sum() const { return normal + roll + slide + spin; }
  ByChannel& operator+=(const ByChannel& other) {
    normal += other.normal;
    roll += other.roll;
    slide += other.slide;
    spin += other.spin;
    return *this;
  }
};

/// One contact site: what was measured and what follows. World frame.
struct SiteReport {
  int pair = 0;                     ///< index of the geometric pair in its contact model
  VolumeMetrics metrics;            ///< about the world origin
  Vec3 normal = Vec3::Zero();       ///< on A, from B to A
  double normal_force = 0.0;        ///< f_n [N]
  Vec3 force_on_A = Vec3::Zero();   ///< normal force and friction, at the centroid [N]
  Vec3 torque_on_A = Vec3::Zero();  ///< rolling and spin torque, about the centroid [N m]
  double approach_speed = 0.0;      ///< > 0 while approaching [m/s]
  Vec3 slip = Vec3::Zero();         ///< tangential velocity of A against B at the centroid [m/s]
  double spin = 0.0;                ///< of A against B about the normal [rad/s]
  double elastic_energy = 0.0;      ///< of the volume and of the bristles [J]
  ByChannel bristle_energy;         ///< the part of it that sliding and spinning stored [J]
  ByChannel power;                  ///< dissipated [W]
  ByChannel taken;  ///< power taken from the motion: dissipated, or put in bristles [W]
};

/// What the laws of a site were given and what the normal law made of it: enough to ask them again
/// under another normal force, as an implicit step does.
struct SiteInputs {
  NormalInput normal_in;
  NormalOutput normal_out;
  Vec3 elastic_torque = Vec3::Zero();  ///< on A about the centroid, of the potential [N m]
  Vec3 travel = Vec3::Zero();          ///< as in CarriedSite [m]
  Vec3 rotation = Vec3::Zero();        ///< [rad]
  Patch patch;                         ///< for friction
};

/// What an evaluation of a contact model returns.
struct ContactReport {
  std::vector<SiteReport> sites;  ///< empty when apart
  std::vector<double> memory;     ///< a row a site, for the next evaluation; none where the laws
                                  ///< keep nothing
  Vec3 p_WA = Vec3::Zero();       ///< where A's origin was [m]
  Vec3 p_WB = Vec3::Zero();       ///< where B's origin was [m]
  double elastic_energy = 0.0;    ///< [J]
  ByChannel bristle_energy;       ///< [J]
  ByChannel power;                ///< dissipated [W]
  ByChannel taken;                ///< [W]

  /// Set by the caller who wants the two lists below.
  bool keeps_inputs = false;
  std::vector<SiteInputs> inputs;  ///< of each site
  std::vector<double> committed;   ///< of each site, the law states it was evaluated with
  double elapsed = 0.0;            ///< since these [s]

  bool touching() const { return !sites.empty(); }

  /// What the sites do together to A, about its origin, and to B, about its own; world frame. Of
  /// the forces that the sites have now: an implicit step changes them.
  Wrench wrench_on_A() const noexcept { return wrench_about(p_WA, 1.0); }
  Wrench wrench_on_B() const noexcept { return wrench_about(p_WB, -1.0); }

 private:
  Wrench wrench_about(const Vec3& origin, double sign) const noexcept {
    Wrench sum;
    for (const SiteReport& site : sites) {
      const Wrench one{sign * site.torque_on_A, sign * site.force_on_A};
      sum += one.about(origin - site.metrics.centroid);
    }
    return sum;
  }
};

}  // namespace volcontact
