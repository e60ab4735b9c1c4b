// SPDX-License-Identifier: Apache-2.0
// Stiff contact beside MuJoCo's own constraints, at 2 ms: what they hold together comes to rest as
// deep as statics says.
#include "adaptor/step/native_constraints.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "adaptor/support/models.h"

namespace volcontact::adaptor::native_constraints_test {
namespace {

using testing::Attached;
using testing::DataPointer;
using testing::ModelPointer;

constexpr double kStiffness = 1e10;  // of each of the two materials

struct Scene {
  const char* name;
  std::string text;
};

std::string scene(const std::string& option, const std::string& bodies, const std::string& more) {
  return "<mujoco><option timestep=\"2e-3\" tolerance=\"1e-12\" iterations=\"300\" " + option +
         "/><worldbody><geom name=\"floor\" type=\"plane\" size=\"2 2 .1\"/>" + bodies +
         "</worldbody>" + more +
         testing::material(
             "m", {{"stiffness", std::to_string(kStiffness)}, {"damping", "0"}, {"friction", ".5"}},
             {"floor", "box"}) +
         "</mujoco>";
}

const std::string kBox =
    "<body name=\"box\" pos=\"0 0 .1\"><freejoint/>"
    "<geom name=\"box\" type=\"box\" size=\".1 .1 .1\" mass=\"12\"/></body>";

// A slide that a force pushes down, with a hinged lever that ends in a box on the floor.
std::string lever(const std::string& hinge, double damping) {
  const std::string damped = " damping=\"" + std::to_string(damping) + "\" ";
  const std::string free = " contype=\"0\" conaffinity=\"0\"/>";
  return "<body pos=\"0 0 .3\"><joint name=\"slide\" type=\"slide\" axis=\"0 0 1\"" + damped +
         "/><geom type=\"sphere\" size=\".02\" mass=\"2\"" + free +
         "<body><joint name=\"hinge\" axis=\"0 1 0\"" + damped + hinge +
         "/><geom type=\"capsule\" fromto=\"0 0 0 .4 0 0\" size=\".02\" mass=\"1\"" + free +
         "<body pos=\".4 0 -.1\"><geom name=\"box\" type=\"box\" size=\".05 .05 .05\" "
         "euler=\"0 -30 0\" mass=\"1\"/></body></body></body>";
}

const std::string kMotor = "<actuator><motor joint=\"slide\"/></actuator>";
const std::string kLimit = "range=\"-10 30\" limited=\"true\"";
const std::string kHeld = "<body name=\"hand\" mocap=\"true\" pos=\"0 0 .095\"/>";
const std::string kWeld = "<equality><weld body1=\"hand\" body2=\"box\"/></equality>";
// A smaller box that MuJoCo lays on it.
const std::string kOnTop =
    "<body pos=\".02 .01 .25\"><freejoint/><geom type=\"box\" size=\".05 .05 .05\" mass=\"4\"/>"
    "</body>";
const std::string kListed =
    testing::numeric("volcontact/option/pairs/listed", "1") +
    "<custom><tuple name=\"volcontact/pair/p\"><element objtype=\"geom\" objname=\"floor\"/>"
    "<element objtype=\"geom\" objname=\"box\"/></tuple></custom>";
const std::string kRope =
    "<tendon><fixed limited=\"true\" range=\"-.17 .5\"><joint joint=\"hinge\" coef=\"1\"/></fixed>"
    "</tendon>";
const std::string kImplicit = "integrator=\"implicit\"";

class BesideConstraints : public ::testing::TestWithParam<Scene> {};

// The floor bears what it would at rest under the volume it has, steadily.
TEST_P(BesideConstraints, RestsAsDeepAsItsLoadOverStiffness) {
  const ModelPointer m = testing::load(GetParam().text);
  const Attached attached(m);
  const DataPointer d = testing::make_data(m);
  if (m->nu) d->ctrl[0] = -60.0;
  for (int i = 0; i < 3000; ++i) mj_step(m.get(), d.get());
  double least = HUGE_VAL, most = 0.0;
  volcontact_site site{};
  for (int i = 0; i < 100; ++i) {
    mj_step(m.get(), d.get());
    ASSERT_EQ(volcontact_sites(m.get(), d.get(), &site, 1), 1);
    least = std::min(least, site.normal_force);
    most = std::max(most, site.normal_force);
  }
  EXPECT_TRUE(std::any_of(d->efc_force, d->efc_force + d->nefc, [](double f) { return f != 0.0; }));
  EXPECT_GT(least, 50.0);
  EXPECT_LT(most - least, 1e-6 * most);
  EXPECT_NEAR(site.volume * 0.5 * kStiffness / site.normal_force, 1.0, 1e-6);
  for (int i = 0; i < m->nv; ++i) EXPECT_LT(std::abs(d->qvel[i]), 1e-6);
}

// What the step begins its search with changes nothing of what it finds, on the way to rest.
TEST_P(BesideConstraints, TheLastAccelerationDecidesNothing) {
  const ModelPointer m = testing::load(GetParam().text);
  const Attached attached(m);
  const DataPointer d = testing::make_data(m), with = testing::make_data(m),
                    without = testing::make_data(m);
  if (m->nu) d->ctrl[0] = -60.0;
  int touched = 0;
  for (int i = 0; i < 600; ++i) {
    mj_step(m.get(), d.get());
    mj_copyData(with.get(), m.get(), d.get());
    mj_copyData(without.get(), m.get(), d.get());
    mju_zero(without->qacc_warmstart, static_cast<int>(m->nv));
    volcontact_site site{}, other{};
    for (mjData* one : {with.get(), without.get()}) mj_forward(m.get(), one);
    ASSERT_EQ(volcontact_sites(m.get(), with.get(), &site, 1),
              volcontact_sites(m.get(), without.get(), &other, 1));
    touched += site.normal_force > 0.0 ? 1 : 0;
    EXPECT_NEAR(site.normal_force, other.normal_force, 1e-9 * site.normal_force) << i;
  }
  EXPECT_GT(touched, 100);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, BesideConstraints,
    ::testing::Values(
        Scene{"Weld", scene("", kHeld + kBox, kWeld)},
        Scene{"WeldImplicit", scene(kImplicit, kHeld + kBox, kWeld)},
        Scene{"Limit", scene("", lever(kLimit, 0.0), kMotor)},
        Scene{"LimitDamped", scene("", lever(kLimit, 50.0), kMotor)},
        Scene{"LimitImplicit", scene(kImplicit, lever(kLimit, 50.0), kMotor)},
        Scene{"TendonLimit", scene("", lever("", 5.0), kRope + kMotor)},
        Scene{"NativeOnTop", scene("", kBox + kOnTop, kListed)},
        Scene{"NativeOnTopElliptic", scene("cone=\"elliptic\"", kBox + kOnTop, kListed)},
        Scene{"NativeOnTopSparse", scene("jacobian=\"sparse\"", kBox + kOnTop, kListed)}),
    [](const auto& run) { return std::string(run.param.name); });

}  // namespace
}  // namespace volcontact::adaptor::native_constraints_test
