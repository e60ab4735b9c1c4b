// SPDX-License-Identifier: Apache-2.0
#include "adaptor/keys/materials.h"

#include <gtest/gtest.h>

#include <cmath>

#include "adaptor/support/models.h"
#include "volcontact/force/hunt_crossley.h"

namespace volcontact::adaptor::materials_test {
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

TEST(Materials, StiffnessesToTheEndOfTheirRangeAreInSeries) {
  const KeyedValues rigid{"volcontact/material/rigid", {{"stiffness", {1e308}}}, {}};
  const PairLaws laws = combine({"a", 1.0, &rigid}, {"b", 0.6, &rigid}, nullptr);
  EXPECT_EQ(value(laws, "stiffness"), 0.5e308);
  EXPECT_EQ(laws.laws.share_of_a, 0.5);
}

TEST(Materials, WhatTwoMaterialsMakeOutOfRangeNamesThem) {
  const KeyedValues soft{"volcontact/material/soft", {{"stiffness", {5e-324}}}, {}};
  EXPECT_TRUE(testing::contains(
      testing::message_of([&] { combine({"a", 1.0, &soft}, {"b", 0.6, &soft}, nullptr); }),
      "geoms 'a' and 'b', of volcontact/material/soft and volcontact/material/soft: hunt_crossley: "
      "stiffness = 0"));
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
  EXPECT_STREQ(laws.laws.friction->name(), "elastic_coulomb");
  EXPECT_TRUE(laws.laws.rolling);
}

TEST(Materials, AFieldOfOneLawSaysWhichIsMeant) {
  const auto law_with = [](const char* field, double value) {
    const KeyedValues material{"volcontact/material/m", {{field, {value}}}, {}};
    return combine({"a", 1.0, &material}, {"b", 1.0, nullptr}, nullptr).friction_law;
  };
  EXPECT_EQ(law_with("friction", 0.3), "elastic_coulomb");
  EXPECT_EQ(law_with("tangential_ratio", 0.5), "elastic_coulomb");
  EXPECT_EQ(law_with("slip_speed", 1e-3), "regularized_coulomb");
  EXPECT_EQ(law_with("static_friction", 0.5), "bristle");
  const KeyedValues slip{"volcontact/material/s", {{"slip_speed", {1e-3}}}, {}};
  const KeyedValues rest{"volcontact/material/r", {{"static_friction", {0.5}}}, {}};
  const PairLaws both = combine({"a", 1.0, &slip}, {"b", 1.0, &rest}, nullptr);
  EXPECT_EQ(both.friction_law, "elastic_coulomb");  // no law has both, so the default, in words
  EXPECT_EQ(both.warnings.size(), 2u);
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

// Restitutions combine as the dampings A / v_i they stand for: (kB AA + kA AB) / (kA + kB). The
// numbers A of e = 0.9 and 0.5 are those of docs/theory.md, "Restitution"; with kB = 3 kA the mean
// is (3 * 0.16648 + 1.43275) / 4 = 0.48305, whose e solves ln((1+A)/(1-eA)) = A (1+e).
TEST(Materials, RestitutionsCombineAsDampings) {
  const KeyedValues a{"volcontact/material/a", {{"stiffness", {1e6}}, {"restitution", {0.9}}}, {}};
  const KeyedValues b{"volcontact/material/b", {{"stiffness", {3e6}}, {"restitution", {0.5}}}, {}};
  const double e = value(combine({"a", 1.0, &a}, {"b", 1.0, &b}, nullptr), "restitution");
  const double A = 0.48305;
  EXPECT_NEAR(std::log((1.0 + A) / (1.0 - e * A)), A * (1.0 + e), 2e-6);
  // Two equal ones stay.
  EXPECT_NEAR(value(combine({"a", 1.0, &a}, {"b", 1.0, &a}, nullptr), "restitution"), 0.9, 1e-12);
}

TEST(Materials, RestitutionOfOneSideHoldsForThePairInPlaceOfDamping) {
  const KeyedValues a{"volcontact/material/a", {{"restitution", {0.7}}}, {}};
  const PairLaws laws = combine({"a", 1.0, &a}, {"b", 1.0, nullptr}, nullptr);
  EXPECT_NEAR(value(laws, "restitution"), 0.7, 1e-12);
  EXPECT_EQ(value(laws, "damping"), 0.0);
  // A pair may go back to damping.
  const KeyedValues pair{"volcontact/pair/p", {{"damping", {0.3}}}, {}};
  const PairLaws damped = combine({"a", 1.0, &a}, {"b", 1.0, nullptr}, &pair);
  EXPECT_EQ(value(damped, "restitution"), 1.0);
  EXPECT_EQ(value(damped, "damping"), 0.3);
}

TEST(Materials, DampingAgainstRestitutionNeedsThePairToChoose) {
  const KeyedValues a{"volcontact/material/a", {{"restitution", {0.7}}}, {}};
  EXPECT_TRUE(testing::contains(
      testing::message_of([&] { combine({"peg", 1.0, &a}, {"hole", 1.0, &kSoft}, nullptr); }),
      "geoms 'peg' and 'hole': one of their materials gives damping and one restitution"));
}

TEST(Materials, StaticFrictionIsNeverBelowTheKineticOne) {
  KeyedValues sticky{
      "volcontact/material/sticky", {{"friction", {0.3}}}, {{"friction_law", "bristle"}}};
  const Side other{"b", 0.2, nullptr};
  EXPECT_EQ(value(combine({"a", 1.0, &sticky}, other, nullptr), "static_friction"), 0.3);
  sticky.values["static_friction"] = {0.45};
  EXPECT_EQ(value(combine({"a", 1.0, &sticky}, other, nullptr), "static_friction"), 0.45);
  const KeyedValues rough{"volcontact/pair/rough", {{"friction", {0.8}}}, {}};
  EXPECT_EQ(value(combine({"a", 1.0, &sticky}, other, &rough), "static_friction"), 0.8);
}

}  // namespace
}  // namespace volcontact::adaptor::materials_test
