// SPDX-License-Identifier: Apache-2.0
#include "volcontact/model/contact_tangent.h"

#include <algorithm>
#include <cmath>

#include "volcontact/model/site_laws.h"

namespace volcontact {
namespace {

using Column6 = Vector<6>;

// Friction of a site as one column: torque, then force.
Column6 friction_of(const SiteLaws& laws, const SiteReport& site, double normal_force,
                    const Vec3& slip, double spin) {
  const FrictionOutput out = laws.friction(normal_force, slip, spin);
  Column6 wrench;
  (out.torque * site.normal).to(wrench.data());
  out.force.to(wrench.data() + 3);
  return wrench;
}

// What friction adds: by the relative speed, of turning and of sliding, and by the normal force,
// from differences of the law alone.
struct FrictionTangent {
  Mat6 by_speed = Mat6::Zero();
  Column6 by_force = Column6::Zero();
};

// Adds a b' to the three columns from `first` on.
void add_outer(const Column6& a, const Vec3& b, int first, Mat6& out) {
  for (int k = 0; k < 3; ++k) out.col(first + k) += a * b[k];
}

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
    add_outer((more - less) / (2.0 * speed), along, 3, out.by_speed);
  }
  const double turn = kSmall * std::max(1e-1, std::abs(site.spin));
  const Column6 more = friction_of(laws, site, site.normal_force, site.slip, site.spin + turn);
  const Column6 less = friction_of(laws, site, site.normal_force, site.slip, site.spin - turn);
  add_outer((more - less) / (2.0 * turn), site.normal, 0, out.by_speed);
  const double force = kSmall * site.normal_force;
  if (force > 0.0) {
    out.by_force = (friction_of(laws, site, site.normal_force + force, site.slip, site.spin) -
                    friction_of(laws, site, site.normal_force - force, site.slip, site.spin)) /
                   (2.0 * force);
  }
  friction_of(laws, site, site.normal_force, site.slip, site.spin);  // last: what is kept is of now
  return out;
}

// Turn and displacement of a body at a point, from those of its frame: the point lies at `p`.
Mat6 motion_at(const Vec3& p) {
  Mat6 j = Mat6::Identity();
  j.set_block(3, 0, -skew(p));
  return j;
}

// Adds how the wrenches on both bodies change with the motion of both, from how the one on A at the
// site changes with that of A against B there.
void add_between(const Mat6& at_site, const Mat6 (&motion)[2], Mat12& out) {
  for (const int row : {0, 1}) {
    for (const int column : {0, 1}) {
      const Mat6 change = motion[row].transpose() * (at_site * motion[column]);
      out.add_block(6 * row, 6 * column, row == column ? change : -change);
    }
  }
}

// The wrench of a site turns with the bodies, with the mean of both, and its point moves with A.
void add_turning(const SiteReport& site, const Vec3& from_A, const Vec3& from_B, Mat12& by_motion) {
  const Mat3 force = skew(site.force_on_A), torque = skew(site.torque_on_A);
  for (const int body : {0, 6}) {
    by_motion.add_block(0, body, -0.5 * (torque + skew(from_A) * force));
    by_motion.add_block(3, body, -0.5 * force);
    by_motion.add_block(6, body, 0.5 * (torque + skew(from_B) * force));
    by_motion.add_block(9, body, 0.5 * force);
  }
  by_motion.add_block(0, 0, force * skew(from_A));
  by_motion.add_block(6, 0, -(force * skew(from_A)));
  by_motion.add_block(6, 3, force);
  by_motion.add_block(6, 9, -force);
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
  const Mat6 motion[2] = {motion_at(from_A), motion_at(from_B)};
  // How the normal force itself changes, and with it friction.
  const auto with_friction = [&](const Mat6& tangent_W) {
    Mat6 out = -tangent_W;
    for (int k = 0; k < 6; ++k) {
      const double by_force = n.dot(tangent_W.col(k).tail<3>());
      out.col(k) -= friction.by_force * by_force;
    }
    return out;
  };
  // The velocity at the centroid changes too where a spinning body is turned or moved: left out,
  // as is the motion of the centroid in the bodies.
  add_between(with_friction(tangent.stiffness_W()), motion, by_motion);
  Mat6 at_speed = with_friction(tangent.damping_W());
  at_speed += friction.by_speed;
  add_between(at_speed, motion, by_speed);
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
