// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/shapes.h"

#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>
#include <string>

namespace volcontact::shapes_test {
namespace {

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(Shapes, MadeByNameWithParameters) {
  const Shape shape = make_shape("capsule", {{"radius", {0.2}}, {"half_length", {0.7}}});
  ASSERT_TRUE(std::holds_alternative<Capsule>(shape));
  EXPECT_EQ(std::get<Capsule>(shape).radius(), 0.2);
  EXPECT_EQ(std::get<Capsule>(shape).half_length(), 0.7);
}

TEST(Shapes, EveryShapeWithATableIsMadeByItsName) {
  for_each_type(Shapes{}, [](auto tag) {
    using S = typename decltype(tag)::Type;
    if constexpr (requires { S::kFields; }) {
      const Shape shape = make_shape(S::kName, {});
      EXPECT_TRUE(std::holds_alternative<S>(shape)) << S::kName;
      EXPECT_STREQ(name_of(shape), S::kName);
    }
  });
}

TEST(Shapes, VectorParameterIsRead) {
  const Shape shape = make_shape("box", {{"half_sizes", {0.1, 0.2, 0.3}}});
  EXPECT_EQ(bounds_of(shape).max, Vec3(0.1, 0.2, 0.3));
  EXPECT_NEAR(own_metrics_of(shape).volume, 8 * 0.006, 1e-16);
}

TEST(Shapes, ErrorsNameTheWordAndTheNearestValidOne) {
  EXPECT_NE(message_of([] { make_shape("cylindre", {}); }).find("did you mean 'cylinder'"),
            std::string::npos);
  EXPECT_NE(message_of([] { make_shape("sphere", {{"radis", {1.0}}}); }).find("'radius'"),
            std::string::npos);
  const std::string range = message_of([] { make_shape("sphere", {{"radius", {-1.0}}}); });
  EXPECT_NE(range.find("radius = -1 [m]"), std::string::npos) << range;
  EXPECT_NE(range.find(">= 0"), std::string::npos) << range;
  EXPECT_NE(message_of([] { make_shape("box", {{"half_sizes", {1.0}}}); }).find("takes 3 numbers"),
            std::string::npos);
}

TEST(Shapes, PolytopeIsNotMadeFromNumbers) {
  EXPECT_THROW(make_shape("convex_polytope", {}), std::invalid_argument);
}

}  // namespace
}  // namespace volcontact::shapes_test
