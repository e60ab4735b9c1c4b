// SPDX-License-Identifier: Apache-2.0
// The option volcontact/option/formulation in a scene.
#include <gtest/gtest.h>

#include "adaptor/scene_contact.h"
#include "adaptor/support/models.h"

namespace volcontact::adaptor {
namespace {

using testing::ModelPointer;

TEST(Formulation, PotentialRefusesAPairByItsGeoms) {
  const auto scene = [](const std::string& size) {
    return "<mujoco><worldbody><geom name='table' type='box' size='1 1 1'/><body pos='0 0 1.1'>"
           "<freejoint/><geom name='thing' " +
           size + "/></body></worldbody>" +
           testing::numeric("volcontact/option/formulation/potential", "1") + "</mujoco>";
  };
  const ModelPointer boxes = testing::load(scene("type='box' size='.1 .1 .1'"));
  EXPECT_EQ(SceneContact(boxes.get()).pairs()[0].laws.laws.formulation, Formulation::kPotential);
  const ModelPointer ball = testing::compile(scene("type='sphere' size='.1'"));
  const std::string message = testing::message_of([&] { SceneContact{ball.get()}; });
  EXPECT_NE(message.find("formulation/potential does not serve geoms 'table' and 'thing'"),
            std::string::npos)
      << message;
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
