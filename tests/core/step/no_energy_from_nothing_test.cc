// SPDX-License-Identifier: Apache-2.0
// docs/theory.md, "No energy from nothing": K' + sum T' <= K + sum T, in one step, whatever the
// poses, masses, laws and the step.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <vector>

#include "core/support/free_bodies.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"
#include "volcontact/force/laws.h"
#include "volcontact/step/implicit_step.h"

namespace volcontact::no_energy_from_nothing_test {
namespace {

constexpr double kHalf = 0.1;  // of boxes and radii [m]

struct Pair {
  ContactModel model;
  ContactReport report;
  PairEnergy energy;
  int a, b;
};

Shape random_solid(test::Random& random) {
  const double kind = random.uniform();
  const double x = random.uniform(0.3, 1.0) * kHalf, y = random.uniform(0.3, 1.0) * kHalf;
  if (kind < 0.5) return Box({.half_sizes = {x, y, kHalf}});
  if (kind < 0.7) return Sphere({.radius = x});
  if (kind < 0.85) return Cylinder({.radius = x, .half_length = y});
  return Capsule({.radius = 0.5 * x, .half_length = y});
}

ContactLaws random_laws(test::Random& random) {
  const std::vector<double> stiffness = {random.log_uniform(1e5, 1e12)};
  const std::vector<double> damping = {random.uniform() < 0.3 ? 0.0
                                                              : random.log_uniform(0.1, 10.0)};
  ContactLaws laws;
  laws.normal = make_normal("hunt_crossley", {{"stiffness", stiffness}, {"damping", damping}});
  const double friction = random.uniform();
  if (friction < 0.3) return laws;
  const std::vector<double> mu = {random.uniform(0.05, 1.2)};
  if (friction > 0.8) {
    laws.friction = make_friction("bristle", {{"friction", mu}, {"static_friction", mu}});
  } else {
    const char* name = friction < 0.6 ? "elastic_coulomb" : "regularized_coulomb";
    laws.friction = make_friction(name, {{"friction", mu}});
  }
  laws.mass = 1.0;
  return laws;
}

class NoEnergyInParts : public ::testing::TestWithParam<ImplicitParts> {};

TEST_P(NoEnergyInParts, HoldsInEveryStep) {
  const int kRuns = test::cases(3000, 400);
  test::Random random(11);
  int touching = 0, limited = 0;
  double worst = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    test::FreeBodies bodies;
    bodies.step = random.log_uniform(2e-4, 1e-2);
    const int count = 2 + static_cast<int>(random.uniform(0.0, 3.0));
    std::vector<Shape> solids = {HalfSpace()};
    std::vector<Pose> poses = {Pose()};
    std::vector<Twist> twists = {Twist()};
    for (int i = 1; i < count; ++i) {
      const double mass = random.log_uniform(1e-3, 1e3);
      const Mat3 r = random.rotation();
      const Vec3 principal(random.uniform(0.2, 1.0), random.uniform(0.2, 1.0), 0.6);
      const Mat3 inertia = mass * kHalf * kHalf * r * principal.asDiagonal() * r.transpose();
      poses.push_back({random.uniform() < 0.5 ? Mat3::Identity() : r, random.in_box(kHalf)});
      twists.push_back({random.in_box(random.log_uniform(0.01, 30.0)),
                        random.in_box(random.log_uniform(0.01, 30.0))});
      bodies.add(mass, inertia, poses.back().translation, twists.back());
      solids.push_back(random_solid(random));
    }
    const double exit_speed = random.uniform() < 0.5 ? 0.0 : 0.1;
    const auto v = bodies.velocity();
    ImplicitStep step;
    ContactModel::Workspace workspace;
    std::deque<Pair> pairs;  // which does not move what is in it
    std::vector<double> held;
    double before = bodies.kinetic_energy(v);
    for (int a = 1; a < count; ++a) {
      for (int b = 0; b < a; ++b) {
        Pair& pair = pairs.emplace_back(
            Pair{ContactModel({{solids[size(a)], solids[size(b)], {}, {}}}, random_laws(random)),
                 {},
                 {},
                 a,
                 b});
        pair.report.keeps_inputs = true;
        const BodyMotion motion{poses[size(a)], poses[size(b)], twists[size(a)], twists[size(b)]};
        pair.model.evaluate(motion, {}, workspace, pair.report);
        if (!pair.report.touching()) {
          pairs.pop_back();
          continue;
        }
        const PairEnergy::Now now(pair.report);
        // What the law holds was put in by motion, or in part, or not at all.
        const double paid = std::clamp(random.uniform(-0.5, 1.5), 0.0, 1.0);
        pair.energy.stored = pair.energy.most = paid * now.elastic;
        before += pair.energy.stored;
        held.push_back(pair.energy.stored);
        step.begin_pair(WorkLimit::of(pair.energy, 0.0, exit_speed));
        for (std::size_t i = 0; i < pair.report.sites.size(); ++i) {
          if (pair.report.sites[i].normal.isZero(0.0)) continue;
          step.add(pair.model, pair.report, i, a, b, {}, true);
        }
      }
    }
    if (step.empty()) continue;
    ++touching;
    NoConstraints none;
    const std::vector<double> known(size(bodies.trees->dofs()), 0.0);
    step.solve(bodies, none, GetParam(), known.data());
    Eigen::VectorXd after = v;
    double stored = 0.0;  // less what is owed
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      Pair& pair = pairs[k];
      const auto push = [&](int body, const Wrench& wrench) {
        if (body == 0) return;
        const auto at = 6 * (body - 1);
        Eigen::Matrix<double, 6, 1> f;
        f << test::eigen(wrench.force), test::eigen(wrench.torque);
        after.segment<6>(at) += bodies.step * (bodies.mobility(body) * f);
      };
      push(pair.a, pair.report.wrench_on_A());
      push(pair.b, pair.report.wrench_on_B());
      if (!step.is_pair_solved(k)) continue;
      pair.energy.solve(step.work(k), step.friction_work(k), step.released_at_most(k),
                        step.lent(k));
      stored += pair.energy.stored;
      if (step.work(k) > 0.5 * held[k]) ++limited;
      // No site pulls, and friction stays within its cone.
      for (const SiteReport& site : pair.report.sites) EXPECT_GE(site.normal_force, 0.0) << run;
    }
    ASSERT_TRUE(after.allFinite()) << run;
    const double made = bodies.kinetic_energy(after) + stored - before;
    const double rounding = 1e-9 * before;
    worst = std::max(worst, made / before);
    EXPECT_LE(made, rounding) << "run " << run << " of " << before << " J";
  }
  EXPECT_GT(touching, kRuns / 2);
  EXPECT_GT(limited, kRuns / 50);
  RecordProperty("worst", std::to_string(worst));
}

