// SPDX-License-Identifier: Apache-2.0
// plugin/simulink/volcontact_sfun.c, run as the pages of the S-function interface say Simulink runs
// a block: against a stand-in of our own for its headers (simulink_mock/).
#include <array>
#include <cstring>
#include <utility>

#include "c_api/simulink_mock/simulink_methods.h"
#include "c_api/support.h"
#include "core/support/sanitized.h"

namespace volcontact::c_api::testing::simulink_test {
namespace {

constexpr double kRadius = 0.05, kMass = 1.0, kGravity = 9.81, kStep = 1e-5;
constexpr int kPoseA = 0, kTwistA = 1, kPoseB = 2, kTwistB = 3;  // inputs
constexpr int kForceA = 0, kTorqueA = 1, kForceB = 2, kTorqueB = 3, kContact = 4;
constexpr const char* kBall =
    "pair at 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 solid sphere 0.05 "
    "at 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 solid half_space";

/// Whether a text is there and has the part in it.
::testing::AssertionResult has(const std::string& text, const char* part) {
  if (text.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "'" << text << "' does not contain '" << part << "'";
}

::testing::AssertionResult has(const char* text, const char* part) {
  return has(std::string(text ? text : "no error"), part);
}

std::string ball(const std::string& laws) { return laws + "\n" + kBall; }

/// A block with its parameters, as Simulink would hold it.
class Block {
 public:
  explicit Block(std::string text, double sites = 4.0, double sample_time = 0.0,
                 std::string names = "", std::vector<double> numbers = {})
      : text_(std::move(text)),
        names_(std::move(names)),
        sites_(sites),
        sample_time_(sample_time),
        numbers_(std::move(numbers)) {
    s.parameters[0].text = text_.c_str();
    s.parameters[1] = {nullptr, &sites_, 1};
    s.parameters[2] = {nullptr, &sample_time_, 1};
    s.parameters[3].text = names_.c_str();
    tunable(numbers_);
    s.parameters_given = 5;
  }
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;
  ~Block() { calls.terminate(&s); }

  /// Compilation of the diagram, and its start. Returns the error or "".
  std::string start() {
    calls.initialize_sizes(&s);
    if (s.error) return s.error;
    calls.initialize_sample_times(&s);
    states.assign(static_cast<std::size_t>(s.discrete_states), 7.0);
    s.states = states.data();
    pointers_.assign(static_cast<std::size_t>(s.pointers), nullptr);
    s.pointer = pointers_.data();
    calls.start(&s);
    calls.initialize_conditions(&s);
    return s.error ? s.error : "";
  }

  void tunable(const std::vector<double>& numbers) {
    numbers_ = numbers;
    s.parameters[4] = {nullptr, numbers_.data(), numbers_.size()};
  }

  /// Minor or major step: the outputs at a time and a motion.
  void outputs(double time, const vc_motion& motion) {
    s.time = time;
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 4; ++column) {
        s.input[kPoseA][4 * column + row] = motion.X_WA[4 * row + column];
        s.input[kPoseB][4 * column + row] = motion.X_WB[4 * row + column];
      }
    }
    std::copy_n(motion.V_WA, 6, s.input[kTwistA]);
    std::copy_n(motion.V_WB, 6, s.input[kTwistB]);
    calls.outputs(&s, 0);
    calls.zero_crossings(&s);
  }
  void update() { calls.update(&s, 0); }

  SimStruct s{};
  std::vector<double> states;
  const simulink_methods& calls = volcontact_sfun_methods;

 private:
  std::string text_, names_;
  double sites_, sample_time_;
  std::vector<double> numbers_;
  std::vector<void*> pointers_;
};

// A ball thrown along a floor, without spin; what acts on it is (x, z) force and y torque.
struct Ball {
  double x = 0.0, z = 0.06, angle = 0.0, vx = 0.3, vz = 0.0, turn = 0.0;

