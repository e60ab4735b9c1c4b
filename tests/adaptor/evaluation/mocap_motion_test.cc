// SPDX-License-Identifier: Apache-2.0
#include "adaptor/evaluation/mocap_motion.h"

#include <gtest/gtest.h>

#include <vector>

#include "adaptor/support/models.h"

namespace volcontact::adaptor::mocap_motion_test {
namespace {

constexpr double kStep = 2e-3;

// A plate with an arm on a hinge, and a body that is no mocap body.
class MocapMotionTest : public ::testing::Test {
 protected:
  MocapMotionTest()
      : m(testing::load(R"(<mujoco><worldbody>
  <body name="plate" mocap="true" pos="1 0 0"><geom type="box" size=".2 .2 .01"/>
    <body name="arm" pos="0 0 .1"><joint axis="0 1 0"/><geom type="box" size=".01 .01 .05"/></body>
  </body>
  <body name="free"><freejoint/><geom type="sphere" size=".05"/></body>
</worldbody></mujoco>)")),
        d(testing::make_data(m)),
        before_(MocapRow::kNumbers, 0.0),
        now_(MocapRow::kNumbers, 0.0),
        before(before_.data()),
        now(now_.data()) {
    mj_kinematics(m.get(), d.get());
    before.read(m.get(), d.get(), nullptr, 0.0, false);
  }
  int body(const char* name) { return mj_name2id(m.get(), mjOBJ_BODY, name); }
  void move(const Vec3& way, double turn_about_z = 0.0) {
    (Vec3::from(d->mocap_pos) + way).to(d->mocap_pos);
    const mjtNum z[3] = {0.0, 0.0, 1.0};
    mju_axisAngle2Quat(d->mocap_quat, z, turn_about_z);
    mj_kinematics(m.get(), d.get());
    now.read(m.get(), d.get(), &before, kStep, false);
  }

  testing::ModelPointer m;
  testing::DataPointer d;
  std::vector<double> before_, now_;
  MocapMotion before, now;
};

TEST_F(MocapMotionTest, IsTheWayOverTheStep) {
  move({0.0, 1e-3, -2e-3}, 1e-3);
  const Twist twist = now.at(m.get(), d.get(), body("plate"), Vec3(1.0, 1e-3, -2e-3));
  EXPECT_LE((twist.linear - Vec3(0.0, 0.5, -1.0)).norm(), 1e-12);
  EXPECT_LE((twist.angular - Vec3(0.0, 0.0, 0.5)).norm(), 1e-9);
}

TEST_F(MocapMotionTest, TakesAlongWhatHangsOnIt) {
  move(Vec3::Zero(), 1e-3);
  const Twist twist = now.at(m.get(), d.get(), body("arm"), Vec3(1.1, 0.0, 0.1));
  EXPECT_LE((twist.linear - Vec3(0.0, 0.05, 0.0)).norm(), 1e-9);
  const Twist other = now.at(m.get(), d.get(), body("free"), Vec3(1.1, 0.0, 0.1));
  EXPECT_TRUE(other.linear.isZero(0.0) && other.angular.isZero(0.0));
}

TEST_F(MocapMotionTest, IsNoneAtFirstAndWhereItWasPut) {
  for (const double way : {0.021, 0.6}) {  // 10.5 m/s; beyond its own size
    move({0.0, 0.0, way});
    EXPECT_TRUE(now.row(0).twist().linear.isZero(0.0)) << way;
    now.read(m.get(), d.get(), nullptr, 0.0, false);
    EXPECT_TRUE(now.row(0).twist().linear.isZero(0.0));
  }
}

TEST_F(MocapMotionTest, GoesOnBetweenStages) {
  move({1e-3, 0.0, 0.0});
  std::vector<double> numbers(MocapRow::kNumbers);
  const MocapMotion stage(numbers.data());
  stage.read(m.get(), d.get(), &now, 0.5 * kStep, true);
  EXPECT_LE((stage.row(0).twist().linear - Vec3(0.5, 0.0, 0.0)).norm(), 1e-12);
}

// The work of a wrench on a body that moves is by its power; torque by its arm.
TEST_F(MocapMotionTest, WorksAgainstItsLoads) {
  const Vec3 point(1.1, 0.0, 0.0), force(0.0, 3.0, -5.0), torque(0.0, 0.0, 0.7);
  before.add_load(m.get(), d.get(), body("arm"), point, force, torque);
  before.add_load(m.get(), d.get(), body("free"), point, force, torque);  // not his
  move({0.0, 0.0, 1e-3}, 1e-3);
  const double spin = 1e-3, along = -5.0 * 1e-3, around = (0.1 * 3.0 + 0.7) * spin;
  EXPECT_NEAR(now.work_since(m.get(), before, kStep), -(along + around), 1e-9);
}

}  // namespace
}  // namespace volcontact::adaptor::mocap_motion_test
