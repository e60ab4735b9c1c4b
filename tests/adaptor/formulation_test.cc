// SPDX-License-Identifier: Apache-2.0
// The option volcontact/option/formulation in a scene.
#include <gtest/gtest.h>

#include "adaptor/scene_contact.h"
#include "adaptor/support/models.h"

namespace volcontact::adaptor {
namespace {

using testing::ModelPointer;

std::string scene(const std::string& table, const std::string& thing) {
  return "<mujoco><asset><mesh name='tetrahedron' vertex='0 0 0  1 0 0  0 1 0  0 0 1'/></asset>"
         "<worldbody><geom name='table' " +
         table + "/><body pos='0 0 1.1'><freejoint/><geom name='thing' " + thing +
         " mass='1'/></body></worldbody>" +
         testing::numeric("volcontact/option/formulation/potential", "1") + "</mujoco>";
}

TEST(Formulation, PotentialServesPairsWithALayer) {
  for (const char* thing : {"type='box' size='.1 .1 .1'", "type='ellipsoid' size='.1 .2 .1'",
                            "type='mesh' mesh='tetrahedron'"}) {
    const ModelPointer m = testing::load(scene("type='box' size='1 1 1'", thing));
    EXPECT_EQ(SceneContact(m.get()).pairs()[0].laws.laws.formulation, Formulation::kPotential);
  }
}

TEST(Formulation, PotentialRefusesAPairByItsGeomsAndSaysWhy) {
  const ModelPointer m =
      testing::compile(scene("type='ellipsoid' size='1 1 1'", "type='mesh' mesh='tetrahedron'"));
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
  EXPECT_DOUBLE_EQ(SceneContact(m.get()).pairs()[0].laws.laws.share_of_a, 0.25);
}

}  // namespace
}  // namespace volcontact::adaptor