  // Turned about y: bristles measure the way of the bodies by their poses.
  [[nodiscard]] vc_motion motion() const {
    vc_motion motion = at(x, 0.0, z);
    motion.X_WA[0] = motion.X_WA[10] = std::cos(angle);
    motion.X_WA[2] = std::sin(angle);
    motion.X_WA[8] = -motion.X_WA[2];
    motion.V_WA[1] = turn;
    motion.V_WA[3] = vx;
    motion.V_WA[5] = vz;
    return motion;
  }
  void go(const double* force, const double* torque, double time) {
    vx += time * force[0] / kMass;
    vz += time * (force[2] / kMass - kGravity);
    turn += time * torque[1] / (0.4 * kMass * kRadius * kRadius);
    x += time * vx;
    z += time * vz;
    angle += time * turn;
  }
};

// A step of the midpoint rule: outputs at a minor step in between.
template <typename Outputs>
void step(Ball& ball, double time, const Outputs& outputs) {
  Ball middle = ball;
  const auto [force, torque] = outputs(time, ball, true);
  middle.go(force.data(), torque.data(), 0.5 * kStep);
  const auto [half_force, half_torque] = outputs(time + 0.5 * kStep, middle, false);
  ball.go(half_force.data(), half_torque.data(), kStep);
}

using Pair3 = std::pair<std::array<double, 3>, std::array<double, 3>>;

// The same by the block and by the container called directly; returns the ball and the peak force.
std::pair<Ball, double> same_course(const char* laws, int steps) {
  Block block(ball(laws));
  EXPECT_EQ(block.start(), "");
  vc_model* made = nullptr;
  EXPECT_EQ(vc_model_create_text(ball(laws).c_str(), &made), 0) << vc_error();
  const Model model(made);
  const Workspace scratch = workspace();
  const int size = vc_model_state_size(model.get(), 4);
  EXPECT_EQ(block.s.discrete_states, size > 0 ? size + 1 : 0);
  std::vector<double> state(static_cast<std::size_t>(size));
  double accepted = 0.0, peak = 0.0;
  vc_result result{};

  const auto by_block = [&](double time, const Ball& ball, bool major) {
    block.outputs(time, ball.motion());
    Pair3 wrench;
    std::copy_n(block.s.output[kForceA], 3, wrench.first.begin());
    std::copy_n(block.s.output[kTorqueA], 3, wrench.second.begin());
    if (major) block.update();
    return wrench;
  };
  const auto direct = [&](double time, const Ball& ball, bool major) {
    const vc_motion motion = ball.motion();
    const double elapsed = size > 0 ? time - accepted : 0.0;
    Pair3 wrench;
    EXPECT_EQ(vc_evaluate(model.get(), scratch.get(), &motion, state.data(), nullptr, size, elapsed,
                          &result),
              0);
    std::copy_n(result.force_on_a, 3, wrench.first.begin());
    std::copy_n(result.torque_on_a, 3, wrench.second.begin());
    if (major && size > 0) {
      EXPECT_EQ(vc_evaluate(model.get(), scratch.get(), &motion, state.data(), state.data(), size,
                            elapsed, &result),
                0);
      accepted = time;
    }
    return wrench;
  };
  Ball in_block, in_container;
  for (int i = 0; i < steps; ++i) {
    step(in_block, kStep * i, by_block);
    step(in_container, kStep * i, direct);
    EXPECT_EQ(block.s.error, nullptr) << block.s.error;
    EXPECT_EQ(std::memcmp(&in_block, &in_container, sizeof(Ball)), 0) << "step " << i;
    if (std::memcmp(&in_block, &in_container, sizeof(Ball)) != 0 || block.s.error) break;
    peak = std::max(peak, result.force_on_a[2]);
    if (size > 0) {
      EXPECT_EQ(std::memcmp(&block.states[1], state.data(), state.size() * sizeof(double)), 0);
    }
  }
  return {in_block, peak};
}

TEST(Simulink, BouncingBallHasTheBitsOfTheContainer) {
  const auto [ball, peak] =
      same_course("set stiffness 1 1e8\nset damping 1 2", test::cases(200000, 20000));
  if (test::kSanitized) return;  // it still bounces
  // At rest the weight is carried: k V = m g, V = pi h^2 (R - h/3).
  const double h = kRadius - ball.z;
  EXPECT_NEAR(1e8 * 3.14159265358979323846 * h * h * (kRadius - h / 3.0), kMass * kGravity, 1e-5);
  EXPECT_GT(peak, 5.0 * kMass * kGravity);  // it did bounce
}

TEST(Simulink, LawsWithMemoryHaveTheBitsOfTheContainer) {
  const auto [ball, peak] = same_course(
      "choose friction_law bristle\nchoose rolling off\nset stiffness 1 1e8\nset restitution 1 "
      "0.7\nset static_friction 1 0.3\nset friction 1 0.3",
      test::cases(100000, 20000));
  if (test::kSanitized) return;  // it still skids
  // Skidding ended: it rolls, at 5/7 of its speed and a little more, as its cap is flat.
  EXPECT_NEAR(ball.vx, 5.0 / 7.0 * 0.3, 0.005);
  EXPECT_NEAR(ball.turn * kRadius, ball.vx, 0.02 * ball.vx);
  EXPECT_GT(peak, 5.0 * kMass * kGravity);
}

TEST(Simulink, OutputsAreThoseOfTheContainer) {
  Block block(
      "pair at 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 solid box 0.1 0.08 0.05 "
      "at 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 solid box 0.5 0.5 0.05");
  ASSERT_EQ(block.start(), "");
  // A turn about z shows whether matrices are taken column by column.
  vc_motion motion = at(0.45, 0.02, 0.099, 0.3);
  motion.V_WA[2] = 0.7;
  motion.V_WB[3] = 0.2;
  block.outputs(0.0, motion);
  ASSERT_EQ(block.s.error, nullptr) << block.s.error;
  const Model model = model_of(solid("box", "half_sizes", {0.1, 0.08, 0.05}),
                               solid("box", "half_sizes", {0.5, 0.5, 0.05}));
  vc_result r;
  ASSERT_EQ(vc_evaluate(model.get(), workspace().get(), &motion, nullptr, nullptr, 0, 0.0, &r), 0);
  const double contact[] = {r.metrics.volume, r.metrics.depth, r.metrics.area, 1.0,
                            r.elastic_energy, r.power[0],      r.power[1],     r.power[2],
                            r.power[3]};
  const std::pair<int, const double*> wanted[] = {{kForceA, r.force_on_a},
                                                  {kTorqueA, r.torque_on_a},
                                                  {kForceB, r.force_on_b},
                                                  {kTorqueB, r.torque_on_b},
                                                  {kContact, contact}};
  for (const auto& [port, numbers] : wanted) {
    const int width = block.s.output_width[port];
    EXPECT_EQ(width, port == kContact ? 9 : 3);
    for (int i = 0; i < width; ++i) EXPECT_EQ(block.s.output[port][i], numbers[i]) << port;
  }
  EXPECT_GT(r.metrics.volume, 0.0);
}

TEST(Simulink, PortsTakeWhatTheyNeed) {
  Block block(ball(""), 4.0, 2e-3);
  ASSERT_EQ(block.start(), "");
  EXPECT_EQ(block.s.sample_time, 2e-3);
  EXPECT_EQ(block.s.discrete_states, 0);
  EXPECT_EQ(block.s.continuous_states, 0);
  const int widths[] = {16, 6, 16, 6};
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(block.s.input_width[i], widths[i]);
    EXPECT_EQ(block.s.contiguous[i], 1);
    EXPECT_EQ(block.s.feedthrough[i], 1);  // so Simulink finds algebraic loops
  }
  EXPECT_EQ(block.s.tunable[0], SS_PRM_NOT_TUNABLE);
  EXPECT_EQ(block.s.tunable[4], SS_PRM_SIM_ONLY_TUNABLE);
}

