// SPDX-License-Identifier: Apache-2.0
#include "volcontact/base/fields.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace volcontact::fields_test {
namespace {

// A component with one field of each kind.
struct Brick {
  static constexpr const char* kName = "brick";
  struct Params {
    double mass = 2.0;
    Vec3 sizes = Vec3(0.1, 0.2, 0.3);
    double share = 0.5;
  };
  static constexpr std::array kFields{
      Field<Params>{"mass", "kg", &Params::mass, kPositive, "its mass"},
      Field<Params>{"sizes", "m", &Params::sizes, kNonNegative, "its sizes"},
      Field<Params>{"share", "-", &Params::share, kZeroToOne, "its share"}};
};

std::string message_of(const FieldValues& values) {
  try {
    params_from<Brick>(values);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Fields, NamesStandInOrder) {
  EXPECT_EQ(field_names<Brick>(), (std::vector<std::string>{"mass", "sizes", "share"}));
}

TEST(Fields, ParametersByNameKeepTheOtherDefaults) {
  const Brick::Params params = params_from<Brick>({{"sizes", {1.0, 2.0, 3.0}}});
  EXPECT_EQ(params.sizes, Vec3(1, 2, 3));
  EXPECT_EQ(params.mass, 2.0);
}

TEST(Fields, ValuesOfIsTheInverse) {
  const FieldValues values{{"mass", {7.0}}, {"share", {0.25}}, {"sizes", {1.0, 0.0, 3.0}}};
  EXPECT_EQ(values_of<Brick>(params_from<Brick>(values)), values);
}

TEST(Fields, ErrorsNameComponentFieldUnitValueAndRange) {
  EXPECT_EQ(message_of({{"mass", {-1.0}}}), "brick: mass = -1 [kg] is out of range: must be > 0");
  EXPECT_EQ(message_of({{"sizes", {1.0, -2.0, 1.0}}}),
            "brick: sizes = -2 [m] is out of range: must be >= 0");
  EXPECT_EQ(message_of({{"share", {1.5}}}),
            "brick: share = 1.5 [-] is out of range: must be 0 to 1");
}

TEST(Fields, ErrorsNameWrongCountsAndUnknownNames) {
  EXPECT_EQ(message_of({{"sizes", {1.0, 2.0}}}), "brick: sizes takes 3 numbers, got 2");
  EXPECT_EQ(message_of({{"mass", {}}}), "brick: mass takes 1 number, got 0");
  EXPECT_EQ(message_of({{"sise", {1.0}}}), "brick has no field 'sise' (did you mean 'sizes'?)");
  EXPECT_EQ(message_of({{"colour", {1.0}}}), "brick has no field 'colour'");
}

TEST(Range, OpenAndClosedEnds) {
  EXPECT_FALSE(kPositive.contains(0.0));
  EXPECT_TRUE(kPositive.contains(5e-324));
  EXPECT_TRUE(kNonNegative.contains(0.0));
  EXPECT_TRUE(kZeroToOne.contains(0.0));
  EXPECT_TRUE(kZeroToOne.contains(1.0));
  EXPECT_FALSE(kZeroToOne.contains(std::nextafter(1.0, 2.0)));
  EXPECT_TRUE(kAnyNumber.contains(-1e308));
}

TEST(Range, NeverInfiniteOrNotANumber) {
  for (const Range& range : {kPositive, kNonNegative, kAnyNumber}) {
    EXPECT_FALSE(range.contains(kInfinity));
    EXPECT_FALSE(range.contains(-kInfinity));
    EXPECT_FALSE(range.contains(std::nan("")));
  }
}

}  // namespace
}  // namespace volcontact::fields_test
