// SPDX-License-Identifier: Apache-2.0
#include "adaptor/materials.h"

#include <gtest/gtest.h>

#include "adaptor/support/models.h"
#include "volcontact/force/hunt_crossley.h"

namespace volcontact::adaptor {
namespace {

double value(const PairLaws& laws, const std::string& field) {
  for (const PairField& entry : laws.fields) {
    if (entry.name == field) return entry.value.at(0);
  }
  ADD_FAILURE() << "no field " << field;
  return 0.0;
}

std::string source(const PairLaws& laws, const std::string& field) {
  for (const PairField& entry : laws.fields) {
    if (entry.name == field) return entry.source;
  }
  return {};
}

const KeyedValues kSoft{"volcontact/material/soft",
                        {{"stiffness", {1e6}}, {"damping", {0.4}}, {"friction", {0.3}}},
                        {}};
const KeyedValues kHard{"volcontact/material/hard",
                        {{"stiffness", {3e6}}, {"damping", {0.8}}, {"slip_speed", {5e-3}}},
                        {}};

TEST(Materials, StiffnessesAreInSeries) {
  // Two springs in series: 1 / (1/1e6 + 1/3e6).
  const PairLaws laws = combine({"a", 1.0, &kSoft}, {"b", 0.6, &kHard}, nullptr);
  EXPECT_DOUBLE_EQ(value(laws, "stiffness"), 0.75e6);
}

TEST(Materials, DampingIsWeightedByCompliance) {
  // (kB aA + kA aB) / (kA + kB), notes on the first-order series combination: 0.5.
  const PairLaws laws = combine({"a", 1.0, &kSoft}, {"b", 0.6, &kHard}, nullptr);
  EXPECT_DOUBLE_EQ(value(laws, "damping"), 0.5);
  // Equal damping stays.
  EXPECT_DOUBLE_EQ(value(combine({"a", 1.0, &kSoft}, {"b", 0.6, &kSoft}, nullptr), "damping"), 0.4);
}

TEST(Materials, FrictionAndSlipSpeedAreTheLarger) {
  // Hard gives no friction: its geom's own 0.6 counts. Soft gives no slip speed: the law's 1e-3.
  const PairLaws laws = combine({"a", 1.0, &kSoft}, {"b", 0.6, &kHard}, nullptr);
  EXPECT_EQ(value(laws, "friction"), 0.6);
  EXPECT_EQ(value(laws, "slip_speed"), 5e-3);
  EXPECT_TRUE(testing::contains(source(laws, "friction"), "friction of geom b"));
  EXPECT_TRUE(testing::contains(source(laws, "friction"), "volcontact/material/soft"));
}

TEST(Materials, IsSymmetric) {
  const PairLaws ab = combine({"a", 1.0, &kSoft}, {"b", 0.6, &kHard}, nullptr);
  const PairLaws ba = combine({"b", 0.6, &kHard}, {"a", 1.0, &kSoft}, nullptr);
  for (const PairField& field : ab.fields) EXPECT_EQ(field.value[0], value(ba, field.name));
}

TEST(Materials, PairOverridesSingleFields) {
  const KeyedValues rail{"volcontact/pair/rail", {{"friction", {0.1}}}, {}};
  const PairLaws laws = combine({"a", 1.0, &kSoft}, {"b", 0.6, &kHard}, &rail);
  EXPECT_EQ(value(laws, "friction"), 0.1);
  EXPECT_EQ(source(laws, "friction"), "volcontact/pair/rail");
  EXPECT_DOUBLE_EQ(value(laws, "stiffness"), 0.75e6);
}

TEST(Materials, DefaultMaterialTakesFrictionFromTheGeom) {
  const PairLaws laws = combine({"a", 0.4, nullptr}, {"b", 0.9, nullptr}, nullptr);
  EXPECT_EQ(value(laws, "friction"), 0.9);
  EXPECT_EQ(value(laws, "stiffness"), 0.5 * HuntCrossley::Params{}.stiffness);
  EXPECT_EQ(value(laws, "damping"), 1.0);
  EXPECT_STREQ(laws.laws.normal->name(), "hunt_crossley");
  EXPECT_STREQ(laws.laws.friction->name(), "regularized_coulomb");
  EXPECT_TRUE(laws.laws.rolling);
}

TEST(Materials, LawNamedByOneSideServesBoth) {
  KeyedValues spring = kHard;
  spring.values.erase("damping");
  spring.choices["normal_law"] = "volume_spring";
  const PairLaws laws = combine({"a", 1.0, &kSoft}, {"b", 0.6, &spring}, nullptr);
  EXPECT_STREQ(laws.laws.normal->name(), "volume_spring");
  EXPECT_TRUE(
      testing::contains(laws.warnings.at(0), "volcontact/material/soft/damping is not used"));
}

TEST(Materials, DifferentLawsNeedThePairToChoose) {
  KeyedValues spring{"volcontact/material/spring", {}, {{"normal_law", "volume_spring"}}};
  KeyedValues damped{"volcontact/material/damped", {}, {{"normal_law", "hunt_crossley"}}};
  const std::string text =
      testing::message_of([&] { combine({"peg", 1.0, &spring}, {"hole", 1.0, &damped}, nullptr); });
  EXPECT_EQ(text,
            "geoms 'peg' and 'hole': volcontact/material/spring has normal_law/volume_spring and "
            "volcontact/material/damped has normal_law/hunt_crossley; choose one in a "
            "volcontact/pair/<name> that lists the two");
  const KeyedValues pair{"volcontact/pair/p", {}, {{"normal_law", "volume_spring"}}};
  EXPECT_STREQ(combine({"peg", 1.0, &spring}, {"hole", 1.0, &damped}, &pair).laws.normal->name(),
               "volume_spring");
}

TEST(Materials, RollingIsOffWhenEitherSideSaysSo) {
  const KeyedValues smooth{"volcontact/material/smooth", {}, {{"rolling", "off"}}};
  const KeyedValues rough{"volcontact/material/rough", {}, {{"rolling", "on"}}};
  EXPECT_FALSE(combine({"a", 1.0, &smooth}, {"b", 1.0, nullptr}, nullptr).laws.rolling);
  EXPECT_FALSE(combine({"a", 1.0, &rough}, {"b", 1.0, &smooth}, nullptr).laws.rolling);
  const KeyedValues pair{"volcontact/pair/p", {}, {{"rolling", "on"}}};
  EXPECT_TRUE(combine({"a", 1.0, &rough}, {"b", 1.0, &smooth}, &pair).laws.rolling);
}

TEST(Materials, CouplingReachesTheLaw) {
  const KeyedValues plain{"volcontact/material/plain", {}, {{"coupling", "none"}}};
  EXPECT_EQ(combine({"a", 1.0, &plain}, {"b", 1.0, nullptr}, nullptr).choices.at("coupling"),
            "none");
  EXPECT_EQ(combine({"a", 1.0, nullptr}, {"b", 1.0, nullptr}, nullptr).choices.at("coupling"),
            "ellipsoid");
}

}  // namespace
}  // namespace volcontact::adaptor
