// SPDX-License-Identifier: Apache-2.0
#include "adaptor/memory/side_states.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace volcontact::adaptor::side_states_test {
namespace {

// Addresses stand for data; nothing is read there.
const mjData* address(int i) {
  static const std::vector<char> bytes(1000);
  return reinterpret_cast<const mjData*>(&bytes[static_cast<std::size_t>(i)]);
}

TEST(SideStates, BlocksBeginWithZerosAndAreKeptApart) {
  SideStates states;
  double* a = states.end_of(address(0), 3);
  double* b = states.end_of(address(1), 3);
  for (int i = 1; i <= 3; ++i) {
    EXPECT_EQ(a[-i], 0.0);
    a[-i] = i;
    b[-i] = 10.0 * i;
  }
  EXPECT_EQ(states.end_of(address(0), 3), a);
  for (int i = 1; i <= 3; ++i) EXPECT_EQ(a[-i], i);
}

TEST(SideStates, BlockThatGrowsKeepsItsLastNumbers) {
  SideStates states;
  for (int i = 1; i <= 3; ++i) states.end_of(address(0), 3)[-i] = i;
  for (int i = 1; i <= 3; ++i) EXPECT_EQ(states.end_of(address(0), 8)[-i], i);
  EXPECT_EQ(states.end_of(address(0), 8)[-8], 0.0);
  EXPECT_EQ(states.end_of(address(0), 3)[-3], 3.0);  // a smaller one is at the same place
}

TEST(SideStates, ThreadsHaveDataOfTheirOwn) {
  SideStates states;
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&states, t] {
      for (int i = 0; i < 1000; ++i) states.end_of(address(10 * t + i % 10), 4)[-1] += 1.0;
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (int i = 0; i < 80; ++i) EXPECT_EQ(states.end_of(address(i), 4)[-1], 100.0);
}

}  // namespace
}  // namespace volcontact::adaptor::side_states_test
