// SPDX-License-Identifier: Apache-2.0
// The option volcontact/option/formulation in a scene.
#include <gtest/gtest.h>

#include "adaptor/scene/scene_contact.h"
#include "adaptor/support/models.h"

namespace volcontact::adaptor::formulation_test {
namespace {

using testing::ModelPointer;

std::string scene(const std::string& table, const std::string& thing,
                  const std::string& custom = "") {
  return "<mujoco><asset><mesh name='tetrahedron' vertex='0 0 0  1 0 0  0 1 0  0 0 1'/></asset>"
         "<worldbody><geom name='table' " +
         table + "/><body pos='0 0 1.1'><freejoint/><geom name='thing' " + thing +
         " mass='1'/></body></worldbody>" +
         testing::numeric("volcontact/option/formulation/potential", "1") + custom + "</mujoco>";
}

TEST(Formulation, PotentialServesEveryPairOfGeoms) {
  const std::string box = "type='box' size='1 1 1'", egg = "type='ellipsoid' size='.1 .2 .1'",
                    mesh = "type='mesh' mesh='tetrahedron'";
  for (const std::string& table : {box, egg, mesh}) {
    for (const std::string& thing : {box, egg, mesh}) {
      const ModelPointer m = testing::load(scene(table, thing));
      EXPECT_EQ(SceneContact(m.get()).pair(1).model.laws().formulation, Formulation::kPotential);
    }
  }
}

TEST(Formulation, PotentialRefusesAPairByItsGeomsAndSaysWhy) {
  // Two ellipsoids composed have neither layers nor faces, nor has a third one.
  const std::string two =
      "<custom><tuple name='volcontact/solid/two'>"
      "<element objtype='geom' objname='table' prm='1'/>"
      "<element objtype='geom' objname='knob' prm='1'/></tuple></custom>";
  const std::string knob =
      "type='ellipsoid' size='1 1 1'/>"
      "<geom name='knob' type='ellipsoid' size='.2 .3 .4' pos='1 0 0'";
  const ModelPointer m = testing::compile(scene(knob, "type='ellipsoid' size='.1 .2 .1'", two));
  const std::string message = testing::message_of([&] { SceneContact{m.get()}; });
  EXPECT_NE(message.find("formulation/potential does not serve geoms 'table' and 'thing'"),
            std::string::npos)
      << message;
  EXPECT_NE(message.find("neither has layers"), std::string::npos) << message;
}

TEST(Formulation, SoftBodyTakesTheLargerShareOfTheCompliance) {
  const std::string tuple = "<tuple name='volcontact/material/";
  const ModelPointer m = testing::load(
      "<mujoco><worldbody><geom name='table' type='box' size='1 1 1'/><body pos='0 0 1.1'>"
      "<freejoint/><geom name='thing' type='box' size='.1 .1 .1'/></body></worldbody><custom>"
      "<numeric name='volcontact/material/hard/stiffness' data='3e7'/>" +
      tuple + "hard'><element objtype='geom' objname='table'/></tuple>" +
      "<numeric name='volcontact/material/soft/stiffness' data='1e7'/>" + tuple +
      "soft'><element objtype='geom' objname='thing'/></tuple></custom></mujoco>");
  // Geom a is the table: k_v / k_a = (3 * 1 / 4) / 3.
  EXPECT_DOUBLE_EQ(SceneContact(m.get()).pair(1).model.laws().share_of_a, 0.25);
}

}  // namespace
}  // namespace volcontact::adaptor::formulation_test