TEST(Simulink, TouchAndReleaseCrossZero) {
  Block block(ball(""));
  ASSERT_EQ(block.start(), "");
  block.outputs(0.0, at(0, 0, 0.0501));
  EXPECT_EQ(block.s.zero_crossing[0], -1.0);
  block.outputs(0.1, at(0, 0, 0.0499));
  EXPECT_EQ(block.s.zero_crossing[0], 1.0);
}

TEST(Simulink, TunableNumbersChangeInARun) {
  Block block(ball(""), 4.0, 0.0, "stiffness damping", {1e8, 0.0});
  ASSERT_EQ(block.start(), "");
  block.outputs(0.0, at(0, 0, 0.049));
  const double force = block.s.output[kForceA][2];
  EXPECT_GT(force, 0.0);
  block.tunable({2e8, 0.0});
  block.calls.check_parameters(&block.s);
  ASSERT_EQ(block.s.error, nullptr) << block.s.error;
  block.calls.process_parameters(&block.s);
  block.outputs(0.0, at(0, 0, 0.049));
  EXPECT_DOUBLE_EQ(block.s.output[kForceA][2], 2.0 * force);
  block.tunable({-1.0, 0.0});
  block.calls.check_parameters(&block.s);
  EXPECT_TRUE(has(block.s.error, "stiffness = -1"));
}

