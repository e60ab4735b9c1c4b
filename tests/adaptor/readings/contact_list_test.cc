// SPDX-License-Identifier: Apache-2.0
#include "adaptor/readings/contact_list.h"

#include <gtest/gtest.h>

#include "adaptor/support/models.h"

namespace volcontact::adaptor::contact_list_test {
namespace {

using testing::DataPointer;
using testing::ModelPointer;

// Two balls on a floor, the left one listed; a touch sensor under each and one beside.
const std::string kScene =
    "<mujoco><worldbody><geom name=\"floor\" type=\"plane\" size=\"1 1 1\"/>"
    "<body pos=\"0 0 .049\"><freejoint/><geom name=\"left\" type=\"sphere\" size=\".05\"/>"
    "<site name=\"a\" size=\".01\" pos=\"0 0 -.055\"/><site name=\"c\" size=\".01\" pos=\".05 0 "
    "0\"/>"
    "</body><body pos=\".3 0 .049\"><freejoint/><geom name=\"right\" type=\"sphere\" "
    "size=\".05\"/><site name=\"b\" size=\".01\" pos=\"0 0 -.055\"/></body></worldbody>"
    "<sensor><touch site=\"a\"/><touch site=\"b\"/><touch site=\"c\"/></sensor>"
    "<custom><numeric name=\"volcontact/option/pairs/listed\" data=\"1\"/>"
    "<tuple name=\"volcontact/pair/p\"><element objtype=\"geom\" objname=\"floor\"/>"
    "<element objtype=\"geom\" objname=\"left\"/></tuple></custom></mujoco>";

class ContactList : public ::testing::Test {
 protected:
  ContactList() : m(testing::load(kScene)), d(testing::make_data(m)) {}
  ModelPointer m;
  DataPointer d;
};

TEST_F(ContactList, HasOursThenMuJoCosWithForcesOnTheFloorDownwards) {
  const testing::Attached attached(m);
  mj_forward(m.get(), d.get());
  volcontact_contact contacts[4];
  ASSERT_EQ(volcontact_contacts(m.get(), d.get(), contacts, 4), 2);
  EXPECT_EQ(contacts[0].is_native, 0);
  EXPECT_EQ(contacts[1].is_native, 1);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(contacts[i].geom_a, 0);
    EXPECT_EQ(contacts[i].geom_b, i + 1);
    EXPECT_NEAR(contacts[i].normal[2], -1.0, 1e-12);
    EXPECT_LT(contacts[i].force[2], 0.0);
    EXPECT_NEAR(contacts[i].force[2], -contacts[i].normal_force, 1e-9);
    EXPECT_NEAR(contacts[i].position[0], 0.3 * i, 1e-12);
  }
  // The forces that act on the balls.
  EXPECT_NEAR(contacts[0].force[2], -d->qfrc_applied[2], 1e-9);
  EXPECT_NEAR(contacts[1].force[2], -d->qfrc_constraint[8], 1e-9);
  EXPECT_EQ(volcontact_contacts(m.get(), d.get(), nullptr, 0), 2);
}

TEST_F(ContactList, TouchSensorsGetWhatIsInTheirZone) {
  const testing::Attached attached(m);
  mj_forward(m.get(), d.get());
  const double native = d->sensordata[1];
  EXPECT_EQ(d->sensordata[0], 0.0);
  EXPECT_GT(native, 0.0);
  ASSERT_EQ(volcontact_update_touch(m.get(), d.get()), 0);
  EXPECT_NEAR(d->sensordata[0], d->qfrc_applied[2], 1e-9);
  EXPECT_NEAR(d->sensordata[1], native, 1e-12 * native);
  EXPECT_EQ(d->sensordata[2], 0.0);
}

TEST_F(ContactList, ModelThatIsNotAttachedIsAnError) {
  EXPECT_EQ(volcontact_contacts(m.get(), d.get(), nullptr, 0), VOLCONTACT_ERROR_STATE);
  EXPECT_EQ(volcontact_update_touch(m.get(), d.get()), VOLCONTACT_ERROR_STATE);
}

}  // namespace
}  // namespace volcontact::adaptor::contact_list_test
