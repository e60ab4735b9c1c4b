// SPDX-License-Identifier: Apache-2.0
#include "volcontact/base/disjoint_sets.h"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace volcontact::disjoint_sets_test {
namespace {

TEST(DisjointSets, EveryNumberBeginsAlone) {
  std::vector<int> parent = {7, 7, 7, 7};
  make_sets(parent, 3);
  ASSERT_EQ(parent.size(), 3u);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(root_of(parent, i), i);
}

// Beside labels that are all rewritten at each step.
TEST(DisjointSets, TheLeastNumberIsTheRootWhateverTheOrder) {
  std::mt19937 random(1);
  constexpr int kCount = 200;
  std::uniform_int_distribution<int> any(0, kCount - 1);
  std::vector<int> parent, label(kCount);
  make_sets(parent, kCount);
  for (int i = 0; i < kCount; ++i) label[i] = i;
  for (int step = 0; step < 150; ++step) {
    const int i = any(random), j = any(random);
    join_sets(parent, i, j);
    const int low = std::min(label[i], label[j]), high = std::max(label[i], label[j]);
    for (int& l : label) l = l == high ? low : l;
    for (int k = 0; k < kCount; ++k) ASSERT_EQ(root_of(parent, k), label[k]) << step;
  }
}

}  // namespace
}  // namespace volcontact::disjoint_sets_test
