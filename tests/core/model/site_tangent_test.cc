// SPDX-License-Identifier: Apache-2.0
#include "volcontact/model/site_tangent.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/support/random.h"
#include "volcontact/force/laws.h"
#include "volcontact/model/site_laws.h"

namespace volcontact::site_tangent_test {
namespace {

using Vec6 = Vector<6>;  // torque or turn, then force or displacement

ContactLaws spring(double stiffness = 1e7) {
  return {make_normal("volume_spring", {{"stiffness", {stiffness}}}), nullptr, true};
}

ContactLaws damped() {
  return {make_normal("hunt_crossley", {{"stiffness", {1e7}}, {"damping", {0.7}}}), nullptr, true};
}

ContactReport report_of(const ContactModel& model, const BodyMotion& motion,
                        const std::vector<double>& rows = {}, double elapsed = 0.0) {
  ContactModel::Workspace workspace;
  ContactReport report;
  report.keeps_inputs = true;
  const int stride = model.row_size();
  const int count = stride > 0 ? static_cast<int>(rows.size()) / stride : 0;
  model.evaluate(motion, {rows.data(), count, stride, elapsed}, workspace, report);
  return report;
}

// Wrench on A about `point` [m] of the world.
Vec6 wrench_at(const ContactReport& report, const BodyMotion& motion, const Vec3& point) {
  const Wrench w = report.wrench_on_A().about(point - motion.X_WA.translation);
  Vec6 out;
  w.torque.to(out.data());
  w.force.to(out.data() + 3);
  return out;
}

// A displaced by `d` and turned by `turn` about `c`.
Pose moved(const Pose& X_WA, const Vec3& c, const Vec3& turn, const Vec3& d) {
  const double angle = turn.norm();
  const Mat3 r = angle > 0.0 ? rotation_about(turn / angle, angle) : Mat3::Identity();
  return {r * X_WA.rotation, r * (X_WA.translation - c) + c + d};
}

// -d(wrench)/d(motion of A) by central differences, the torque about the point of A that was the
// centroid: which a displacement takes along.
Mat6 stiffness_by_differences(const ContactModel& model, const BodyMotion& motion, double step) {
  const Vec3 c = report_of(model, motion).sites[0].metrics.centroid;
  Mat6 k;
  for (int i = 0; i < 6; ++i) {
    Vec6 side[2];
    for (const int s : {0, 1}) {
      Vec6 e = Vec6::Zero();
      e[i] = s == 0 ? -step : step;
      BodyMotion there = motion;
      there.X_WA = moved(motion.X_WA, c, e.head<3>(), e.tail<3>());
      side[s] = wrench_at(report_of(model, there), there, c + e.tail<3>());
    }
    k.col(i) = -(side[1] - side[0]) / (2.0 * step);
  }
  return k;
}

// -d(wrench)/d(twist of A at the centroid).
Mat6 damping_by_differences(const ContactModel& model, const BodyMotion& motion, double step,
                            const std::vector<double>& rows = {}, double elapsed = 0.0) {
  const Vec3 c = report_of(model, motion, rows, elapsed).sites[0].metrics.centroid;
  Mat6 k;
  for (int i = 0; i < 6; ++i) {
    Vec6 side[2];
    for (const int s : {0, 1}) {
      Vec6 e = Vec6::Zero();
      e[i] = s == 0 ? -step : step;
      BodyMotion there = motion;
      there.V_WA.angular += e.head<3>();
      there.V_WA.linear += e.tail<3>() + e.head<3>().cross(motion.X_WA.translation - c);
      side[s] = wrench_at(report_of(model, there, rows, elapsed), there, c);
    }
    k.col(i) = -(side[1] - side[0]) / (2.0 * step);
  }
  return k;
}

Mat6 stiffness_of(const ContactModel& model, const BodyMotion& motion) {
  ContactReport report = report_of(model, motion);
  EXPECT_EQ(report.sites.size(), 1u);
  return SiteLaws(model, report, 0).tangent().stiffness_W();
}

// Largest difference of the entries, each by the scale of its row and column.
double difference(const Mat6& a, const Mat6& b) {
  const double scale_force = b.block<3, 3>(3, 3).norm();
  const double scale_torque = b.block<3, 3>(0, 0).norm();
  const double length = std::sqrt(scale_torque / scale_force);
  const Vec6 scale({length, length, length, 1.0, 1.0, 1.0});
  double worst = 0.0;
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) {
      worst = std::max(worst, std::abs(a(i, k) - b(i, k)) / (scale_force * scale[i] * scale[k]));
    }
  }
  return worst;
}

// A tilted world, so that no entry is zero by chance.
BodyMotion placed(const Pose& X_BA, const Vec3& about = {0.3, -0.5, 0.2}) {
  BodyMotion motion;
  motion.X_WB = {rotation_about(about.normalized(), about.norm()), {0.4, -0.3, 0.7}};
  motion.X_WA = motion.X_WB * X_BA;
  return motion;
}

Pose at(double x, double y, double z) { return {Mat3::Identity(), {x, y, z}}; }

