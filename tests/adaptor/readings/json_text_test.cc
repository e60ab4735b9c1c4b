// SPDX-License-Identifier: Apache-2.0
#include "adaptor/readings/json_text.h"

#include <gtest/gtest.h>

#include <limits>

namespace volcontact::adaptor::json_text_test {
namespace {

TEST(JsonText, NestsAndSeparates) {
  JsonText json;
  json.begin_object().member("a", 1).name("b").begin_array().value(0.5).value("x").end_array();
  json.member("c", true).name("d").begin_object().end_object().member("e", 2).end_object();
  EXPECT_EQ(json.text(), R"({"a":1,"b":[0.5,"x"],"c":true,"d":{},"e":2})");
}

TEST(JsonText, EscapesWhatAStringMustNotHold) {
  JsonText json;
  json.value("a\"b\\c\nd");
  EXPECT_EQ(json.text(), "\"a\\\"b\\\\c\\u000ad\"");
}

TEST(JsonText, NumbersReadBackExactly) {
  JsonText json;
  json.value(0.1);
  EXPECT_EQ(std::stod(json.text()), 0.1);
}

TEST(JsonText, NonFiniteNumberIsNull) {
  JsonText json;
  json.value(std::numeric_limits<double>::infinity());
  EXPECT_EQ(json.text(), "null");
}

TEST(JsonText, OneNumberIsNoArray) {
  JsonText json;
  json.begin_array().value(std::vector<double>{2.0}).value(std::vector<double>{1.0, 2.0});
  json.end_array();
  EXPECT_EQ(json.text(), "[2,[1,2]]");
}

}  // namespace
}  // namespace volcontact::adaptor::json_text_test
