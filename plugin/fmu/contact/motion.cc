// SPDX-License-Identifier: Apache-2.0
// How the bodies of a unit stand and move, and what their contact does to them.
#include <algorithm>

#include "fmu/contact/contact_unit.h"
#include "volcontact/base/check.h"

namespace volcontact::fmu {
namespace {

std::string body_name(int body) { return "body " + std::to_string(body); }

Mat3 rotation_from_quaternion(const double* q, int body) {
  const auto turn = Vector<4>::from(q);
  constexpr double kLeast = 1e-6;
  if (!(turn.norm() > kLeast)) {
    throw Discarded(body_name(body) + ": the quaternion has the norm " +
                    std::to_string(turn.norm()) + ", must be above 1e-6; start with 1 0 0 0");
  }
  const Vector<4> unit = turn.normalized();
  return rotation_of(unit[0], unit[1], unit[2], unit[3]);
}

Mat3 rotation_from_matrix(const double* numbers, int body) {
  const Mat3 r = Mat3::from_rows(numbers);
  const Mat3 skewed = r.transpose() * r - Mat3::Identity();
  constexpr double kFar = 1e-2;
  if (!(skewed.norm() < kFar) || r.determinant() < 0.0) {
    throw Discarded(body_name(body) + ": the 9 numbers are no rotation (|R^T R - 1| = " +
                    std::to_string(skewed.norm()) + ", allowed 0.01)");
  }
  // Solvers drift: three steps to the nearest rotation.
  Mat3 out = r;
  for (int i = 0; i < 3; ++i) out = 0.5 * out * (3.0 * Mat3::Identity() - out.transpose() * out);
  return out;
}

Pose moved(const Pose& pose, const Vec3& turn, const Vec3& way) {
  const double angle = turn.norm();
  if (angle == 0.0) return {pose.rotation, pose.translation + way};
  const Mat3 by = rotation_about(turn / angle, angle);
  return {by * pose.rotation, pose.translation + way};
}

void copy_pose(const Pose& pose, double* m) {
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) m[4 * i + k] = pose.rotation(i, k);
    m[4 * i + 3] = pose.translation[i];
  }
  m[12] = m[13] = m[14] = 0.0;
  m[15] = 1.0;
}

}  // namespace

ContactUnit::Body ContactUnit::body_at(int body, double later) const {
  Body out;
  if (!file_.is_free[static_cast<std::size_t>(body)]) return out;
  const double* q = values(Role::kQuaternion, body);
  const double* r = values(Role::kRotation, body);
  out.X.rotation = q ? rotation_from_quaternion(q, body) : rotation_from_matrix(r, body);
  out.X.translation = Vec3::from(values(Role::kPosition, body));
  out.V.angular = Vec3::from(values(Role::kAngularVelocity, body));
  out.V.linear = Vec3::from(values(Role::kVelocity, body));
  if (file_.is_in_body) {
    out.V.angular = out.X.rotation * out.V.angular;
    out.V.linear = out.X.rotation * out.V.linear;
  }
  const double* order = values(Role::kExtrapolation, 0);
  if (later == 0.0 || !order || *order == 0.0) return out;
  Twist slope;  // zero until two communication points are known
  if (*order == 2.0 && memory_.step_before > 0.0) {
    const double* before = &memory_.twists_before[6 * static_cast<std::size_t>(body)];
    slope.angular = (out.V.angular - Vec3::from(before)) / memory_.step_before;
    slope.linear = (out.V.linear - Vec3::from(before + 3)) / memory_.step_before;
  }
  out.X = moved(out.X, later * out.V.angular + 0.5 * later * later * slope.angular,
                later * out.V.linear + 0.5 * later * later * slope.linear);
  out.V = {out.V.angular + later * slope.angular, out.V.linear + later * slope.linear};
  return out;
}

vc_motion ContactUnit::motion_of(std::size_t m, double later) const {
  const UnitFile::Model& model = file_.models[m];
  vc_motion motion;
  const Body a =
      later == 0.0 ? bodies_[static_cast<std::size_t>(model.body_a)] : body_at(model.body_a, later);
  const Body b =
      later == 0.0 ? bodies_[static_cast<std::size_t>(model.body_b)] : body_at(model.body_b, later);
  copy_pose(a.X, motion.X_WA);
  copy_pose(b.X, motion.X_WB);
  std::copy_n(a.V.angular.data(), 3, motion.V_WA);
  std::copy_n(a.V.linear.data(), 3, motion.V_WA + 3);
  std::copy_n(b.V.angular.data(), 3, motion.V_WB);
  std::copy_n(b.V.linear.data(), 3, motion.V_WB + 3);
  return motion;
}

