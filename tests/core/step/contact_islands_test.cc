// SPDX-License-Identifier: Apache-2.0
#include "volcontact/step/contact_islands.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/support/free_bodies.h"

namespace volcontact::contact_islands_test {
namespace {

ContactPlace place(int a, int b) { return {a, b, Vec3::Zero(), Mat3::Identity()}; }

// Bodies 1 ... count that fly alone; on the last one hangs body count + 1 by one more degree of
// freedom.
MechanismTrees free_bodies(int count) {
  test::FreeBodies bodies;
  for (int i = 0; i < count; ++i) bodies.add(1.0, Mat3::Identity());
  MechanismTrees trees = *bodies.trees;
  trees.carrier.push_back(trees.trees.back().end - 1);
  trees.tree_of_dof.push_back(count - 1);
  trees.last_dof.push_back(trees.trees.back().end++);
  trees.tree_of_body.push_back(count - 1);
  return trees;
}

std::vector<int> places_of(const ContactIslands& islands, int island) {
  const auto places = islands.places(island);
  return {places.begin(), places.end()};
}

TEST(ContactIslands, WhatDoesNotMoveJoinsNothing) {
  const MechanismTrees trees = free_bodies(4);
  const std::vector<ContactPlace> places = {place(1, 0), place(3, 0), place(2, 1), place(0, 5)};
  ContactIslands islands;
  islands.build(trees, places);
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
  const MechanismTrees trees = free_bodies(6);
  std::vector<ContactPlace> places;
  const int stack[] = {3, 6, 1, 5, 2, 4};  // on top of each other
  places.push_back(place(stack[3], stack[2]));
  places.push_back(place(stack[0], stack[1]));
  places.push_back(place(stack[4], stack[5]));
  places.push_back(place(stack[4], stack[3]));
  places.push_back(place(stack[1], stack[2]));
  places.push_back(place(0, stack[0]));
  ContactIslands islands;
  islands.build(trees, places);
  ASSERT_EQ(islands.count(), 1);
  EXPECT_EQ(islands.trees(0).size(), 6u);
  for (int i = 0; i < 5; ++i) {
    const auto [a, b] = islands.trees_of(i);
    EXPECT_EQ(std::abs(a - b), 1) << i;
  }
}

// Body i has degrees of freedom from 6 (i - 1) on.
TEST(ContactIslands, ConstraintsJoinTrees) {
  const MechanismTrees trees = free_bodies(5);
  const std::vector<ContactPlace> places = {place(1, 0), place(2, 0)};
  const std::vector<std::pair<int, int>> joined = {{0, 12}, {13, 8}, {18, 24}, {24, 30}};
  ContactIslands islands;
  islands.build(trees, places, joined);
  ASSERT_EQ(islands.count(), 2);  // the second one without a place
  EXPECT_EQ(places_of(islands, 0), (std::vector<int>{0, 1}));
  EXPECT_EQ(islands.trees(0).size(), 3u);
  EXPECT_TRUE(islands.places(1).empty());
  EXPECT_EQ(islands.island_of(8), 0);
  EXPECT_EQ(islands.island_of(30), 1);
  islands.build(trees, places);
  EXPECT_LT(islands.island_of(12), 0);
}

TEST(ContactIslands, IsBuiltAnewEachTime) {
  const MechanismTrees trees = free_bodies(3);
  const std::vector<ContactPlace> one = {place(1, 2)}, other = {place(2, 3), place(1, 0)};
  ContactIslands islands;
  islands.build(trees, one);
  EXPECT_EQ(islands.count(), 1);
  islands.build(trees, other);
  EXPECT_EQ(islands.count(), 2);
  islands.build(trees, {});
  EXPECT_EQ(islands.count(), 0);
}

}  // namespace
}  // namespace volcontact::contact_islands_test
