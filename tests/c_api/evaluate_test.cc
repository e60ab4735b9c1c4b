// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <limits>

#include "c_api/support.h"
#include "volcontact/force/laws.h"
#include "volcontact/model/contact_model.h"

namespace volcontact::c_api::testing::evaluate_test {
namespace {

constexpr double kPi = 3.14159265358979323846;

// A box on a box, with bristles.
Model boxes() {
  Model model = model_of(solid("box", "half_sizes", {0.1, 0.08, 0.05}),
                         solid("box", "half_sizes", {0.5, 0.5, 0.05}));
  EXPECT_EQ(vc_model_choose(model.get(), "friction_law", "bristle"), 0);
  EXPECT_EQ(set(model, "damping", 0.5), 0);
  return model;
}

int evaluate(const Model& model, const Workspace& workspace, const vc_motion& motion,
             vc_result& result, const std::vector<double>* state = nullptr,
             std::vector<double>* next = nullptr, double elapsed = 0.0) {
  const std::size_t size = state ? state->size() : next ? next->size() : 0;
  return vc_evaluate(model.get(), workspace.get(), &motion, state ? state->data() : nullptr,
                     next ? next->data() : nullptr, static_cast<int>(size), elapsed, &result);
}

TEST(CEvaluate, BallInAFloorIsTheSphericalCap) {
  const double r = 0.05, h = 0.002;
  const Model model = model_of(solid("sphere", "radius", {r}), solid("half_space"));
  ASSERT_EQ(set(model, "stiffness", 2e8), 0);
  vc_result result;
  ASSERT_EQ(evaluate(model, workspace(), at(3.0, -1.0, r - h), result), 0) << vc_error();
  const double volume = kPi * h * h * (3.0 * r - h) / 3.0;
  EXPECT_NEAR(result.metrics.volume, volume, 1e-12 * volume);
  EXPECT_NEAR(result.force_on_a[2], 2e8 * volume, 1e-6);
  EXPECT_EQ(result.force_on_b[2], -result.force_on_a[2]);
  EXPECT_NEAR(result.torque_on_b[0], result.force_on_b[2] * -1.0, 1e-6);  // y f_z
  EXPECT_EQ(result.sites, 1);
  EXPECT_EQ(result.metrics.status, VC_OK);
}

TEST(CEvaluate, EqualsTheModelBehindItToTheBit) {
  const Model model = boxes();
  const Workspace scratch = workspace();
  vc_motion motion = at(0.45, 0.02, 0.099, 0.3);
  motion.V_WA[3] = 0.1;
  motion.V_WA[2] = 0.7;
  vc_result result;
  std::vector<double> next(static_cast<std::size_t>(vc_model_state_size(model.get(), 4)));
  ASSERT_EQ(evaluate(model, scratch, motion, result, nullptr, &next, 0.0), 0) << vc_error();

  const Shape a = Box({.half_sizes = {0.1, 0.08, 0.05}}), b = Box({.half_sizes = {0.5, 0.5, 0.05}});
  const ContactModel same(
      {{a, b, Pose{}, Pose{}}},
      {make_normal("hunt_crossley", {{"damping", {0.5}}}), make_friction("bristle", {})});
  ContactModel::Workspace own;
  ContactReport report;
  BodyMotion bodies;
  bodies.X_WA.rotation = Matrix<4, 4>::from_rows(motion.X_WA).block<3, 3>(0, 0);
  bodies.X_WA.translation = {0.45, 0.02, 0.099};
  bodies.V_WA = {{0.0, 0.0, 0.7}, {0.1, 0.0, 0.0}};
  same.evaluate(bodies, {}, own, report);
  ASSERT_TRUE(report.touching());
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(result.force_on_a[i], report.wrench_on_A().force[i]);
    EXPECT_EQ(result.torque_on_a[i], report.wrench_on_A().torque[i]);
    EXPECT_EQ(result.force_on_b[i], report.wrench_on_B().force[i]);
    EXPECT_EQ(result.torque_on_b[i], report.wrench_on_B().torque[i]);
  }
  EXPECT_EQ(result.elastic_energy, report.elastic_energy);
  EXPECT_EQ(result.power[2], report.power.slide);
  ASSERT_EQ(next[0], 1.0);
  ASSERT_EQ(next[1], same.row_size());
  EXPECT_TRUE(std::equal(report.memory.begin(), report.memory.end(), next.begin() + 2));
}

TEST(CEvaluate, StateMovesOnlyWhenTheCallerTakesIt) {
  const Model model = boxes();
  const Workspace scratch = workspace();
  std::vector<double> state(static_cast<std::size_t>(vc_model_state_size(model.get(), 4)));
  std::vector<double> next = state;
  vc_result first, again;
  ASSERT_EQ(evaluate(model, scratch, at(0, 0, 0.099), first, &state, &next, 0.0), 0);
  state = next;
  // A stiction spring: pulled by a micrometre it holds with sigma_0 times that, whatever is asked
  // in between.
  ASSERT_EQ(evaluate(model, scratch, at(1e-6, 0, 0.099), first, &state, &next, 1e-3), 0);
  ASSERT_EQ(evaluate(model, scratch, at(5e-6, 0, 0.099), again, &state, &next, 1e-3), 0);
  ASSERT_EQ(evaluate(model, scratch, at(1e-6, 0, 0.099), again, &state, &next, 1e-3), 0);
  EXPECT_EQ(std::memcmp(&first, &again, sizeof first), 0);
  EXPECT_LT(first.force_on_a[0], 0.0);
  // The same through one array.
  std::vector<double> both = state;
  ASSERT_EQ(evaluate(model, scratch, at(1e-6, 0, 0.099), again, &both, &both, 1e-3), 0);
  EXPECT_EQ(std::memcmp(&first, &again, sizeof first), 0);
  EXPECT_EQ(both, next);
  // A new site has no deflection yet.
  ASSERT_EQ(evaluate(model, scratch, at(1e-6, 0, 0.099), again), 0);
  EXPECT_EQ(again.force_on_a[0], 0.0);
}

TEST(CEvaluate, SitesComeOneByOneAndAddUp) {
  // A dumbbell of two balls over a floor: two pairs, two sites.
  const Solid ball = solid("sphere", "radius", {0.05}), floor = solid("half_space");
  const Model model = empty_model();
  for (const double x : {-0.2, 0.2}) {
    const vc_motion pose = at(x, 0, 0);
    ASSERT_GE(vc_model_add_pair(model.get(), ball.get(), pose.X_WA, floor.get(), nullptr), 0);
  }
  const Workspace scratch = workspace();
  vc_result result;
  ASSERT_EQ(evaluate(model, scratch, at(0, 0, 0.049), result), 0) << vc_error();
  EXPECT_EQ(result.sites, 2);
  vc_site sites[2];
  EXPECT_EQ(vc_sites(scratch.get(), sites, 1), 2);
  ASSERT_EQ(vc_sites(scratch.get(), sites, 2), 2);
  EXPECT_EQ(sites[0].pair, 0);
  EXPECT_EQ(sites[1].pair, 1);
  EXPECT_NEAR(sites[0].metrics.centroid[0], -0.2, 1e-15);
  EXPECT_EQ(sites[0].normal_force + sites[1].normal_force, result.force_on_a[2]);
  EXPECT_EQ(sites[0].normal[2], 1.0);
  EXPECT_DOUBLE_EQ(sites[0].metrics.flatness, 1.0);
  ASSERT_EQ(evaluate(model, scratch, at(0, 0, 1.0), result), 0);
  EXPECT_EQ(vc_sites(scratch.get(), sites, 2), 0);
  EXPECT_EQ(result.metrics.volume, 0.0);
}

TEST(CEvaluate, SitesWithoutRoomAreCounted) {
  const Solid ball = solid("sphere", "radius", {0.05}), floor = solid("half_space");
  const Model model = empty_model();
  for (const double x : {-0.2, 0.0, 0.2}) {
    const vc_motion pose = at(x, 0, 0);
    ASSERT_GE(vc_model_add_pair(model.get(), ball.get(), pose.X_WA, floor.get(), nullptr), 0);
  }
  ASSERT_EQ(set(model, "restitution", 0.5), 0);
  std::vector<double> next(static_cast<std::size_t>(vc_model_state_size(model.get(), 2)));
  vc_result result;
  ASSERT_EQ(evaluate(model, workspace(), at(0, 0, 0.049), result, nullptr, &next), 0);
  EXPECT_EQ(result.sites, 3);
  EXPECT_EQ(result.forgotten, 1);
  EXPECT_EQ(next[0], 2.0);
}

TEST(CEvaluate, WrongInputIsExplained) {
  const Workspace scratch = workspace();
  vc_result result;
  EXPECT_TRUE(fails(evaluate(empty_model(), scratch, at(0, 0, 0), result), VC_ERROR_ARGUMENT,
                    {"no pairs", "vc_model_add_pair"}));
  const Model model = boxes();
  vc_motion motion = at(0, 0, 0.099);
  motion.X_WB[0] = 1.1;
  EXPECT_TRUE(fails(evaluate(model, scratch, motion, result), VC_ERROR_ARGUMENT,
                    {"vc_evaluate: X_WB", "no rotation", "row-major"}));
  motion = at(0, 0, 0.099);
  std::swap(motion.X_WA[11], motion.X_WA[14]);  // by columns
  EXPECT_TRUE(fails(evaluate(model, scratch, motion, result), VC_ERROR_ARGUMENT,
                    {"X_WA", "last row", "row-major"}));
  motion = at(0, 0, 0.099);
  motion.V_WA[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(
      fails(evaluate(model, scratch, motion, result), VC_ERROR_ARGUMENT, {"V_WA", "not finite"}));
  motion = at(0, 0, 0.099);
  std::vector<double> state(1);
  EXPECT_TRUE(fails(evaluate(model, scratch, motion, result, &state), VC_ERROR_ARGUMENT,
                    {"state_size = 1", "vc_model_state_size"}));
  state.assign(static_cast<std::size_t>(vc_model_state_size(model.get(), 2)), 0.0);
  EXPECT_TRUE(fails(evaluate(model, scratch, motion, result, &state, nullptr, -1.0),
                    VC_ERROR_ARGUMENT, {"elapsed = -1"}));
  const Model without_states = model_of(solid("sphere", "radius", {0.05}), solid("half_space"));
  for (const vc_model* any : {model.get(), without_states.get()}) {
    EXPECT_TRUE(fails(vc_evaluate(any, scratch.get(), &motion, nullptr, nullptr, -1, 0.0, &result),
                      VC_ERROR_ARGUMENT, {"vc_evaluate: state_size = -1", "must be >= 0"}));
  }
  state[0] = 1.0;
  state[1] = 5.0;
  EXPECT_TRUE(fails(evaluate(model, scratch, motion, result, &state), VC_ERROR_ARGUMENT,
                    {"the rows of the state have 5", "state of zeros"}));
  state[1] = vc_model_state_size(model.get(), 1) - 2;
  for (const double count : {3.0, 0.5, -1.0, 1e30}) {
    state[0] = count;
    EXPECT_TRUE(fails(evaluate(model, scratch, motion, result, &state), VC_ERROR_ARGUMENT,
                      {"is no count of sites"}));
  }
  state[0] = 2.0;
  state.back() = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(fails(evaluate(model, scratch, motion, result, &state), VC_ERROR_ARGUMENT,
                    {"state has a number that is not finite"}));
}

TEST(CEvaluate, OverflowIsAnErrorAndNeverAForce) {
  const Model model = model_of(solid("sphere", "radius", {0.05}), solid("half_space"));
  ASSERT_EQ(set(model, "stiffness", 1e308), 0);
  ASSERT_EQ(set(model, "damping", 1e10), 0);
  vc_motion motion = at(0, 0, 0.01);
  motion.V_WA[5] = -1e10;
  vc_result result;
  result.force_on_a[2] = 1.0;
  EXPECT_TRUE(
      fails(evaluate(model, workspace(), motion, result), VC_ERROR_RESULT, {"no finite number"}));
  EXPECT_EQ(result.force_on_a[2], 0.0);
}

TEST(CInterference, IsTheOverlapAlone) {
  const double r = 0.05, h = 0.01;
  const Solid ball = solid("sphere", "radius", {r}), floor = solid("half_space");
  const Workspace scratch = workspace();
  const vc_motion pose = at(0, 0, r - h);
  vc_metrics metrics;
  ASSERT_EQ(
      vc_interference(floor.get(), ball.get(), pose.X_WA, 1e-6, nullptr, scratch.get(), &metrics),
      0)
      << vc_error();
  EXPECT_NEAR(metrics.volume, kPi * h * h * (3.0 * r - h) / 3.0, 1e-18);
  EXPECT_NEAR(metrics.area_vector[2], kPi * h * (2.0 * r - h), 1e-15);  // of the floor: upward
  EXPECT_TRUE(fails(
      vc_interference(floor.get(), ball.get(), pose.X_WA, 1e-6, "clip", scratch.get(), &metrics),
      VC_ERROR_ARGUMENT, {"engine clip does not serve half_space with sphere"}));
  EXPECT_TRUE(fails(
      vc_interference(floor.get(), ball.get(), pose.X_WA, 0.0, nullptr, scratch.get(), &metrics),
      VC_ERROR_ARGUMENT, {"tolerance = 0", "must be > 0"}));
}

}  // namespace
}  // namespace volcontact::c_api::testing::evaluate_test
