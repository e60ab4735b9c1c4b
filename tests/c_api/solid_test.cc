// SPDX-License-Identifier: Apache-2.0
#include "c_api/support.h"

namespace volcontact::c_api::testing::solid_test {
namespace {

constexpr double kPi = 3.14159265358979323846;

double volume_of(const Solid& solid) {
  vc_metrics metrics{};
  EXPECT_EQ(vc_solid_metrics(solid.get(), &metrics), 0) << vc_error();
  return metrics.volume;
}

TEST(CSolid, SimpleShapesHaveTheirParameters) {
  EXPECT_DOUBLE_EQ(volume_of(solid("sphere", "radius", {0.5})), kPi / 6.0);
  EXPECT_DOUBLE_EQ(volume_of(solid("box", "half_sizes", {0.1, 0.2, 0.3})), 0.048);
  const Solid box = solid("box", "half_sizes", {0.1, 0.2, 0.3});
  double numbers[3] = {};
  EXPECT_EQ(vc_solid_get(box.get(), "half_sizes", numbers, 3), 3);
  EXPECT_EQ(numbers[1], 0.2);
  numbers[2] = -1.0;
  EXPECT_EQ(vc_solid_get(box.get(), "half_sizes", numbers, 2), 3);  // no more than there is room
  EXPECT_EQ(numbers[2], -1.0);
}

TEST(CSolid, EveryNameWorks) {
  for (const char* shape :
       {"half_space", "sphere", "ellipsoid", "capsule", "cylinder", "frustum", "box", "torus"}) {
    EXPECT_NE(solid(shape), nullptr) << shape;
  }
}

TEST(CSolid, WrongNamesAndNumbersAreExplained) {
  vc_solid* none = nullptr;
  EXPECT_TRUE(
      fails(vc_solid_create("spere", &none), VC_ERROR_ARGUMENT, {"did you mean 'sphere'?"}));
  EXPECT_EQ(none, nullptr);
  const Solid ball = solid("sphere", "radius", {0.5});
  const double two[] = {1.0, 2.0}, negative = -1.0;
  EXPECT_TRUE(fails(vc_solid_set(ball.get(), "radios", two, 1), VC_ERROR_ARGUMENT,
                    {"sphere has no parameter 'radios'", "it has radius", "did you mean"}));
  EXPECT_TRUE(fails(vc_solid_set(ball.get(), "radius", two, 2), VC_ERROR_ARGUMENT,
                    {"radius takes 1 number, got 2"}));
  EXPECT_TRUE(fails(vc_solid_set(ball.get(), "radius", &negative, 1), VC_ERROR_ARGUMENT,
                    {"sphere: radius = -1 [m] is out of range", ">= 0"}));
  EXPECT_TRUE(fails(vc_solid_set(ball.get(), "radius", nullptr, 1), VC_ERROR_ARGUMENT, {"null"}));
  EXPECT_DOUBLE_EQ(volume_of(ball), kPi / 6.0);  // as it was
}

TEST(CSolid, MeshesAndPolytopesAreMadeOfPoints) {
  const double corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const int triangles[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
  vc_solid* made = nullptr;
  ASSERT_EQ(vc_solid_create_mesh(corners, 4, triangles, 4, &made), 0) << vc_error();
  EXPECT_DOUBLE_EQ(volume_of(Solid(made)), 1.0 / 6.0);
  ASSERT_EQ(vc_solid_create_polytope(corners, 4, &made), 0) << vc_error();
  const Solid hull(made);
  EXPECT_DOUBLE_EQ(volume_of(hull), 1.0 / 6.0);
  EXPECT_TRUE(fails(vc_solid_set(hull.get(), "radius", corners, 1), VC_ERROR_ARGUMENT,
                    {", nor any other"}));
  EXPECT_LT(vc_solid_create_mesh(corners, 4, triangles, 3, &made), 0);  // open
  EXPECT_TRUE(fails(vc_solid_create_mesh(corners, 4, triangles, 0, &made), VC_ERROR_ARGUMENT,
                    {"0 triangles, must be more than 0"}));
  EXPECT_LT(vc_solid_create_polytope(corners, 3, &made), 0);  // flat
}

TEST(CSolid, ComposedSolidIsTheDifferenceOfItsVolumes) {
  const Solid block = solid("box", "half_sizes", {0.1, 0.1, 0.05});
  const Solid pin = solid("cylinder", "radius", {0.02});
  vc_solid* bored = nullptr;
  ASSERT_EQ(vc_solid_combine("difference", block.get(), pin.get(), nullptr, &bored), 0)
      << vc_error();
  EXPECT_NEAR(volume_of(Solid(bored)), 0.004 - kPi * 4e-4 * 0.1, 1e-12);
  EXPECT_TRUE(fails(vc_solid_combine("diference", block.get(), pin.get(), nullptr, &bored),
                    VC_ERROR_ARGUMENT, {"did you mean 'difference'?"}));
  double pose[16] = {};
  EXPECT_TRUE(fails(vc_solid_combine("union", block.get(), pin.get(), pose, &bored),
                    VC_ERROR_ARGUMENT, {"X_AB", "no rotation"}));
}

}  // namespace
}  // namespace volcontact::c_api::testing::solid_test
