// SPDX-License-Identifier: Apache-2.0
#include "adaptor/geoms/bounds_tree.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <set>

namespace volcontact::adaptor::bounds_tree_test {
namespace {

Bounds box_at(const Vec3& center, const Vec3& half) {
  Bounds box;
  for (int i = 0; i < 3; ++i) box.set(i, center[i] - half[i], -(center[i] + half[i]));
  return box;
}

// Against each box by itself, with some that have no ends or no numbers.
TEST(BoundsTree, FindsAllBoxesThatAreNotApart) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&](double scale) {
    return Vec3(scale * uniform(random), scale * uniform(random), scale * uniform(random));
  };
  std::size_t found = 0;
  for (const int count : {0, 1, 3, 4, 5, 17, 400}) {
    std::vector<Bounds> boxes;
    for (int i = 0; i < count; ++i) boxes.push_back(box_at(vector(1.0), vector(0.1).cwiseAbs()));
    if (count == 400) {
      boxes[7].set(1, -kInfinity, -kInfinity);
      boxes[9].set(2, std::numeric_limits<double>::quiet_NaN(), 0.0);
    }
    BoundsTree tree;
    tree.build(boxes);
    for (int trial = 0; trial < 200; ++trial) {
      const Bounds with = box_at(vector(1.2), vector(trial % 2 == 0 ? 0.05 : 0.5).cwiseAbs());
      std::set<int> visited, expected;
      tree.find(with, [&](int i) { EXPECT_TRUE(visited.insert(i).second); });
      for (int i = 0; i < count; ++i) {
        if (!are_apart(boxes[static_cast<std::size_t>(i)], with)) expected.insert(i);
      }
      for (const int i : expected) EXPECT_TRUE(visited.count(i)) << i;
      if (count == 400 && trial % 2 == 0) {
        EXPECT_LT(visited.size(), 60u);
      }
      found += expected.size();
    }
  }
  EXPECT_GT(found, 500u);
}

}  // namespace
}  // namespace volcontact::adaptor::bounds_tree_test