// A prism with upright sides whose floor has the slopes gx and gy.
ConvexPolytope slanted(double gx, double gy) {
  std::vector<Vec3> points;
  for (const double x : {-0.05, 0.05}) {
    for (const double y : {-0.03, 0.03}) {
      points.push_back({x, y, gx * x + gy * y});
      points.push_back({x, y, 0.2});
    }
  }
  return ConvexPolytope({.vertices = points});
}

constexpr double kStep = 1e-7;           // of the differences [m, rad]
constexpr double kOfDifferences = 2e-5;  // their own error, relative

TEST(SiteTangent, IsTheDerivativeOfTheWrenchWhereAFaceLies) {
  const ContactModel box({{Box({.half_sizes = {0.05, 0.03, 0.04}}), HalfSpace(), {}, {}}},
                         spring());
  const ContactModel disc({{Cylinder({.radius = 0.04, .half_length = 0.03}), HalfSpace(), {}, {}}},
                          spring());
  for (const auto& [model, height] :
       {std::pair{&box, 0.04 - 1e-3}, std::pair{&disc, 0.03 - 1e-3}}) {
    const BodyMotion motion = placed(at(0.2, 0.1, height));
    const Mat6 truth = stiffness_by_differences(*model, motion, kStep);
    EXPECT_LT(difference(stiffness_of(*model, motion), truth), 1e-3);  // the edges turn with it
  }
}

TEST(SiteTangent, IsExactForALinearDepth) {
  for (const auto& [gx, gy] : {std::pair{0.0, 0.0}, std::pair{0.02, 0.0}, std::pair{0.03, -0.04}}) {
    const ContactModel model({{slanted(gx, gy), HalfSpace(), {}, {}}}, spring());
    const BodyMotion motion = placed(at(0.0, 0.0, -4e-3));
    const Mat3 axes = motion.X_WB.rotation;
    const PatchMoments patch = patch_moments(report_of(model, motion).sites[0].metrics, axes);
    EXPECT_NEAR(patch.area, 0.06 * 0.1, 1e-15);
    EXPECT_NEAR(patch.spread(0, 0) - patch.offset.x() * patch.offset.x(), 0.01 / 12.0, 1e-14);
    EXPECT_NEAR(patch.spread(1, 1) - patch.offset.y() * patch.offset.y(), 0.0036 / 12.0, 1e-14);
    EXPECT_NEAR(patch.spread(0, 1) - patch.offset.x() * patch.offset.y(), 0.0, 1e-14);
    // The sides lean by the slope when the prism turns: of second order in it.
    const Mat6 truth = stiffness_by_differences(model, motion, kStep);
    EXPECT_LT(difference(stiffness_of(model, motion), truth),
              kOfDifferences + 3.0 * (gx * gx + gy * gy));
  }
}

TEST(SiteTangent, IsExactForAWedge) {
  // A prism that is cut along its length: depth falls linearly to zero.
  const ContactModel model({{slanted(0.1, 0.0), HalfSpace(), {}, {}}}, spring());
  const BodyMotion motion = placed(at(0.0, 0.0, 1e-3));  // 4 mm deep at one side, none from 4 cm on
  const PatchMoments patch =
      patch_moments(report_of(model, motion).sites[0].metrics, motion.X_WB.rotation);
  // Its width is 0.04 m: the second moment about the centroid of the volume is L^2/9.
  EXPECT_NEAR(patch.area, 0.04 * 0.06, 1e-12);
  EXPECT_NEAR(patch.spread(0, 0), 0.0016 / 9.0, 1e-12);
  EXPECT_NEAR(patch.spread(1, 1), 0.0036 / 12.0, 1e-12);
}

TEST(SiteTangent, OfAShallowBallIsThatOfItsCircle) {
  // A circle of radius a has a^2/4; the cap's own moment is 2/3 of that.
  const ContactModel model({{Sphere({.radius = 0.05}), HalfSpace(), {}, {}}}, spring());
  for (const double depth : {1e-5, 1e-4, 1e-3}) {
    const BodyMotion motion = placed(at(0.0, 0.0, 0.05 - depth));
    const Mat3 axes = motion.X_WB.rotation;
    const PatchMoments patch = patch_moments(report_of(model, motion).sites[0].metrics, axes);
    const double truth = depth * (0.1 - depth) / 4.0;
    EXPECT_NEAR(patch.spread(0, 0) / truth, 1.0, depth / 0.05) << depth;
    EXPECT_NEAR(patch.spread(0, 1) / truth, 0.0, 1e-6) << depth;
    const Mat6 wrench = stiffness_by_differences(model, motion, 1e-3 * depth);
    EXPECT_LT(difference(stiffness_of(model, motion), wrench), kOfDifferences + depth / 0.05);
  }
}

