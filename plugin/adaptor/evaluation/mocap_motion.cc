// SPDX-License-Identifier: Apache-2.0
#include "adaptor/evaluation/mocap_motion.h"

#include <algorithm>
#include <cmath>

#include "adaptor/mujoco/mjgeoms.h"

namespace volcontact::adaptor {
namespace {

// Radius about the body's origin that holds its geoms; zero of planes alone [m].
double radius_of(const mjModel* m, int body) {
  double radius = 0.0;
  for (int i = 0; i < m->body_geomnum[body]; ++i) {
    const int geom = m->body_geomadr[body] + i;
    if (!(m->geom_rbound[geom] > 0.0)) continue;
    radius = std::max(radius, vec3_at(m->geom_pos, geom).norm() + m->geom_rbound[geom]);
  }
  return radius;
}

int body_of(const mjModel* m, int mocap) {
  const int* const ids = m->body_mocapid;
  return static_cast<int>(std::find(ids, ids + m->nbody, mocap) - ids);
}

}  // namespace

Twist MocapMotion::at(const mjModel* m, const mjData* d, int body, const Vec3& point) const {
  const int mocap = mocap_of(m, body);
  if (mocap < 0 || !rows_) return {};
  const MocapRow row = this->row(mocap);
  const Vec3 arm = point - vec3_at(d->xpos, m->body_rootid[body]);
  const Twist twist = row.twist();
  return {twist.angular, twist.at(arm)};
}

void MocapMotion::read(const mjModel* m, const mjData* d, const MocapMotion* before, double elapsed,
                       bool goes_on) const {
  for (int mocap = 0; mocap < m->nmocap; ++mocap) {
    const int body = body_of(m, mocap);
    const MocapRow now = row(mocap);
    std::copy_n(d->xpos + 3 * body, 3, now.p);
    std::copy_n(d->xquat + 4 * body, 4, now.p + 3);
    std::fill(now.p + 7, now.p + MocapRow::kNumbers, 0.0);
    if (!before) continue;
    const MocapRow last = before->row(mocap);
    if (goes_on) {
      now.set_twist(last.twist());
      continue;
    }
    if (!(elapsed > 0.0) || now.pose() == last.pose()) continue;
    mjtNum turn[3];
    mju_subQuat(turn, now.p + 3, last.p + 3);
    mju_rotVecQuat(turn, turn, last.p + 3);
    const Vec3 angular = Vec3::from(turn) / elapsed;
    const Vec3 linear = (now.pose().head<3>() - last.pose().head<3>()) / elapsed;
    const double radius = radius_of(m, body), speed = linear.norm() + radius * angular.norm();
    const bool is_put =
        !(speed <= kFastestMocap) || (radius > 0.0 && speed * elapsed > 2.0 * radius);
    if (is_put) continue;
    now.set_twist({angular, linear});
  }
}

void MocapMotion::add_load(const mjModel* m, const mjData* d, int body, const Vec3& point,
                           const Vec3& force, const Vec3& torque) const {
  const int mocap = mocap_of(m, body);
  if (mocap < 0) return;
  const Vec3 arm = point - vec3_at(d->xpos, m->body_rootid[body]);
  row(mocap).add({torque + arm.cross(force), force});
}

double MocapMotion::work_since(const mjModel* m, const MocapMotion& before, double elapsed) const {
  double power = 0.0;
  for (int mocap = 0; mocap < m->nmocap; ++mocap) {
    const MocapRow now = row(mocap), last = before.row(mocap);
    power += power_of(last.wrench(), now.twist());
  }
  return -elapsed * power;
}

}  // namespace volcontact::adaptor