// A push that is another one whenever it is asked for, in as many rounds as a step takes, and then
// none: constraints and contact that answer each other without end.
class RestlessPush final : public LinearConstraints {
 public:
  RestlessPush(int dof, double force) : force_(force) {
    begin_rows();
    add_entry(dof, 1.0);
    end_row(0.0);
  }

 private:
  void respond(std::span<const int> rows, std::span<const double> /*violation*/) override {
    constexpr int kRounds = 12;
    ++asked_;
    const double push = asked_ > kRounds ? 0.0 : asked_ % 2 == 0 ? force_ : 0.5 * force_;
    for (const int row : rows) set_response(row, push, 0.0);
  }

  double force_;
  int asked_ = 0;
};

TEST(NoEnergyFromNothing, HoldsWhereConstraintsComeToNoEnd) {
  for (const double speed : {0.0, 0.1, 1.0}) {
    test::FreeBodies bodies;
    bodies.step = 1e-3;
    const Vec3 centre(0.0, 0.0, 0.99 * kHalf);
    const Twist twist{Vec3::Zero(), Vec3(0.0, 0.0, -speed)};
    bodies.add(1.0, 4e-3 * Mat3::Identity(), centre, twist);
    ContactLaws laws;
    laws.normal = make_normal("hunt_crossley", {{"stiffness", {1e9}}, {"damping", {0.1}}});
    laws.mass = 1.0;
    const ContactModel model({{Sphere({.radius = kHalf}), HalfSpace(), {}, {}}}, laws);
    ContactReport report;
    report.keeps_inputs = true;
    ContactModel::Workspace workspace;
    const BodyMotion motion{{Mat3::Identity(), centre}, Pose(), twist, Twist()};
    model.evaluate(motion, {}, workspace, report);
    ASSERT_TRUE(report.touching());
    PairEnergy energy;
    energy.stored = energy.most = 0.01;
    ImplicitStep step;
    step.begin_pair(WorkLimit::of(energy, 0.0, 0.0));
    step.add(model, report, 0, 1, 0, {}, true);
    RestlessPush push(2, -1e4);  // 10 m/s a step
    const std::vector<double> known(6, 0.0);
    step.solve(bodies, push, ImplicitParts::kStiff, known.data());
    const double v = -speed + bodies.step * report.wrench_on_A().force.z();
    EXPECT_GE(v, -speed);
    EXPECT_LE(0.5 * v * v, 0.5 * speed * speed + energy.stored * (1.0 + 2e-3)) << speed;
    energy.solve(step.work(0), step.friction_work(0), step.released_at_most(0), step.lent(0));
    EXPECT_LE(0.5 * v * v + energy.stored, 0.5 * speed * speed + 0.01 + 1e-9) << speed;
  }
}

INSTANTIATE_TEST_SUITE_P(Parts, NoEnergyInParts,
                         ::testing::Values(ImplicitParts::kStiff, ImplicitParts::kAll,
                                           ImplicitParts::kHeld),
                         [](const auto& run) {
                           return std::string(run.param == ImplicitParts::kStiff ? "Stiff"
                                              : run.param == ImplicitParts::kAll ? "All"
                                                                                 : "Held");
                         });

}  // namespace
}  // namespace volcontact::no_energy_from_nothing_test