// What it is worth where neither holds: edges and corners of a box. The spread is never more than
// half too small, far from the factor 2 where a step would be lost.
TEST(SiteTangent, IsWithinBoundsForEdgesAndCorners) {
  test::Random random(11);
  const ContactModel model({{Box({.half_sizes = {0.05, 0.03, 0.04}}), HalfSpace(), {}, {}}},
                           spring());
  double least = 2.0, most = 0.0;
  for (int i = 0; i < 100; ++i) {
    const Mat3 turn = random.rotation();
    const Vec3 h(0.05, 0.03, 0.04);
    const double reach = turn.row(2).cwiseAbs().dot(h);
    BodyMotion motion;
    motion.X_WA = {turn, {0.0, 0.0, reach - random.log_uniform(1e-5, 1e-2)}};
    const Mat6 truth = stiffness_by_differences(model, motion, 1e-8);
    const Mat6 ours = stiffness_of(model, motion);
    EXPECT_NEAR(ours(5, 5) / truth(5, 5), 1.0, 1e-4);
    const double ratio = ours.block<2, 2>(0, 0).trace() / truth.block<2, 2>(0, 0).trace();
    least = std::min(least, ratio);
    most = std::max(most, ratio);
  }
  EXPECT_GT(least, 0.6);
  EXPECT_LT(most, 1.5);
}

TEST(SiteTangent, DampingIsTheDerivativeByTheTwist) {
  const ContactModel box({{Box({.half_sizes = {0.05, 0.03, 0.04}}), HalfSpace(), {}, {}}},
                         damped());
  const ContactModel ball({{Sphere({.radius = 0.05}), HalfSpace(), {}, {}}}, damped());
  for (const auto& [model, height] : {std::pair{&box, 0.039}, std::pair{&ball, 0.049}}) {
    BodyMotion motion = placed(at(0.2, 0.1, height));
    motion.V_WA = {{0.01, -0.02, 0.3}, {0.1, 0.2, -0.1}};
    ContactReport report = report_of(*model, motion);
    const Mat6 ours = SiteLaws(*model, report, 0).tangent().damping_W();
    const Mat6 truth = damping_by_differences(*model, motion, 1e-6);
    EXPECT_LT(difference(ours, truth), 1e-7);
  }
}

TEST(SiteTangent, HoldingFrictionIsInIt) {
  const ContactLaws laws{make_normal("hunt_crossley", {{"stiffness", {1e7}}}),
                         make_friction("bristle", {{"friction", {0.5}},
                                                   {"static_friction", {0.5}},
                                                   {"bristle_stiffness", {3e4}},
                                                   {"bristle_damping", {40.0}},
                                                   {"viscous_friction", {7.0}}}),
                         true};
  const ContactModel model({{Box({.half_sizes = {0.05, 0.03, 0.04}}), HalfSpace(), {}, {}}}, laws);
  const BodyMotion motion = placed(at(0.2, 0.1, 0.039));
  const std::vector<double> rows = report_of(model, motion).memory;
  ContactReport report = report_of(model, motion, rows, 1e-3);
  const SiteTangent tangent = SiteLaws(model, report, 0).tangent();
  const Mat6 truth = damping_by_differences(model, motion, 1e-9, rows, 1e-3);
  // Letting go begins with the square of the slip: mu f v / (v_s^2 sigma_1) is 7e-6 of it.
  EXPECT_LT(difference(tangent.damping_W(), truth), 1e-5);
  EXPECT_EQ(tangent.friction.stiffness, 3e4);
  // About the normal: the same spring at the radius of gyration.
  const double square = (0.05 * 0.05 + 0.03 * 0.03) / 3.0;
  EXPECT_NEAR(tangent.friction.lever * tangent.friction.lever, square, 1e-12);
  const Vec3 n = motion.X_WB.rotation.col(2);
  const Mat3 about = tangent.stiffness_W().block<3, 3>(0, 0);
  EXPECT_NEAR(n.dot(about * n), 3e4 * square, 1e-7);
}

TEST(SiteLaws, TheLastQuestionIsWhatIsKept) {
  const ContactLaws laws{make_normal("hunt_crossley", {{"stiffness", {1e7}}}),
                         make_friction("bristle", {}), true};
  const ContactModel model({{Sphere({.radius = 0.05}), HalfSpace(), {}, {}}}, laws);
  BodyMotion motion = placed(at(0.0, 0.0, 0.049));
  motion.V_WA.linear = {0.1, 0.0, 0.0};
  const std::vector<double> rows = report_of(model, motion).memory;
  motion.X_WA.translation.x() += 1e-7;  // so that the bristles hold something
  ContactReport report = report_of(model, motion, rows, 1e-3);
  const std::vector<double> before = report.memory;
  const SiteReport site = report.sites[0];
  const SiteLaws asked(model, report, 0);
  asked.friction(0.0, Vec3::Zero(), 0.0);
  EXPECT_NE(report.memory, before);
  const FrictionOutput again = asked.friction(site.normal_force, site.slip, site.spin);
  EXPECT_EQ(report.memory, before);
  EXPECT_LT((again.force + site.normal_force * site.normal - site.force_on_A).norm(), 1e-12);
}

}  // namespace
}  // namespace volcontact::site_tangent_test
