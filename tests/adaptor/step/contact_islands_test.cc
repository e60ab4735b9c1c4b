// SPDX-License-Identifier: Apache-2.0
#include "adaptor/step/contact_islands.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "adaptor/support/models.h"

namespace volcontact::adaptor::contact_islands_test {
namespace {

using testing::ModelPointer;

ContactPlace place(int a, int b) { return {a, b, Vec3::Zero(), Mat3::Identity()}; }

// Bodies 1 ... count, each with a free joint; the last one carries a hinged body, count + 1.
ModelPointer free_bodies(int count) {
  std::string bodies;
  for (int i = 0; i < count; ++i) {
    bodies += "<body><freejoint/><geom size=\".1\"/>";
    if (i == count - 1) bodies += "<body><joint/><geom size=\".1\"/></body>";
    bodies += "</body>";
  }
  return testing::compile(
      "<mujoco><worldbody><geom name=\"floor\" type=\"plane\" size=\"1 1 1\"/>" + bodies +
      "</worldbody></mujoco>");
}

std::vector<int> places_of(const ContactIslands& islands, int island) {
  const auto places = islands.places(island);
  return {places.begin(), places.end()};
}

TEST(ContactIslands, WhatDoesNotMoveJoinsNothing) {
  const ModelPointer m = free_bodies(4);
  const std::vector<ContactPlace> places = {place(1, 0), place(3, 0), place(2, 1), place(0, 5)};
  ContactIslands islands;
  islands.build(m.get(), places);
  ASSERT_EQ(islands.count(), 3);
  EXPECT_EQ(places_of(islands, 0), (std::vector<int>{0, 2}));
  EXPECT_EQ(places_of(islands, 1), (std::vector<int>{1}));
  EXPECT_EQ(places_of(islands, 2), (std::vector<int>{3}));
  EXPECT_EQ(islands.trees(0).size(), 2u);
  // A hinged body is of the tree of the one that carries it.
  ASSERT_EQ(islands.trees(2).size(), 1u);
  EXPECT_EQ(islands.trees(2)[0].begin, 18);
  EXPECT_EQ(islands.trees(2)[0].end, 25);
  EXPECT_EQ(islands.trees_of(3), (std::pair<int, int>(-1, 0)));
  const auto [a, b] = islands.trees_of(2);
  EXPECT_EQ(a + b, 1);
}

TEST(ContactIslands, StackIsOrderedAlongItself) {
  const ModelPointer m = free_bodies(6);
  std::vector<ContactPlace> places;
  const int stack[] = {3, 6, 1, 5, 2, 4};  // on top of each other
  places.push_back(place(stack[3], stack[2]));
  places.push_back(place(stack[0], stack[1]));
  places.push_back(place(stack[4], stack[5]));
  places.push_back(place(stack[4], stack[3]));
  places.push_back(place(stack[1], stack[2]));
  places.push_back(place(0, stack[0]));
  ContactIslands islands;
  islands.build(m.get(), places);
  ASSERT_EQ(islands.count(), 1);
  EXPECT_EQ(islands.trees(0).size(), 6u);
  for (int i = 0; i < 5; ++i) {
    const auto [a, b] = islands.trees_of(i);
    EXPECT_EQ(std::abs(a - b), 1) << i;
  }
}

// Body i has degrees of freedom from 6 (i - 1) on.
TEST(ContactIslands, ConstraintsJoinTrees) {
  const ModelPointer m = free_bodies(5);
  const std::vector<ContactPlace> places = {place(1, 0), place(2, 0)};
  const std::vector<std::pair<int, int>> joined = {{0, 12}, {13, 8}, {18, 24}, {24, 30}};
  ContactIslands islands;
  islands.build(m.get(), places, joined);
  ASSERT_EQ(islands.count(), 2);  // the second one without a place
  EXPECT_EQ(places_of(islands, 0), (std::vector<int>{0, 1}));
  EXPECT_EQ(islands.trees(0).size(), 3u);
  EXPECT_TRUE(islands.places(1).empty());
  EXPECT_EQ(islands.island_of(m.get(), 8), 0);
  EXPECT_EQ(islands.island_of(m.get(), 30), 1);
  islands.build(m.get(), places);
  EXPECT_LT(islands.island_of(m.get(), 12), 0);
}

TEST(ContactIslands, IsBuiltAnewEachTime) {
  const ModelPointer m = free_bodies(3);
  const std::vector<ContactPlace> one = {place(1, 2)}, other = {place(2, 3), place(1, 0)};
  ContactIslands islands;
  islands.build(m.get(), one);
  EXPECT_EQ(islands.count(), 1);
  islands.build(m.get(), other);
  EXPECT_EQ(islands.count(), 2);
  islands.build(m.get(), {});
  EXPECT_EQ(islands.count(), 0);
}

}  // namespace
}  // namespace volcontact::adaptor::contact_islands_test
