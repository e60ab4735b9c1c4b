// SPDX-License-Identifier: Apache-2.0
#include "volcontact/model/contact_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/support/meshes.h"
#include "volcontact/force/laws.h"

namespace volcontact::contact_model_test {
namespace {

constexpr double kRounding = 1e-12;

Pose pose(const Vec3& axis_angle, const Vec3& translation) {
  const double angle = axis_angle.norm();
  const Vec3 axis = angle > 0.0 ? Vec3(axis_angle / angle) : Vec3::UnitX();
  return {rotation_about(axis, angle), translation};
}

ContactModel sphere_on_plane(double stiffness, double damping, double friction = 0.3) {
  return ContactModel(
      {{Sphere({.radius = 0.05}), HalfSpace(), {}, {}}},
      {make_normal("hunt_crossley", {{"stiffness", {stiffness}}, {"damping", {damping}}}),
       make_friction("regularized_coulomb", {{"friction", {friction}}}), true});
}

ContactModel two_boxes() {
  return ContactModel(
      {{Box({.half_sizes = {0.1, 0.2, 0.15}}), Box({.half_sizes = {0.3, 0.1, 0.2}}),
        pose({0.1, 0.0, 0.3}, {0.01, 0.02, 0.0}), pose({0.0, 0.2, 0.0}, {0.0, 0.0, 0.05})},
       {Sphere({.radius = 0.12}),
        Box({.half_sizes = {0.3, 0.1, 0.2}}),
        pose({0.0, 0.0, 0.0}, {0.0, 0.15, 0.1}),
        {}}},
      {make_normal("hunt_crossley", {{"stiffness", {1e7}}, {"damping", {0.2}}}),
       make_friction("regularized_coulomb", {{"friction", {0.4}}}), true},
      {.tolerance = 1e-2});
}

BodyMotion moving() {
  BodyMotion motion;
  motion.X_WA = pose({0.2, -0.1, 0.4}, {0.3, 0.1, 0.6});
  motion.X_WB = pose({-0.1, 0.3, 0.1}, {0.35, 0.3, 0.7});
  motion.V_WA = {{0.3, -0.7, 1.1}, {0.2, 0.1, -0.4}};
  motion.V_WB = {{-0.2, 0.4, 0.1}, {0.0, 0.3, 0.2}};
  return motion;
}

TEST(ContactModel, ActionEqualsReactionAndMomentsBalance) {
  ContactModel::Workspace workspace;
  ContactReport report;
  const BodyMotion motion = moving();
  two_boxes().evaluate(motion, {}, workspace, report);
  ASSERT_TRUE(report.touching());
  const Wrench& a = report.wrench_on_A();
  const Wrench& b = report.wrench_on_B();
  const double scale = a.force.norm();
  ASSERT_GT(scale, 1.0);
  EXPECT_NEAR((a.force + b.force).norm(), 0.0, kRounding * scale);
  const Vec3 moment_W = a.torque + motion.X_WA.translation.cross(a.force) + b.torque +
                        motion.X_WB.translation.cross(b.force);
  EXPECT_NEAR(moment_W.norm(), 0.0, kRounding * scale);
}

TEST(ContactModel, MovingTheWorldTurnsTheWrenches) {
  ContactModel::Workspace workspace;
  ContactReport report, moved_report;
  const BodyMotion motion = moving();
  const Pose X_VW = pose({1.0, 0.4, -0.7}, {0.4, -0.2, 0.3});
  const BodyMotion moved{X_VW * motion.X_WA,
                         X_VW * motion.X_WB,
                         {X_VW.rotation * motion.V_WA.angular, X_VW.rotation * motion.V_WA.linear},
                         {X_VW.rotation * motion.V_WB.angular, X_VW.rotation * motion.V_WB.linear}};
  const ContactModel model = two_boxes();
  model.evaluate(motion, {}, workspace, report);
  model.evaluate(moved, {}, workspace, moved_report);
  // The octree pair may cut other cells after rounding, within its own tolerance.
  const double allowed = 1e-9 * report.wrench_on_A().force.norm();
  EXPECT_NEAR(
      (X_VW.rotation * report.wrench_on_A().force - moved_report.wrench_on_A().force).norm(), 0.0,
      allowed);
  EXPECT_NEAR(
      (X_VW.rotation * report.wrench_on_B().torque - moved_report.wrench_on_B().torque).norm(), 0.0,
      allowed);
}

TEST(ContactModel, SumsItsPairs) {
  ContactModel::Workspace workspace;
  ContactReport both, one;
  const BodyMotion motion = moving();
  const ContactModel model = two_boxes();
  model.evaluate(motion, {}, workspace, both);
  Vec3 sum = Vec3::Zero();
  for (const GeometricPair& pair : model.pairs()) {
    ContactModel({pair}, model.laws(), model.options()).evaluate(motion, {}, workspace, one);
    sum += one.wrench_on_A().force;
  }
  EXPECT_EQ(both.sites.size(), 2u);
  EXPECT_NEAR((sum - both.wrench_on_A().force).norm(), 0.0, kRounding * sum.norm());
}

// m = 1 kg, R = 0.05 m, k = 1e8 N/m^3: k pi h^2 (3R - h)/3 = m g has the root h = 0.792364 mm.
TEST(ContactModel, HoldsAKilogramAtTheClosedFormDepth) {
  const double depth = 0.792364e-3;
  BodyMotion motion;
  motion.X_WA.translation = {0.0, 0.0, 0.05 - depth};
  ContactModel::Workspace workspace;
  ContactReport report;
  sphere_on_plane(1e8, 0.5).evaluate(motion, {}, workspace, report);
  EXPECT_NEAR(report.wrench_on_A().force.z(), 9.81, 9.81 * 2e-6);  // six digits of depth
}

// docs/theory.md, "Rolling resistance": -k a X2 w with X2 = int x^2 dV of the cap.
TEST(ContactModel, RollingSphereFeelsTheSecondMomentOfItsCap) {
  const double h = 0.792364e-3, R = 0.05, a = 0.5, k = 1e8;
  BodyMotion motion;
  motion.X_WA.translation = {0.0, 0.0, R - h};
  motion.V_WA.angular = {0.0, 20.0, 0.0};
  ContactModel::Workspace workspace;
  ContactReport report;
  const ContactModel frictionless(
      {{Sphere({.radius = R}), HalfSpace(), {}, {}}},
      {make_normal("hunt_crossley", {{"stiffness", {k}}, {"damping", {a}}}), nullptr, true});
  frictionless.evaluate(motion, {}, workspace, report);
  ASSERT_EQ(report.sites.size(), 1u);
  const double X2 = kPi * h * h * h * (20 * R * R - 15 * R * h + 3 * h * h) / 60.0;
  EXPECT_NEAR(report.sites[0].torque_on_A.y() / (-k * a * X2 * 20.0), 1.0, 1e-9);
  EXPECT_NEAR(report.power.roll / (k * a * X2 * 400.0), 1.0, 1e-9);
}

// The law of a user with one state per site: an odometer of the elapsed time in contact.
class ContactClock final : public NormalForce {
 public:
  static constexpr std::array kStates{StateField{"age", "s", Keeping::kValue, "time in contact"}};
  const char* name() const noexcept override { return "contact_clock"; }
  std::span<const StateField> states() const noexcept override { return kStates; }
  NormalOutput evaluate(const NormalInput& in, const LawState& state) const noexcept override {
    state.pending[0] = state.committed[0] + state.elapsed;
    const double force = in.volume * (1.0 + state.committed[0]);
    return {force, force, 0.0, 0.0};
  }
};

TEST(ContactModel, CarriesTheStateOfASiteAndForgetsItApart) {
  const ContactModel model({{Sphere({.radius = 1.0}), HalfSpace(), {}, {}}},
                           {std::make_shared<ContactClock>(), nullptr, true});
  ASSERT_EQ(model.row_size(), kSiteHead + 1);
  ContactModel::Workspace workspace;
  ContactReport report;
  std::vector<double> rows;
  for (const double expected : {0.5, 1.0, 1.5}) {
    const int count = rows.empty() ? 0 : 1;
    model.evaluate({}, {rows.data(), count, model.row_size(), 0.5}, workspace, report);
    rows = report.memory;
    ASSERT_EQ(rows.size(), static_cast<std::size_t>(model.row_size()));
    EXPECT_DOUBLE_EQ(rows.back(), expected);
    EXPECT_DOUBLE_EQ(report.wrench_on_A().force.z(),
                     (expected + 0.5) * report.sites[0].metrics.volume);
  }
  BodyMotion apart;
  apart.X_WA.translation.z() = 5.0;
  model.evaluate(apart, {rows.data(), 1, model.row_size(), 0.5}, workspace, report);
  EXPECT_TRUE(report.memory.empty());
  EXPECT_FALSE(report.touching());
}

TEST(ContactModel, LawsWithoutStatesKeepNothing) {
  EXPECT_EQ(sphere_on_plane(1e7, 0.1).row_size(), 0);
}

// Sphere dropped obliquely with spin: kinetic + potential + elastic + dissipated stays put.
TEST(ContactModel, BooksEveryJoule) {
  const double mass = 1.0, radius = 0.05, g = 9.81, inertia = 0.4 * mass * radius * radius;
  const ContactModel model = sphere_on_plane(1e8, 0.3);
  ContactModel::Workspace workspace;
  ContactReport report;
  BodyMotion motion;
  motion.X_WA.translation = {0.0, 0.0, 0.08};
  motion.V_WA = {{5.0, -8.0, 30.0}, {0.6, 0.2, -1.0}};
  const auto mechanical = [&] {
    return 0.5 * mass * motion.V_WA.linear.squaredNorm() +
           0.5 * inertia * motion.V_WA.angular.squaredNorm() +
           mass * g * motion.X_WA.translation.z();
  };
  const double start = mechanical();
  double dissipated = 0.0;
  const double dt = 1e-6;
  for (int i = 0; i < 100000; ++i) {  // leapfrog, 0.1 s: falls, slides, bounces, leaves
    motion.X_WA.translation += 0.5 * dt * motion.V_WA.linear;
    const Twist before = motion.V_WA;
    for (const double part : {0.5, 1.0}) {  // midpoint rule in the velocity
      model.evaluate(motion, {}, workspace, report);
      motion.V_WA.linear =
          before.linear + part * dt * (report.wrench_on_A().force / mass - Vec3(0.0, 0.0, g));
      motion.V_WA.angular = before.angular + part * dt / inertia * report.wrench_on_A().torque;
    }
    dissipated += dt * report.power.sum();
    motion.X_WA.translation += 0.5 * dt * motion.V_WA.linear;
  }
  model.evaluate(motion, {}, workspace, report);
  EXPECT_GT(dissipated, 0.05 * start);
  EXPECT_NEAR((mechanical() + report.elastic_energy + dissipated) / start, 1.0, 1e-5);
}

ContactLaws potential(double damping, double share_of_a) {
  return {make_normal("hunt_crossley", {{"stiffness", {1e7}}, {"damping", {damping}}}),
          make_friction("regularized_coulomb", {{"friction", {0.4}}}), true,
          Formulation::kPotential, share_of_a};
}

TEST(ContactModel, PotentialOfAHalfSpaceIsGonthiers) {
  // Where the plane carries the field the two are one: all of it, damping and friction included.
  const GeometricPair pair{Box({.half_sizes = {0.1, 0.2, 0.15}}),
                           HalfSpace(),
                           pose({0.4, 0.3, 0.0}, {0.0, 0.0, 0.01}),
                           {}};
  ContactLaws gonthier = potential(0.7, 0.3);
  gonthier.formulation = Formulation::kGonthier;
  ContactModel::Workspace workspace;
  ContactReport one, other;
  BodyMotion motion = moving();
  motion.X_WB.translation = {0.3, 0.1, 0.55};
  ContactModel({pair}, gonthier).evaluate(motion, {}, workspace, one);
  ContactModel({pair}, potential(0.7, 0.3)).evaluate(motion, {}, workspace, other);
  ASSERT_TRUE(one.touching());
  const double size = one.wrench_on_A().force.norm();
  EXPECT_LT((one.wrench_on_A().force - other.wrench_on_A().force).norm(), 1e-10 * size);
  EXPECT_LT((one.wrench_on_A().torque - other.wrench_on_A().torque).norm(), 1e-10 * size);
  EXPECT_NEAR(one.elastic_energy, other.elastic_energy, 1e-10 * one.elastic_energy);
  EXPECT_NEAR(one.power.sum(), other.power.sum(), 1e-10 * one.power.sum());
}

TEST(ContactModel, PotentialGivesBackWhatItTook) {
  // The power of the elastic wrench is the fall of the energy, along any motion of both bodies.
  const GeometricPair pair{
      Box({.half_sizes = {0.1, 0.2, 0.15}}), Box({.half_sizes = {0.3, 0.1, 0.2}}), {}, {}};
  ContactLaws laws = potential(0.0, 0.3);
  laws.friction = nullptr;
  const ContactModel model({pair}, laws);
  ContactModel::Workspace workspace;
  ContactReport report;
  BodyMotion motion = moving();
  const auto energy_after = [&](double time) {
    BodyMotion then = motion;
    for (auto [pose_of, twist] : {std::pair{&then.X_WA, then.V_WA}, {&then.X_WB, then.V_WB}}) {
      pose_of->translation += time * twist.linear;
      pose_of->rotation = pose(time * twist.angular, Vec3::Zero()).rotation * pose_of->rotation;
    }
    model.evaluate(then, {}, workspace, report);
    return report.elastic_energy;
  };
  constexpr double kStep = 1e-5;
  const double rate = (energy_after(kStep) - energy_after(-kStep)) / (2.0 * kStep);
  model.evaluate(motion, {}, workspace, report);
  ASSERT_TRUE(report.touching());
  EXPECT_GT((report.sites[0].torque_on_A).norm(), 1e-3 * report.sites[0].force_on_A.norm());
  const double power = report.wrench_on_A().force.dot(motion.V_WA.linear) +
                       report.wrench_on_A().torque.dot(motion.V_WA.angular) +
                       report.wrench_on_B().force.dot(motion.V_WB.linear) +
                       report.wrench_on_B().torque.dot(motion.V_WB.angular);
  EXPECT_NEAR(power, -rate, 1e-6 * std::abs(rate));
}

TEST(ContactModel, PotentialOfTwoSitesGivesBackWhatItTook) {
  // A peg that is tilted in its bore, whose two sites are pushed apart, and turned back.
  const Csg bored(Csg::Operation::kDifference, Csg(Box({.half_sizes = {0.15, 0.15, 0.1}})),
                  Csg(Cylinder({.radius = 0.05, .half_length = 0.2})));
  const GeometricPair pair{bored, Cylinder({.radius = 0.049, .half_length = 0.12}), {}, {}};
  ContactLaws laws = potential(0.0, 0.5);
  laws.friction = nullptr;
  const ContactModel model({pair}, laws);
  ContactModel::Workspace workspace;
  ContactReport report;
  BodyMotion motion;
  const Vec3 spin(0.1, 0.7, 0.2), speed(1e-3, 2e-3, -1e-3);
  const auto energy_after = [&](double time) {
    motion.X_WB = {
        pose(time * spin, Vec3::Zero()).rotation * pose({0.0, 0.02, 0.0}, Vec3::Zero()).rotation,
        Vec3(1e-4, 0.0, 0.0) + time * speed};
    model.evaluate(motion, {}, workspace, report);
    return report.elastic_energy;
  };
  constexpr double kStep = 1e-6;
  const double rate = (energy_after(kStep) - energy_after(-kStep)) / (2.0 * kStep);
  energy_after(0.0);
  ASSERT_EQ(report.sites.size(), 2u);
  EXPECT_LT(report.sites[0].force_on_A.dot(report.sites[1].force_on_A), 0.0);
  const double power =
      report.wrench_on_B().force.dot(speed) + report.wrench_on_B().torque.dot(spin);
  EXPECT_NEAR(power, -rate, 1e-3 * std::abs(rate));
}

TEST(ContactModel, ErrorOfThePotentialReachesTheStatus) {
  // The volume of two meshes is exact; their pressure is to 2e-4 of the force.
  const Shape mesh = test::mesh_of(test::box_soup({0.1, 0.08, 0.06}, 2));
  const GeometricPair pair{mesh, mesh, {}, {}};
  BodyMotion motion;
  motion.X_WB = pose({0.3, 0.2, 0.1}, {0.02, 0.03, 0.1});
  ContactModel::Workspace workspace;
  ContactReport report;
  for (const double tolerance : {1e-3, 1e-8}) {
    ContactModel({pair}, potential(0.0, 0.5), {.tolerance = tolerance})
        .evaluate(motion, {}, workspace, report);
    ASSERT_TRUE(report.touching());
    EXPECT_LT(report.sites[0].metrics.volume_error, 1e-9 * report.sites[0].metrics.volume);
    EXPECT_EQ(report.sites[0].metrics.status,
              tolerance == 1e-3 ? Status::kOk : Status::kApproximate);
  }
}

TEST(ContactModel, RefusesAPairWithoutPressureField) {
  const Shape egg = Ellipsoid({.semi_axes = {0.1, 0.2, 0.15}});
  const GeometricPair pair{composed(egg), egg, {}, {}};
  EXPECT_THROW(ContactModel({pair}, potential(0.0, 0.5)), std::invalid_argument);
  EXPECT_THROW(ContactModel({{Sphere({.radius = 1.0}), HalfSpace(), {}, {}}}, potential(0.0, 1.5)),
               std::invalid_argument);
  EXPECT_THROW(formulation_from("potentail"), std::invalid_argument);
}

TEST(ContactModel, RefusesNoPairsNoLawAndAnEngineThatDoesNotServe) {
  EXPECT_THROW(ContactModel({}, {make_normal("hunt_crossley", {}), nullptr, true}),
               std::invalid_argument);
  EXPECT_THROW(ContactModel({{Sphere({.radius = 1.0}), HalfSpace(), {}, {}}}, {}),
               std::invalid_argument);
  EXPECT_THROW(
      ContactModel({{Sphere({.radius = 1.0}), HalfSpace(), {}, {}}},
                   {make_normal("hunt_crossley", {}), nullptr, true}, {.engine = Engine::kClip}),
      std::invalid_argument);
}

}  // namespace
}  // namespace volcontact::contact_model_test
