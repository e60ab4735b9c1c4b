// SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include "c_api/support.h"

namespace volcontact::c_api::testing::text_test {
namespace {

std::string text_of(const Model& model) {
  const int length = vc_model_text(model.get(), nullptr, 0);
  EXPECT_GT(length, 0) << vc_error();
  std::string text(static_cast<std::size_t>(length) + 1, '\0');
  vc_model_text(model.get(), text.data(), static_cast<int>(text.size()));
  text.pop_back();
  return text;
}

Model from_text(const std::string& text) {
  vc_model* made = nullptr;
  EXPECT_EQ(vc_model_create_text(text.c_str(), &made), 0) << vc_error();
  return Model(made);
}

vc_result result_of(const Model& model, const vc_motion& motion) {
  vc_result result;
  std::memset(&result, 0, sizeof result);
  EXPECT_EQ(vc_evaluate(model.get(), workspace().get(), &motion, nullptr, nullptr, 0, 0.0, &result),
            0)
      << vc_error();
  return result;
}

Solid tetrahedron(bool mesh) {
  const double points[] = {0, 0, 0, 0.1, 0, 0, 0, 0.1, 0, 1.0 / 30, 1.0 / 30, 0.1};
  const int triangles[] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
  vc_solid* made = nullptr;
  EXPECT_EQ(mesh ? vc_solid_create_mesh(points, 4, triangles, 4, &made)
                 : vc_solid_create_polytope(points, 4, &made),
            0)
      << vc_error();
  return Solid(made);
}

Solid bored_block() {
  vc_solid* made = nullptr;
  EXPECT_EQ(vc_solid_combine("difference", solid("box", "half_sizes", {0.3, 0.3, 0.3}).get(),
                             solid("cylinder", "radius", {0.1}).get(), at(0.01, 0, 0.05, 0.2).X_WA,
                             &made),
            0)
      << vc_error();
  return Solid(made);
}

TEST(CText, EverySolidReadBackGivesTheSameBits) {
  std::vector<Solid> solids;
  for (const char* shape :
       {"half_space", "sphere", "ellipsoid", "capsule", "cylinder", "frustum", "box", "torus"}) {
    solids.push_back(solid(shape));
  }
  solids.push_back(solid("sphere", "radius", {1.0 / 3.0}));
  solids.push_back(tetrahedron(true));
  solids.push_back(tetrahedron(false));
  solids.push_back(bored_block());
  const Solid probe = solid("box", "half_sizes", {0.7, 0.6, 0.05});
  for (const Solid& one : solids) {
    const Model model = model_of(probe, one);
    const std::string text = text_of(model);
    const Model again = from_text(text);
    EXPECT_EQ(text_of(again), text);
    const vc_motion motion = at(0.05, 0.02, 0.02, 0.3);
    const vc_result here = result_of(model, motion), there = result_of(again, motion);
    EXPECT_GT(here.metrics.volume, 0.0) << text;
    EXPECT_EQ(std::memcmp(&here, &there, sizeof here), 0) << text;
  }
}

TEST(CText, KeepsLawsChoicesAndTheNamesOfParameters) {
  const Model model = model_of(solid("sphere", "radius", {0.05}), solid("half_space"));
  ASSERT_EQ(vc_model_choose(model.get(), "friction_law", "bristle"), 0);
  ASSERT_EQ(vc_model_choose(model.get(), "coupling", "quadrature"), 0);
  ASSERT_EQ(vc_model_choose(model.get(), "rolling", "off"), 0);
  ASSERT_EQ(set(model, "stiffness", 1.0 / 7.0), 0);
  ASSERT_EQ(set(model, "tolerance", 1e-5), 0);
  const Model again = from_text(text_of(model));
  char here[8192], there[8192];
  ASSERT_GT(vc_model_parameters(model.get(), here, sizeof here), 0);
  ASSERT_GT(vc_model_parameters(again.get(), there, sizeof there), 0);
  EXPECT_STREQ(here, there);
}

TEST(CText, SaysWhatIsWrongAndInWhichLine) {
  vc_model* made = nullptr;
  const auto create = [&](const char* text) { return vc_model_create_text(text, &made); };
  EXPECT_TRUE(fails(create("choose normal_law"), VC_ERROR_ARGUMENT, {"line 1", "ends"}));
  EXPECT_TRUE(fails(create("set stiffness 1 1e7\nsett"), VC_ERROR_ARGUMENT, {"line 2", "sett"}));
  EXPECT_TRUE(fails(create("set stiffness 1 many"), VC_ERROR_ARGUMENT, {"many", "no number"}));
  EXPECT_TRUE(fails(create("set stiffness 1 -1"), VC_ERROR_ARGUMENT, {"stiffness", "> 0"}));
  EXPECT_TRUE(fails(create("pair\nat 1 0 0 0 0 2 0 0 0 0 1 0 0 0 0 1"), VC_ERROR_ARGUMENT,
                    {"line 2", "no pose"}));
  vc_solid* solid = nullptr;
  EXPECT_TRUE(fails(vc_solid_create_text("spere 1", &solid), VC_ERROR_ARGUMENT, {"spere"}));
  EXPECT_TRUE(fails(vc_solid_create_text("sphere 1 2", &solid), VC_ERROR_ARGUMENT, {"more text"}));
  EXPECT_TRUE(fails(vc_solid_create_text("csg 2 member", &solid), VC_ERROR_ARGUMENT, {"line 1"}));
  EXPECT_TRUE(fails(vc_solid_create_text("csg 1 union", &solid), VC_ERROR_ARGUMENT, {"union"}));
  EXPECT_TRUE(fails(vc_solid_create_text("mesh 3 0 0 0 1 0 0 0 1 0 1 0 1 9", &solid),
                    VC_ERROR_ARGUMENT, {"index of a vertex"}));
}

}  // namespace
}  // namespace volcontact::c_api::testing::text_test
