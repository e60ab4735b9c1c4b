// SPDX-License-Identifier: Apache-2.0
#include "adaptor/geoms/native_pairs.h"

#include <gtest/gtest.h>

#include "adaptor/scene/scene_contact.h"
#include "adaptor/scene_registry.h"
#include "adaptor/support/models.h"

namespace volcontact::adaptor::native_pairs_test {
namespace {

// A box of 1 kg, pressed on a floor by its weight and pushed at 1 m/s along x; geoms of friction 1.
std::string scene(const std::string& pair, const std::string& custom = "",
                  const std::string& geom = "") {
  return "<mujoco><option timestep=\"1e-3\"/><worldbody>"
         "<geom name=\"floor\" type=\"plane\" size=\"9 9 1\"/>"
         "<body pos=\"0 0 .1\"><freejoint/><geom name=\"crate\" type=\"box\" size=\".1 .1 .1\" "
         "mass=\"1\" " +
         geom + "/></body></worldbody><contact>" + pair + "</contact>" + custom + "</mujoco>";
}

std::string pair(const std::string& attributes) {
  return "<pair geom1=\"floor\" geom2=\"crate\" " + attributes + "/>";
}

std::vector<std::string> unused(const std::string& attributes, const std::string& geom = "") {
  return native_pair_fields_unused(testing::compile(scene(pair(attributes), "", geom)).get(), 0);
}

// Distance that a sliding box goes until it stands, by Coulomb: v^2 / (2 mu g).
double way(const std::string& mjcf) {
  const testing::ModelPointer m = testing::load(mjcf);
  const testing::DataPointer d = testing::make_data(m);
  const testing::Attached attached(m);
  d->qvel[0] = 1.0;
  for (int i = 0; i < 1500; ++i) mj_step(m.get(), d.get());
  return d->qpos[0];
}

TEST(NativePairs, FrictionOfAPairCountsAsThatOfItsGeoms) {
  const double at_tenth = 1.0 / (2.0 * 0.1 * 9.81), at_half = 1.0 / (2.0 * 0.5 * 9.81);
  EXPECT_NEAR(way(scene(pair("friction=\".1 .1 .005 .0001 .0001\""))), at_tenth, 0.02 * at_tenth);
  // A material's own friction comes before either.
  const std::string wood = testing::material("wood", {{"friction", "0.5"}}, {"crate", "floor"});
  EXPECT_NEAR(way(scene(pair("friction=\".1 .1 .005 .0001 .0001\""), wood)), at_half,
              0.02 * at_half);
}

TEST(NativePairs, TheDescriptionSaysWhoseFrictionItIs) {
  const testing::ModelPointer m =
      testing::compile(scene(pair("name=\"slippery\" friction=\".1 .1 .005 .0001 .0001\"")));
  const SceneContact contact(m.get());
  ASSERT_EQ(contact.rules().count(), 1u);
  const GeomPair pair = contact.rules().named().front();
  for (const PairField& field : contact.laws().in_words(m.get(), pair).fields) {
    if (field.name != "friction") continue;
    EXPECT_EQ(field.value, std::vector<double>{0.1});
    EXPECT_TRUE(testing::contains(field.source, "friction of <pair> 'slippery'"));
  }
}

TEST(NativePairs, FrictionChangedInACompiledModelIsInForce) {
  const testing::ModelPointer m = testing::load(scene(pair("friction=\".1 .1 .005 .0001 .0001\"")));
  const testing::Attached attached(m);
  m->pair_friction[0] = m->pair_friction[1] = 0.3;
  const SceneContact* contact = contact_of(m.get());
  ASSERT_NE(contact, nullptr);
  const GeomPair named = contact->rules().named().front();
  for (const PairField& field : contact->laws().in_words(m.get(), named).fields) {
    if (field.name == "friction") {
      EXPECT_EQ(field.value, std::vector<double>{0.3});
    }
  }
}

TEST(NativePairs, FieldsThatTheGeomsHaveAreNotNamed) {
  EXPECT_TRUE(unused("").empty());
  EXPECT_TRUE(
      unused("", "solref=\"-1000 -10\" condim=\"6\" margin=\".01\" priority=\"1\"").empty());
  EXPECT_TRUE(unused("friction=\".1 .1 .005 .0001 .0001\"").empty());
}

TEST(NativePairs, FieldsWithoutAMeaningAreNamed) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(unused("condim=\"6\""), Names{"condim"});
  EXPECT_EQ(unused("solref=\"-1000 -10\""), Names{"solref"});
  EXPECT_EQ(unused("solimp=\".5 .6 .01 .5 2\""), Names{"solimp"});
  EXPECT_EQ(unused("margin=\".02\""), Names{"margin"});
  EXPECT_EQ(unused("margin=\".02\" gap=\".01\""), (Names{"margin", "gap"}));
  EXPECT_EQ(unused("friction=\".1 .2 .005 .0001 .0001\""),
            Names{"friction[1], across the first direction"});
  EXPECT_EQ(unused("friction=\".1 .1 .5 .1 .1\""),
            (Names{"friction[2], of spin", "friction[3] and [4], of rolling"}));
  const testing::ModelPointer m =
      testing::compile(scene(pair("name=\"p\" condim=\"6\" margin=\".02\"")));
  const std::vector<std::string> warnings = SceneContact(m.get()).warnings();
  EXPECT_NE(std::find(warnings.begin(), warnings.end(),
                      "<pair> 'p': condim, margin have no meaning under volumetric contact; of a "
                      "<pair> its sliding friction counts"),
            warnings.end());
}

}  // namespace
}  // namespace volcontact::adaptor::native_pairs_test