TEST(Simulink, NumbersThatChangeTheMemoryNeedAStop) {
  Block block(ball(""), 4.0, 0.0, "restitution", {1.0});
  ASSERT_EQ(block.start(), "");
  block.tunable({0.5});
  block.calls.check_parameters(&block.s);
  EXPECT_TRUE(has(block.s.error, "stop the simulation"));
}

TEST(Simulink, WrongParametersAreExplained) {
  EXPECT_TRUE(has(Block("").start(), "parameter 1 must be the text of a model"));
  EXPECT_TRUE(has(Block("pair at nowhere").start(), "nowhere"));
  for (const double sites : {0.0, 1.5, 1001.0}) {
    EXPECT_TRUE(has(Block(ball(""), sites).start(), "parameter 2"));
  }
  EXPECT_TRUE(has(Block(ball(""), 4.0, -1.0).start(), "parameter 3"));
  EXPECT_TRUE(has(Block(ball(""), 4.0, 0.0, "stiffness", {}).start(), "one number for each name"));
  EXPECT_TRUE(has(Block(ball(""), 4.0, 0.0, "", {1.0}).start(), "one number for each name"));
  EXPECT_TRUE(has(Block(ball(""), 4.0, 0.0, "stifness", {1.0}).start(), "stiffness"));
}

TEST(Simulink, WrongInputStopsTheRun) {
  Block block(ball(""));
  ASSERT_EQ(block.start(), "");
  vc_motion motion = at(0, 0, 0.049);
  motion.X_WA[0] = 2.0;
  block.outputs(0.0, motion);
  EXPECT_TRUE(has(block.s.error, "X_WA"));
}

TEST(Simulink, MoreSitesThanMemoryStopTheRun) {
  std::string text = "choose friction_law bristle";
  for (const char* x : {"-0.2", "0.2"}) {
    text += std::string("\npair at 1 0 0 ") + x +
            " 0 1 0 0 0 0 1 0 0 0 0 1 solid sphere 0.05 "
            "at 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 solid half_space";
  }
  Block block(text, 1.0);
  ASSERT_EQ(block.start(), "");
  block.outputs(0.0, at(0, 0, 0.049));
  ASSERT_EQ(block.s.error, nullptr);
  block.update();
  EXPECT_TRUE(has(block.s.error, "more sites than parameter 2"));
}

}  // namespace
}  // namespace volcontact::c_api::testing::simulink_test
