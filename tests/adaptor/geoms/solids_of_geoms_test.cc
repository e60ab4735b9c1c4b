// SPDX-License-Identifier: Apache-2.0
#include "adaptor/geoms/solids_of_geoms.h"

#include <gtest/gtest.h>

#include "adaptor/support/models.h"

namespace volcontact::adaptor::solids_of_geoms_test {
namespace {

constexpr const char* kEveryType = R"(
<mujoco>
  <asset>
    <mesh name="wedge" vertex="0 0 0  1 0 0  0 1 0  0 0 1"/>
  </asset>
  <worldbody>
    <geom type="plane" size="1 1 1"/>
    <geom type="sphere" size=".1"/>
    <geom type="capsule" size=".1 .3"/>
    <geom type="ellipsoid" size=".1 .2 .3"/>
    <geom type="cylinder" size=".1 .3"/>
    <geom type="box" size=".1 .2 .3"/>
    <geom name="wedge" type="mesh" mesh="wedge"/>
  </worldbody>
</mujoco>)";

TEST(SolidsOfGeoms, VolumesAreThoseOfTheGeoms) {
  // Elementary formulas for the sizes above.
  const testing::ModelPointer m = testing::compile(kEveryType);
  const double r = 0.1, h = 0.6;
  const double ball = 4.0 / 3.0 * kPi * r * r * r;
  EXPECT_DOUBLE_EQ(own_metrics_of(solid_of_geom(m.get(), 1)).volume, ball);
  EXPECT_DOUBLE_EQ(own_metrics_of(solid_of_geom(m.get(), 2)).volume, ball + kPi * r * r * h);
  EXPECT_DOUBLE_EQ(own_metrics_of(solid_of_geom(m.get(), 3)).volume, 6.0 * ball);
  EXPECT_DOUBLE_EQ(own_metrics_of(solid_of_geom(m.get(), 4)).volume, kPi * r * r * h);
  EXPECT_DOUBLE_EQ(own_metrics_of(solid_of_geom(m.get(), 5)).volume, 0.2 * 0.4 * 0.6);
}

TEST(SolidsOfGeoms, PlaneIsAHalfSpace) {
  const testing::ModelPointer m = testing::compile(kEveryType);
  EXPECT_TRUE(std::holds_alternative<HalfSpace>(solid_of_geom(m.get(), 0)));
}

TEST(SolidsOfGeoms, LongAxisIsZAsInMuJoCo) {
  const testing::ModelPointer m = testing::compile(kEveryType);
  EXPECT_NEAR(bounds_of(solid_of_geom(m.get(), 2)).max.z(), 0.4, 1e-15);
  EXPECT_NEAR(bounds_of(solid_of_geom(m.get(), 4)).max.z(), 0.3, 1e-15);
}

// A chain with hinges, a slide and a ball joint, so that the tree's centre of mass is far from all
// geoms.
constexpr const char* kChain = R"(
<mujoco>
  <worldbody>
    <body pos="0 0 1"><freejoint/><geom type="box" size=".1 .2 .1"/>
      <body pos=".3 0 0"><joint type="hinge" axis="0 1 .3"/><geom type="capsule" size=".05 .2"/>
        <body pos=".3 .1 0"><joint type="slide" axis="1 0 0"/><joint type="ball"/>
          <geom type="sphere" size=".1" pos=".2 .1 -.3" euler="10 20 30"/></body></body></body>
    <geom type="plane" size="1 1 1"/>
  </worldbody>
</mujoco>)";

TEST(SolidsOfGeoms, TwistsAreThoseOfMuJoCo) {
  const testing::ModelPointer m = testing::compile(kChain);
  const testing::DataPointer d = testing::make_data(m);
  for (int i = 0; i < m->nv; ++i) d->qvel[i] = std::sin(3.0 + 7.0 * i);
  mj_forward(m.get(), d.get());
  for (int geom = 0; geom < m->ngeom; ++geom) {
    mjtNum expected[6];  // rotation first
    mj_objectVelocity(m.get(), d.get(), mjOBJ_GEOM, geom, expected, 0);
    const Twist twist = twist_of_geom(m.get(), d.get(), geom);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(twist.angular[i], expected[i], 1e-14);
      EXPECT_NEAR(twist.linear[i], expected[3 + i], 1e-14);
    }
  }
}

TEST(SolidsOfGeoms, PoseMapsGeomToWorld) {
  const testing::ModelPointer m = testing::compile(kChain);
  const testing::DataPointer d = testing::make_data(m);
  mj_forward(m.get(), d.get());
  const Pose X_WG = pose_of_geom(d.get(), 2);
  mjtNum expected[3], local[3] = {0.1, -0.2, 0.3};
  mju_mulMatVec(expected, d->geom_xmat + 18, local, 3, 3);
  mju_addTo3(expected, d->geom_xpos + 6);
  EXPECT_LT((X_WG * Vec3(0.1, -0.2, 0.3) - Vec3::from(expected)).norm(), 1e-15);
}

}  // namespace
}  // namespace volcontact::adaptor::solids_of_geoms_test
