// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/mesh_columns/crossing/crossing.h"

#include <gtest/gtest.h>

#include <map>
#include <optional>

#include "core/support/matchers.h"
#include "core/support/meshes.h"
#include "core/support/random_shapes.h"
#include "volcontact/base/fields.h"
#include "volcontact/pair/mesh_columns/crossing/leaf_cache.h"

namespace volcontact::crossing_test {
namespace {

using test::bumpy_soup;
using test::mesh_of;
using test::shifted;

using Corners = std::array<Vec3, 3>;

// Where the line through p and q passes through a triangle, if between p and q.
std::optional<Vec3> meeting(const Vec3& p, const Vec3& q, const Corners& t) {
  const Mat3 sides = Mat3::with_columns(t[1] - t[0], t[2] - t[0], p - q);
  const Vec3 s = sides.inverse() * (p - t[0]);
  if (s.minCoeff() < 0.0 || s[0] + s[1] > 1.0 || s[2] > 1.0) return std::nullopt;
  return p + s[2] * (q - p);
}

// The ends of the segment in which two triangles cross: sides of one through the other.
std::vector<Vec3> crossing_of(const Corners& f, const Corners& g) {
  std::vector<Vec3> ends;
  for (int i = 0; i < 3; ++i) {
    for (const auto& [of, through] : {std::pair(&f, &g), std::pair(&g, &f)}) {
      if (const auto end = meeting((*of)[i], (*of)[(i + 1) % 3], *through)) ends.push_back(*end);
    }
  }
  return ends;
}

std::map<std::pair<int, int>, std::vector<Vec3>> all_crossings(const Mesh& a, const Mesh& b,
                                                               const Pose& X_BA) {
  const auto corners = [](const Mesh& mesh, int t, const Pose& X) {
    Corners c;
    for (int i = 0; i < 3; ++i) {
      c[i] = X * mesh.topology().vertices[mesh.topology().triangles[t][i]];
    }
    return c;
  };
  std::map<std::pair<int, int>, std::vector<Vec3>> all;
  const int count_a = static_cast<int>(a.topology().triangles.size()),
            count_b = static_cast<int>(b.topology().triangles.size());
  for (int f = 0; f < count_a; ++f) {
    const Corners corners_f = corners(a, f, X_BA);
    for (int g = 0; g < count_b; ++g) {
      const std::vector<Vec3> ends = crossing_of(corners_f, corners(b, g, Pose{}));
      if (ends.size() == 2) all[{f, g}] = ends;
    }
  }
  return all;
}

TEST(Crossing, FindsTheSegmentsOfAllPairsOfTriangles) {
  const Mesh a = mesh_of(bumpy_soup(2, 1)), b = mesh_of(bumpy_soup(2, 2));
  test::Random random(1);
  CrossingScratch scratch;
  for (double depth : {0.02, 0.3, 1.0}) {
    const Pose X_BA{test::turn(Vec3(1, 2, 3), depth), (1.9 - depth) * Vec3(0.6, 0.64, 0.48)};
    const auto expected = all_crossings(a, b, X_BA);
    ASSERT_TRUE(find_contacts(a.tree(), b.tree(), X_BA, 1e-13, 20000, scratch));
    EXPECT_GT(expected.size(), 5u);
    EXPECT_EQ(scratch.contacts.size(), expected.size());
    for (const TriangleContact& contact : scratch.contacts) {
      EXPECT_TRUE(contact.proper);
      const auto pair = expected.find(
          {a.tree().triangle_of_slot[contact.f], b.tree().triangle_of_slot[contact.g]});
      ASSERT_NE(pair, expected.end());
      const std::vector<Vec3>& ends = pair->second;
      const bool turned = (ends[0] - contact.p).norm() > (ends[1] - contact.p).norm();
      EXPECT_LT((ends[turned ? 1 : 0] - contact.p).norm(), 1e-11);
      EXPECT_LT((ends[turned ? 0 : 1] - contact.q).norm(), 1e-11);
      EXPECT_GT(contact.normal_f.cross(contact.normal_g).dot(contact.q - contact.p), 0.0);
    }
  }
}

TEST(Crossing, KeysJoinTheSegmentsToClosedCurves) {
  const Mesh a = mesh_of(bumpy_soup(3, 1)), b = mesh_of(bumpy_soup(3, 2));
  CrossingScratch scratch;
  ASSERT_TRUE(find_contacts(a.tree(), b.tree(), shifted(1.2, 0.5, 0.3), 1e-13, 20000, scratch));
  std::map<std::uint64_t, int> ends;
  for (const TriangleContact& contact : scratch.contacts) {
    ++ends[contact.key_p];
    ++ends[contact.key_q];
  }
  EXPECT_GT(ends.size(), 20u);
  for (const auto& [key, times] : ends) EXPECT_EQ(times, 2);
}

// The boxes are kept in floats, which are coarse far from the origin.
TEST(Crossing, FindsTheSamePairsFarFromTheOrigins) {
  const test::Soup ball = bumpy_soup(3, 1), other = bumpy_soup(3, 2);
  const Pose X_BA{test::turn(Vec3(1, 2, 3), 0.4), Vec3(1.6, 0.2, 0.1)};
  const auto pairs = [&](const Mesh& a, const Mesh& b, const Pose& X) {
    CrossingScratch scratch;
    EXPECT_TRUE(find_contacts(a.tree(), b.tree(), X, 1e-13, 20000, scratch));
    std::vector<std::pair<int, int>> list;
    for (const TriangleContact& contact : scratch.contacts) {
      list.emplace_back(a.tree().triangle_of_slot[contact.f], b.tree().triangle_of_slot[contact.g]);
    }
    std::sort(list.begin(), list.end());
    return list;
  };
  const auto near = pairs(mesh_of(ball), mesh_of(other), X_BA);
  EXPECT_GT(near.size(), 20u);
  for (double far : {1e2, 1e4}) {
    const Pose X_MA = shifted(far, -2.0 * far, 3.0 * far);
    const Pose X_NB = shifted(-3.0 * far, far, 0.5 * far);
    EXPECT_EQ(
        pairs(mesh_of(ball.moved(X_MA)), mesh_of(other.moved(X_NB)), X_NB * X_BA * X_MA.inverse()),
        near);
  }
}

TEST(Crossing, TrianglesThatTouchAreContactsWithinTheirBounds) {
  const Mesh box = mesh_of(test::box_soup(Vec3(1.0, 1.0, 1.0)));
  CrossingScratch scratch;
  ASSERT_TRUE(find_contacts(box.tree(), box.tree(), shifted(0.3, 0.2, 2.0), 1e-13, 20000, scratch));
  ASSERT_FALSE(scratch.contacts.empty());
  for (const TriangleContact& contact : scratch.contacts) {
    EXPECT_FALSE(contact.proper);
    EXPECT_TRUE(contact.p.at_most(contact.q));
    EXPECT_NEAR(contact.p.z(), 1.0, 1e-12);
  }
  ASSERT_TRUE(
      find_contacts(box.tree(), box.tree(), shifted(0.3, 0.2, 2.0 + 1e-9), 1e-13, 20000, scratch));
  EXPECT_TRUE(scratch.contacts.empty());
}

TEST(Crossing, StopsWhereThereAreTooMany) {
  const Mesh ball = mesh_of(bumpy_soup(3, 1));
  CrossingScratch scratch;
  EXPECT_FALSE(find_contacts(ball.tree(), ball.tree(), Pose{}, 1e-13, 100, scratch));
}

TEST(LeafCache, MakesALeafAgainOnlyAfterAnotherTookItsPlace) {
  LeafCache<int> cache;
  int made = 0;
  const auto get = [&](int number) {
    return cache.at(number, [&](int& leaf) { leaf = 10 * number, ++made; });
  };
  EXPECT_EQ(get(3), 30);
  EXPECT_EQ(get(4), 40);
  EXPECT_EQ(get(3), 30);
  EXPECT_EQ(made, 2);
  for (int number = 0; number < 1000; ++number) EXPECT_EQ(get(number), 10 * number);
  EXPECT_EQ(get(3), 30);
}

}  // namespace
}  // namespace volcontact::crossing_test