void ContactUnit::read_bodies() {
  for (std::size_t i = 0; i < bodies_.size(); ++i) bodies_[i] = body_at(static_cast<int>(i), 0.0);
}

void ContactUnit::publish() {
  std::vector<Wrench> wrenches(bodies_.size());
  for (const Role role : {Role::kVolume, Role::kDepth, Role::kSites, Role::kForgotten,
                          Role::kTouching, Role::kElasticEnergy}) {
    if (double* value = values(role, 0)) *value = 0.0;
  }
  if (double* power = values(Role::kPower, 0)) std::fill_n(power, 4, 0.0);
  touching_ = false;
  for (std::size_t m = 0; m < models_.size(); ++m) {
    publish_model(m, wrenches);
    publish_sites(m);
    if (memory_.is_stepping == 0.0) publish_rates(m);
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Mat3 to = file_.is_in_body ? Mat3(bodies_[i].X.rotation.transpose()) : Mat3::Identity();
    const int body = static_cast<int>(i);
    const Vec3 force = to * wrenches[i].force, torque = to * wrenches[i].torque;
    if (double* out = values(Role::kForce, body)) std::copy_n(force.data(), 3, out);
    if (double* out = values(Role::kTorque, body)) std::copy_n(torque.data(), 3, out);
  }
}

void ContactUnit::publish_model(std::size_t m, std::vector<Wrench>& wrenches) {
  const vc_result& r = models_[m].result;
  const auto add = [&](Role role, double number) {
    if (double* value = values(role, 0)) *value += number;
  };
  add(Role::kVolume, r.metrics.volume);
  add(Role::kSites, r.sites);
  add(Role::kForgotten, std::max(0, r.sites - file_.slots));
  add(Role::kElasticEnergy, r.elastic_energy);
  if (double* depth = values(Role::kDepth, 0)) *depth = std::max(*depth, r.metrics.depth);
  if (double* power = values(Role::kPower, 0)) {
    for (int i = 0; i < 4; ++i) power[i] += r.power[i];
  }
  touching_ = touching_ || r.sites > 0;
  if (double* value = values(Role::kTouching, 0)) *value = touching_;
  const UnitFile::Model& of = file_.models[m];
  wrenches[static_cast<std::size_t>(of.body_a)] +=
      Wrench{Vec3::from(r.torque_on_a), Vec3::from(r.force_on_a)};
  wrenches[static_cast<std::size_t>(of.body_b)] +=
      Wrench{Vec3::from(r.torque_on_b), Vec3::from(r.force_on_b)};
}

void ContactUnit::publish_sites(std::size_t m) {
  Model& model = models_[m];
  const int there = std::min(
      file_.slots, std::max(0, vc_sites(model.workspace.get(), model.sites.data(), file_.slots)));
  for (int k = 0; k < file_.slots; ++k) {
    const int slot = static_cast<int>(m) * file_.slots + k;
    vc_site site{};
    if (k < there) site = model.sites[static_cast<std::size_t>(k)];
    const double* inertia = site.metrics.inertia;
    const double half = 0.5 * (inertia[0] + inertia[4] + inertia[8]);
    const double* area = site.metrics.area_vector;
    const double moments[] = {half - inertia[0], half - inertia[4], half - inertia[8],
                              -inertia[1],       -inertia[2],       -inertia[5]};
    const auto put = [&](Role role, const double* from, int count) {
      if (double* to = values(role, slot)) std::copy_n(from, count, to);
    };
    const double active = k < there, size = Vec3(area[0], area[1], area[2]).norm();
    put(Role::kSiteActive, &active, 1);
    put(Role::kSiteCentroid, site.metrics.centroid, 3);
    put(Role::kSiteNormal, site.normal, 3);
    put(Role::kSiteForce, site.force, 3);
    put(Role::kSiteTorque, site.torque, 3);
    put(Role::kSiteSecondMoment, moments, 6);
    put(Role::kSiteArea, &size, 1);
  }
}

}  // namespace volcontact::fmu
