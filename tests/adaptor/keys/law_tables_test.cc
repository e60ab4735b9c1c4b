// SPDX-License-Identifier: Apache-2.0
#include "adaptor/keys/law_tables.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "adaptor/support/models.h"
#include "volcontact/force/laws.h"

namespace volcontact::adaptor::law_tables_test {
namespace {

TEST(LawTables, FirstLawIsTheListsDefault) {
  ASSERT_EQ(normal_laws().size(), NormalLaws::kSize);
  ASSERT_EQ(friction_laws().size(), FrictionLaws::kSize);
  EXPECT_EQ(normal_laws()[0].name, HuntCrossley::kName);
}

TEST(LawTables, RowsAreTheFieldsOfTheLaw) {
  const LawRow& law = law_called(normal_laws(), "hunt_crossley");
  ASSERT_EQ(law.fields.size(), HuntCrossley::kFields.size());
  const FieldRow* stiffness = law.field("stiffness");
  ASSERT_NE(stiffness, nullptr);
  EXPECT_EQ(stiffness->unit, "N/m^3");
  EXPECT_EQ(stiffness->defaults, std::vector<double>{HuntCrossley::Params{}.stiffness});
  EXPECT_FALSE(stiffness->range.contains(0.0));
  EXPECT_EQ(law.field("friction"), nullptr);
}

TEST(LawTables, ChoicesOfLawsAreChoicesOfMaterials) {
  std::vector<std::string> names;
  for (const ChoiceRow& choice : all_choices()) names.push_back(choice.name);
  for (const char* choice : {"normal_law", "friction_law", "rolling", "coupling"}) {
    EXPECT_EQ(std::count(names.begin(), names.end(), choice), 1) << choice;
  }
}

TEST(LawTables, EveryFieldNameOnce) {
  const std::vector<std::string> names = all_field_names();
  EXPECT_EQ(std::count(names.begin(), names.end(), "stiffness"), 1);
  EXPECT_EQ(std::count(names.begin(), names.end(), "slip_speed"), 1);
}

TEST(LawTables, UnknownLawNamesTheNearest) {
  EXPECT_TRUE(
      testing::contains(testing::message_of([] { law_called(normal_laws(), "volumespring"); }),
                        "did you mean 'volume_spring'?"));
}

}  // namespace
}  // namespace volcontact::adaptor::law_tables_test
