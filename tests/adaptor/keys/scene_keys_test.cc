// SPDX-License-Identifier: Apache-2.0
#include "adaptor/keys/scene_keys.h"

#include <gtest/gtest.h>

#include <random>

#include "adaptor/support/models.h"

namespace volcontact::adaptor::scene_keys_test {
namespace {

// Two free boxes and a floor; the second box has two geoms.
std::string scene(const std::string& custom) {
  return "<mujoco><worldbody><geom name=\"floor\" type=\"plane\" size=\"1 1 1\"/>"
         "<body name=\"crate\" pos=\"0 0 1\"><freejoint/>"
         "<geom name=\"crate\" type=\"box\" size=\".1 .1 .1\"/></body>"
         "<body name=\"parcel\" pos=\"0 0 2\"><freejoint name=\"joint\"/>"
         "<geom name=\"bottom\" type=\"box\" size=\".1 .1 .1\"/>"
         "<geom name=\"top\" type=\"box\" size=\".1 .1 .1\" pos=\"0 0 .2\"/></body>"
         "<body name=\"bare\"/></worldbody><custom>" +
         custom + "</custom></mujoco>";
}

std::string numeric(const std::string& name, const std::string& data = "1") {
  return "<numeric name=\"" + name + "\" data=\"" + data + "\"/>";
}

std::string tuple(const std::string& name,
                  const std::vector<std::pair<std::string, std::string>>& elements) {
  std::string text = "<tuple name=\"" + name + "\">";
  for (const auto& [type, object] : elements) {
    text += "<element objtype=\"" + type + "\" objname=\"" + object + "\"/>";
  }
  return text + "</tuple>";
}

SceneKeys read(const std::string& custom) {
  return read_scene_keys(testing::compile(scene(custom)).get());
}

std::string error(const std::string& custom) {
  const testing::ModelPointer m = testing::compile(scene(custom));
  return testing::message_of([&] { read_scene_keys(m.get()); });
}

const std::string kSteel =
    tuple("volcontact/material/steel", {{"geom", "crate"}, {"body", "parcel"}});

TEST(SceneKeys, SceneWithoutKeysHasDefaults) {
  const SceneKeys keys = read("");
  EXPECT_EQ(keys.options.tolerance, 1e-3);
  EXPECT_EQ(keys.options.threads, 0);
  EXPECT_EQ(keys.options.engine, Engine::kAuto);
  EXPECT_EQ(keys.options.target, Target::kApplied);
  EXPECT_EQ(keys.options.pairs, PairRule::kNative);
  EXPECT_EQ(keys.options.formulation, Formulation::kGonthier);
  EXPECT_EQ(keys.options.implicit, Implicit::kAuto);
  EXPECT_TRUE(keys.materials.empty());
  EXPECT_EQ(keys.material_of_geom, (std::vector<int>{-1, -1, -1, -1}));
}

TEST(SceneKeys, ReadsOptions) {
  const SceneKeys keys =
      read(numeric("volcontact/option/tolerance", "1e-5") +
           numeric("volcontact/option/threads", "3") + numeric("volcontact/option/engine/octree") +
           numeric("volcontact/option/target/xfrc") + numeric("volcontact/option/pairs/listed") +
           numeric("volcontact/option/formulation/potential") +
           numeric("volcontact/option/implicit/on"));
  EXPECT_EQ(keys.options.tolerance, 1e-5);
  EXPECT_EQ(keys.options.threads, 3);
  EXPECT_EQ(keys.options.engine, Engine::kOctree);
  EXPECT_EQ(keys.options.target, Target::kXfrc);
  EXPECT_EQ(keys.options.pairs, PairRule::kListed);
  EXPECT_EQ(keys.options.formulation, Formulation::kPotential);
  EXPECT_EQ(keys.options.implicit, Implicit::kAlways);
}

TEST(SceneKeys, ChoiceWithDataZeroIsNotChosen) {
  EXPECT_EQ(read(numeric("volcontact/option/target/xfrc", "0")).options.target, Target::kApplied);
}

TEST(SceneKeys, BodyInTupleMeansAllItsGeoms) {
  const SceneKeys keys = read(kSteel + numeric("volcontact/material/steel/stiffness", "2e8") +
                              numeric("volcontact/material/steel/normal_law/volume_spring"));
  ASSERT_EQ(keys.materials.size(), 1u);
  EXPECT_EQ(keys.materials[0].key, "volcontact/material/steel");
  EXPECT_EQ(keys.materials[0].values.at("stiffness"), std::vector<double>{2e8});
  EXPECT_EQ(keys.materials[0].choices.at("normal_law"), "volume_spring");
  EXPECT_EQ(keys.material_of_geom, (std::vector<int>{-1, 0, 0, 0}));
}

TEST(SceneKeys, PairOfBodiesListsAllPairsOfTheirGeoms) {
  const SceneKeys keys =
      read(tuple("volcontact/pair/stack", {{"body", "parcel"}, {"geom", "crate"}}) +
           numeric("volcontact/pair/stack/friction", "0.7"));
  ASSERT_EQ(keys.pairs.size(), 1u);
  EXPECT_EQ(keys.pairs[0].geoms, (std::vector<std::pair<int, int>>{{1, 2}, {1, 3}}));
  EXPECT_EQ(keys.pairs[0].keyed.values.at("friction"), std::vector<double>{0.7});
}

TEST(SceneKeys, PrefixSeparatesMaterials) {
  const SceneKeys keys = read(tuple("left_volcontact/material/steel", {{"geom", "crate"}}) +
                              numeric("left_volcontact/material/steel/stiffness", "1e6") +
                              tuple("right_volcontact/material/steel", {{"geom", "top"}}) +
                              numeric("right_volcontact/material/steel/stiffness", "2e6"));
  ASSERT_EQ(keys.materials.size(), 2u);
  EXPECT_EQ(keys.materials[0].key, "left_volcontact/material/steel");
  EXPECT_EQ(keys.materials[0].values.at("stiffness")[0], 1e6);
  EXPECT_EQ(keys.materials[1].values.at("stiffness")[0], 2e6);
}

TEST(SceneKeys, OptionOfTheSceneBeatsThoseOfAttachedModels) {
  const std::string attached = numeric("left_volcontact/option/tolerance", "1e-4");
  const std::string own = numeric("volcontact/option/tolerance", "1e-5");
  EXPECT_EQ(read(attached).options.tolerance, 1e-4);
  EXPECT_EQ(read(attached + own).options.tolerance, 1e-5);
  EXPECT_EQ(read(own + attached).options.tolerance, 1e-5);
  const std::string other = numeric("right_volcontact/option/tolerance", "1e-6");
  EXPECT_TRUE(testing::contains(error(attached + other), "differ; say which"));
  EXPECT_EQ(read(attached + other + own).options.tolerance, 1e-5);
}

TEST(SceneKeys, OtherNumericsAndTuplesAreNotOurs) {
  EXPECT_TRUE(
      read(numeric("my/own/number") + tuple("my/own", {{"geom", "crate"}})).numerics.empty());
}

// Every message: the key as written, what is allowed, the nearest valid spelling.

TEST(SceneKeysError, UnknownField) {
  const std::string text = error(kSteel + numeric("volcontact/material/steel/stifness", "1e8"));
  EXPECT_TRUE(testing::contains(text, "volcontact/material/steel/stifness: unknown key"));
  EXPECT_TRUE(testing::contains(text, "friction"));
  EXPECT_TRUE(testing::contains(text, "did you mean 'volcontact/material/steel/stiffness'?"));
}

TEST(SceneKeysError, UnknownOption) {
  EXPECT_TRUE(testing::contains(error(numeric("volcontact/option/tolerence", "1e-3")),
                                "did you mean 'volcontact/option/tolerance'?"));
}

TEST(SceneKeysError, UnknownSection) {
  EXPECT_TRUE(testing::contains(error(numeric("volcontact/optoin/tolerance", "1e-3")),
                                "did you mean 'volcontact/option/tolerance'?"));
  EXPECT_TRUE(testing::contains(error(tuple("volcontact/materail/steel", {{"geom", "crate"}})),
                                "did you mean 'volcontact/material/steel'?"));
}

TEST(SceneKeysError, NearlyOurFirstWord) {
  EXPECT_TRUE(testing::contains(error(numeric("volcontat/option/tolerance", "1e-3")),
                                "did you mean 'volcontact/option/tolerance'?"));
}

TEST(SceneKeysError, UnknownChoiceWord) {
  EXPECT_TRUE(testing::contains(
      error(kSteel + numeric("volcontact/material/steel/normal_law/huntcrossley")),
      "did you mean 'volcontact/material/steel/normal_law/hunt_crossley'?"));
  const std::string engine = error(numeric("volcontact/option/engine/octre"));
  EXPECT_TRUE(
      testing::contains(engine, "auto, closed_form, clip, lines, surface_sweep, columns, octree"));
  EXPECT_TRUE(testing::contains(engine, "did you mean 'volcontact/option/engine/octree'?"));
}

TEST(SceneKeysError, KeyThatGoesOnTooFar) {
  EXPECT_TRUE(testing::contains(error(kSteel + numeric("volcontact/material/steel/stiffness/x")),
                                "did you mean 'volcontact/material/steel/stiffness'?"));
  EXPECT_TRUE(testing::contains(error(numeric("volcontact/option/target/passive/x")),
                                "did you mean 'volcontact/option/target/passive'?"));
}

TEST(SceneKeysError, ValueOutOfRange) {
  EXPECT_EQ(error(kSteel + numeric("volcontact/material/steel/stiffness", "-1")),
            "volcontact/material/steel: stiffness = -1 [N/m^3] is out of range: must be > 0");
  EXPECT_TRUE(testing::contains(
      error(kSteel + numeric("volcontact/material/steel/friction", "-0.1")), "must be >= 0"));
  EXPECT_TRUE(
      testing::contains(error(numeric("volcontact/option/tolerance", "0")), "must be > 0 and < 1"));
  EXPECT_TRUE(testing::contains(error(numeric("volcontact/option/threads", "1.5")),
                                "a whole number from 0 to 1024"));
}

TEST(SceneKeysError, WrongCount) {
  EXPECT_EQ(error(kSteel + numeric("volcontact/material/steel/stiffness", "1 2")),
            "volcontact/material/steel/stiffness takes 1 number, got 2");
  EXPECT_EQ(error(numeric("volcontact/option/tolerance", "1e-3 1e-3")),
            "volcontact/option/tolerance takes 1 number, got 2");
}

TEST(SceneKeysError, ChoiceWithOtherData) {
  EXPECT_TRUE(testing::contains(error(numeric("volcontact/option/target/passive", "2")),
                                "its data must be 1"));
}

TEST(SceneKeysError, TwoWordsOfOneChoice) {
  EXPECT_TRUE(testing::contains(
      error(numeric("volcontact/option/target/passive") + numeric("volcontact/option/target/xfrc")),
      "volcontact/option/target/passive is chosen already"));
  EXPECT_TRUE(testing::contains(
      error(kSteel + numeric("volcontact/material/steel/normal_law/volume_spring") +
            numeric("volcontact/material/steel/normal_law/hunt_crossley")),
      "volcontact/material/steel/normal_law/volume_spring is chosen already"));
}

TEST(SceneKeysError, KeysWithoutTheirTuple) {
  const std::string text = error(kSteel + numeric("volcontact/material/steal/stiffness", "1e8"));
  EXPECT_TRUE(testing::contains(text, "there is no <tuple name=\"volcontact/material/steal\">"));
  EXPECT_TRUE(testing::contains(text, "did you mean 'volcontact/material/steel'?"));
}

TEST(SceneKeysError, TupleOfAnotherObjectType) {
  EXPECT_EQ(error(tuple("volcontact/material/steel", {{"joint", "joint"}})),
            "volcontact/material/steel: element 1 is a joint; a tuple takes geoms and bodies only");
}

TEST(SceneKeysError, TupleWithoutName) {
  EXPECT_TRUE(testing::contains(error(tuple("volcontact/material", {{"geom", "crate"}})),
                                "a tuple is named volcontact/material/<name>"));
}

TEST(SceneKeysError, BodyWithoutGeoms) {
  EXPECT_EQ(error(tuple("volcontact/material/steel", {{"body", "bare"}})),
            "volcontact/material/steel: body 'bare' has no geoms");
}

TEST(SceneKeysError, GeomInTwoMaterials) {
  EXPECT_EQ(error(kSteel + tuple("volcontact/material/wood", {{"geom", "top"}})),
            "volcontact/material/wood: geom 'top' is listed already, in "
            "volcontact/material/steel; a geom has one material");
}

TEST(SceneKeysError, PairOfOtherThanTwo) {
  EXPECT_EQ(error(tuple("volcontact/pair/stack", {{"geom", "crate"}})),
            "volcontact/pair/stack: a pair lists exactly 2 geoms or bodies, got 1");
}

TEST(SceneKeysError, GeomsInTwoPairs) {
  EXPECT_TRUE(testing::contains(
      error(tuple("volcontact/pair/one", {{"geom", "crate"}, {"geom", "top"}}) +
            tuple("volcontact/pair/two", {{"body", "parcel"}, {"body", "crate"}})),
      "are listed already, in volcontact/pair/one"));
}

TEST(SceneKeysError, PairWithinOneRigidBody) {
  EXPECT_TRUE(
      testing::contains(error(tuple("volcontact/pair/self", {{"geom", "bottom"}, {"geom", "top"}})),
                        "parts of one rigid body"));
}

TEST(SceneKeysError, FieldOfAnotherLaw) {
  EXPECT_EQ(error(kSteel + numeric("volcontact/material/steel/normal_law/volume_spring") +
                  numeric("volcontact/material/steel/damping", "1")),
            "volcontact/material/steel/damping: volume_spring has no such field; it has stiffness");
}

TEST(SceneKeysError, KeyThatEndsBeforeItsName) {
  for (const std::string section : {"material", "pair", "shape"}) {
    const std::string text = error(numeric("volcontact/" + section));
    EXPECT_TRUE(testing::contains(text, "volcontact/" + section + ": unknown key; after "));
    EXPECT_TRUE(testing::contains(text, "comes a name, then '/' and one of "));
  }
}

// Keys of every length, whole, cut short, with a part left out, doubled, or misspelt: each is read
// or refused by a message that names it.
TEST(SceneKeysError, AnyKeyIsReadOrRefused) {
  const testing::ModelPointer m = testing::compile(
      scene(kSteel + tuple("volcontact/pair/stack", {{"geom", "crate"}, {"geom", "top"}})));
  const std::vector<std::string> words{"",        "material",      "pair",  "shape",     "solid",
                                       "option",  "steel",         "stack", "geom",      "/",
                                       "=",       "hunt_crossley", "torus", "stiffness", "target",
                                       "passive", "STEEL",         "\xff",  "volcontact"};
  std::mt19937 random(7);
  const auto below = [&](std::size_t n) { return random() % n; };
  int refused = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string name = below(8) ? "volcontact/" : "robot_volcontact/";
    for (std::size_t part = 0, parts = below(6); part < parts; ++part) {
      name += (part ? "/" : "") + words[below(words.size())];
    }
    name.resize(name.size() - (below(4) ? 0 : below(name.size() - 1)));
    const std::vector<double> numbers(below(4), below(2) ? 1.0 : -1e308);
    const std::string text =
        testing::message_of([&] { read_scene_keys(m.get(), {{name, numbers}}); });
    if (text.empty()) continue;
    ++refused;
    EXPECT_TRUE(testing::contains(text, name.substr(0, name.find("volcontact") + 5)));
  }
  EXPECT_GT(refused, 10000);
}

TEST(SceneKeysError, TextIsNotRead) {
  EXPECT_TRUE(testing::contains(error("<text name=\"volcontact/option/engine\" data=\"octree\"/>"),
                                "is a <text>; volcontact reads <numeric> and <tuple>"));
}

}  // namespace
}  // namespace volcontact::adaptor::scene_keys_test
