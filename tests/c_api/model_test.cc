// SPDX-License-Identifier: Apache-2.0
#include "c_api/support.h"

namespace volcontact::c_api::testing::model_test {
namespace {

std::string chosen(const Model& model, const char* name) {
  char word[40] = "";
  EXPECT_GE(vc_model_chosen(model.get(), name, word, sizeof word), 0) << vc_error();
  return word;
}

double number(const Model& model, const char* name) {
  double value = NAN;
  EXPECT_GE(vc_model_get(model.get(), name, &value, 1), 1) << vc_error();
  return value;
}

Model ball_on_floor() { return model_of(solid("sphere", "radius", {0.05}), solid("half_space")); }

TEST(CModel, NamesAreThoseOfTheLaws) {
  const Model model = ball_on_floor();
  EXPECT_EQ(chosen(model, "normal_law"), "hunt_crossley");
  EXPECT_EQ(chosen(model, "friction_law"), "none");
  EXPECT_EQ(set(model, "stiffness", 3e8), 0);
  EXPECT_EQ(number(model, "stiffness"), 3e8);
  EXPECT_EQ(vc_model_choose(model.get(), "friction_law", "bristle"), 0);
  EXPECT_EQ(set(model, "stribeck_speed", 0.02), 0);
  EXPECT_EQ(vc_model_choose(model.get(), "coupling", "quadrature"), 0);
  EXPECT_EQ(chosen(model, "coupling"), "quadrature");
  EXPECT_EQ(number(model, "stribeck_speed"), 0.02);
  EXPECT_EQ(number(model, "stiffness"), 3e8);
  EXPECT_EQ(vc_model_choose(model.get(), "rolling", "off"), 0);
  EXPECT_EQ(vc_model_choose(model.get(), "formulation", "potential"), 0);
  EXPECT_EQ(vc_model_choose(model.get(), "engine", "octree"), 0);
  EXPECT_EQ(chosen(model, "rolling"), "off");
  EXPECT_EQ(chosen(model, "formulation"), "potential");
  EXPECT_EQ(chosen(model, "engine"), "octree");
}

TEST(CModel, SolidsOfAPairStayNumbersOfTheModel) {
  const Model model = ball_on_floor();
  EXPECT_EQ(number(model, "pair/0/a/radius"), 0.05);
  EXPECT_EQ(set(model, "pair/0/a/radius", 0.07), 0);
  EXPECT_EQ(number(model, "pair/0/a/radius"), 0.07);
  double pose[16];
  ASSERT_EQ(vc_model_get(model.get(), "pair/0/b/pose", pose, 16), 16);
  EXPECT_EQ(pose[0] + pose[5] + pose[10] + pose[15], 4.0);
  pose[11] = -0.01;
  EXPECT_EQ(vc_model_set(model.get(), "pair/0/b/pose", pose, 16), 0) << vc_error();
  pose[0] = 2.0;
  EXPECT_TRUE(fails(vc_model_set(model.get(), "pair/0/b/pose", pose, 16), VC_ERROR_ARGUMENT,
                    {"pair/0/b/pose", "no rotation"}));
  EXPECT_TRUE(fails(vc_model_set(model.get(), "pair/0/b/pose", pose, 7), VC_ERROR_ARGUMENT,
                    {"takes 16 numbers, got 7"}));
  EXPECT_TRUE(fails(set(model, "pair/3/a/radius", 1.0), VC_ERROR_ARGUMENT,
                    {"the last pair of the model is number 0"}));
  EXPECT_TRUE(
      fails(set(model, "pair/0/radius", 1.0), VC_ERROR_ARGUMENT, {"pair/<index>/a/<parameter>"}));
}

TEST(CModel, WrongNamesAndValuesAreExplainedAndChangeNothing) {
  const Model model = ball_on_floor();
  ASSERT_EQ(set(model, "stiffness", 3e8), 0);
  EXPECT_TRUE(fails(set(model, "stifness", 1.0), VC_ERROR_ARGUMENT,
                    {"unknown parameter 'stifness'", "did you mean 'stiffness'?"}));
  EXPECT_TRUE(fails(set(model, "stiffness", -1.0), VC_ERROR_ARGUMENT,
                    {"hunt_crossley: stiffness = -1 [N/m^3] is out of range: must be > 0"}));
  EXPECT_TRUE(fails(set(model, "friction", 0.3), VC_ERROR_ARGUMENT, {"unknown parameter"}));
  EXPECT_TRUE(fails(set(model, "tolerance", 2.0), VC_ERROR_ARGUMENT,
                    {"tolerance = 2", "must be > 0 and < 1"}));
  EXPECT_TRUE(fails(set(model, "threads", 1.5), VC_ERROR_ARGUMENT, {"threads = 1.5", "whole"}));
  EXPECT_TRUE(fails(vc_model_choose(model.get(), "friction_law", "bristel"), VC_ERROR_ARGUMENT,
                    {"did you mean 'bristle'?"}));
  EXPECT_TRUE(fails(vc_model_choose(model.get(), "coupling", "none"), VC_ERROR_ARGUMENT,
                    {"unknown choice 'coupling'"}));
  EXPECT_TRUE(fails(vc_model_choose(model.get(), "engine", "clip"), VC_ERROR_ARGUMENT,
                    {"clip", "sphere", "auto or octree"}));
  EXPECT_EQ(chosen(model, "engine"), "auto");
  EXPECT_EQ(number(model, "stiffness"), 3e8);
  ASSERT_EQ(set(model, "damping", 1.0), 0);
  EXPECT_TRUE(fails(set(model, "restitution", 0.5), VC_ERROR_ARGUMENT, {"exclude each other"}));
  EXPECT_EQ(number(model, "restitution"), 1.0);
}

TEST(CModel, TableHasALineForEveryNameAndItsValueCanBeSetAgain) {
  const Model model = ball_on_floor();
  ASSERT_EQ(vc_model_choose(model.get(), "friction_law", "regularized_coulomb"), 0);
  const int length = vc_model_parameters(model.get(), nullptr, 0);
  ASSERT_GT(length, 100);
  std::string text(static_cast<std::size_t>(length) + 1, '\0');
  EXPECT_EQ(vc_model_parameters(model.get(), text.data(), length + 1), length);
  int lines = 0;
  for (std::size_t at = 0; at < static_cast<std::size_t>(length);) {
    const std::size_t end = text.find('\n', at);
    const std::string line = text.substr(at, end - at);
    at = end + 1;
    ++lines;
    const std::string name = line.substr(0, line.find('\t'));
    const std::string value = line.substr(line.rfind('\t') + 1);
    EXPECT_EQ(std::count(line.begin(), line.end(), '\t'), 3) << line;
    if (line.find("\tword\t") != std::string::npos) {
      EXPECT_EQ(vc_model_choose(model.get(), name.c_str(), value.c_str()), 0) << vc_error();
    } else {
      double numbers[16] = {};
      const int count = vc_model_get(model.get(), name.c_str(), numbers, 16);
      EXPECT_EQ(vc_model_set(model.get(), name.c_str(), numbers, count), 0) << vc_error();
      EXPECT_EQ(std::stod(value), numbers[0]) << line;
    }
  }
  // 5 words and the coupling, 4 + 2 numbers of the laws, 4 of the model, 3 of the pair.
  EXPECT_EQ(lines, 5 + 1 + 4 + 2 + 4 + 3);
}

TEST(CModel, StateSizeFollowsTheLaws) {
  const Model model = ball_on_floor();
  EXPECT_EQ(vc_model_state_size(model.get(), 4), 0);
  EXPECT_EQ(vc_model_states(model.get(), nullptr, 0), 0);
  ASSERT_EQ(set(model, "restitution", 0.5), 0);
  const int with_one = vc_model_state_size(model.get(), 1);
  const int row = vc_model_state_size(model.get(), 2) - with_one;
  EXPECT_EQ(with_one, 2 + row);
  char text[200] = "";
  EXPECT_GT(vc_model_states(model.get(), text, sizeof text), 0);
  // The last number of a row.
  EXPECT_EQ(std::string(text), "impact_speed\tm/s\t" + std::to_string(row - 1) + "\t1\n");
  EXPECT_TRUE(fails(vc_model_state_size(model.get(), -1), VC_ERROR_ARGUMENT,
                    {"sites = -1 must be 0 to 1000000"}));
}

}  // namespace
}  // namespace volcontact::c_api::testing::model_test
