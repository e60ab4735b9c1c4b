// SPDX-License-Identifier: Apache-2.0
#include "volcontact/model/contact_tangent.h"

#include <algorithm>
#include <cmath>

#include "volcontact/model/site_laws.h"

namespace volcontact {
namespace {

using Mat12 = ContactTangent::Matrix;
using Mat6x12 = Eigen::Matrix<double, 6, 12>;
using Column6 = Eigen::Matrix<double, 6, 1>;
using Row12 = Eigen::Matrix<double, 1, 12>;

// Friction of a site as one column: torque, then force.
Column6 friction_of(const SiteLaws& laws, const SiteReport& site, double normal_force,
                    const Vec3& slip, double spin) {
  const FrictionOutput out = laws.friction(normal_force, slip, spin);
  Column6 wrench;
  wrench << out.torque * site.normal, out.force;
  return wrench;
}

// What friction adds: by the slip, the spin and the normal force, from differences of the law
// alone.
struct FrictionTangent {
  Eigen::Matrix<double, 6, 3> by_slip = Eigen::Matrix<double, 6, 3>::Zero();
  Column6 by_spin = Column6::Zero(), by_force = Column6::Zero();
};

FrictionTangent friction_tangent(const SiteLaws& laws, const SiteReport& site) {
  constexpr double kSmall = 1e-6;  // of the slip or 1 m/s, of the force: near the root of rounding
  FrictionTangent out;
  if (!laws.has_friction() || site.normal.isZero(0.0)) return out;
  const double speed = kSmall * std::max(1e-3, site.slip.norm());
  const Mat3 axes = basis_with_z(site.normal);
  for (int i = 0; i < 2; ++i) {
    const Vec3 along = axes.col(i);
    const Column6 more =
        friction_of(laws, site, site.normal_force, site.slip + speed * along, site.spin);
    const Column6 less =
        friction_of(laws, site, site.normal_force, site.slip - speed * along, site.spin);
    out.by_slip += (more - less) / (2.0 * speed) * along.transpose();
  }
  const double turn = kSmall * std::max(1e-1, std::abs(site.spin));
  out.by_spin = (friction_of(laws, site, site.normal_force, site.slip, site.spin + turn) -
                 friction_of(laws, site, site.normal_force, site.slip, site.spin - turn)) /
                (2.0 * turn);
  const double force = kSmall * site.normal_force;
  if (force > 0.0) {
    out.by_force = (friction_of(laws, site, site.normal_force + force, site.slip, site.spin) -
                    friction_of(laws, site, site.normal_force - force, site.slip, site.spin)) /
                   (2.0 * force);
  }
  friction_of(laws, site, site.normal_force, site.slip, site.spin);  // last: what is kept is of now
  return out;
}

// Turn and displacement of A against B at the point c, from those of both frames.
Mat6x12 relative_motion(const Vec3& from_A, const Vec3& from_B) {
  Mat6x12 j = Mat6x12::Zero();
  j.block<3, 3>(0, 0).setIdentity();
  j.block<3, 3>(3, 3).setIdentity();
  j.block<3, 3>(3, 0) = -skew(from_A);
  j.block<3, 3>(0, 6) = -Mat3::Identity();
  j.block<3, 3>(3, 9) = -Mat3::Identity();
  j.block<3, 3>(3, 6) = skew(from_B);
  return j;
}

// The wrench of a site turns with the bodies, with the mean of both, and its point moves with A.
void add_turning(const SiteReport& site, const Vec3& from_A, const Vec3& from_B, Mat12& by_motion) {
  const Mat3 force = skew(site.force_on_A), torque = skew(site.torque_on_A);
  for (const int body : {0, 6}) {
    by_motion.block<3, 3>(0, body) -= 0.5 * (torque + skew(from_A) * force);
    by_motion.block<3, 3>(3, body) -= 0.5 * force;
    by_motion.block<3, 3>(6, body) += 0.5 * (torque + skew(from_B) * force);
    by_motion.block<3, 3>(9, body) += 0.5 * force;
  }
  by_motion.block<3, 3>(0, 0) += force * skew(from_A);
  by_motion.block<3, 3>(6, 0) -= force * skew(from_A);
  by_motion.block<3, 3>(6, 3) += force;
  by_motion.block<3, 3>(6, 9) -= force;
}

void add_site(const ContactModel& model, ContactReport& report, std::size_t i, Mat12& by_motion,
              Mat12& by_speed) {
  const SiteReport& site = report.sites[i];
  if (site.normal.isZero(0.0)) return;
  const SiteLaws laws(model, report, i);
  SiteTangent tangent = laws.tangent();
  const FrictionTangent friction = friction_tangent(laws, site);
  if (report.elapsed == 0.0) tangent.friction.stiffness = 0.0;  // no way without time
  tangent.friction.damping = 0.0;                               // from the differences instead
  const Vec3 n = site.normal;
  const Vec3 from_A = site.metrics.centroid - report.p_WA,
             from_B = site.metrics.centroid - report.p_WB;
  const Mat6x12 motion = relative_motion(from_A, from_B);
  Column6 push;
  push << Vec3::Zero(), n;
  // How the normal force itself changes, and with it friction.
  const Row12 force_by_motion = -push.transpose() * tangent.stiffness_W() * motion;
  const Row12 force_by_speed = -push.transpose() * tangent.damping_W() * motion;
  Mat6x12 x = -tangent.stiffness_W() * motion + friction.by_force * force_by_motion;
  Mat6x12 v = -tangent.damping_W() * motion + friction.by_force * force_by_speed;
  v += friction.by_slip * motion.bottomRows<3>() +
       friction.by_spin * (n.transpose() * motion.topRows<3>());
  // The velocity at the centroid changes too where a spinning body is turned or moved: left out,
  // as is the motion of the centroid in the bodies.
  by_motion += motion.transpose() * x;
  by_speed += motion.transpose() * v;
  add_turning(site, from_A, from_B, by_motion);
}

}  // namespace

ContactTangent contact_tangent(const ContactModel& model, ContactReport& report) {
  ContactTangent out;
  for (std::size_t i = 0; i < report.sites.size(); ++i) {
    add_site(model, report, i, out.by_motion, out.by_speed);
  }
  return out;
}

}  // namespace volcontact
