// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/dispatch.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/support/evaluated.h"
#include "core/support/matchers.h"
#include "volcontact/pair/engines.h"
#include "volcontact/pair/interference.h"

namespace volcontact::dispatch_test {
namespace {

/// Counts its calls.
struct Calls {
  int count = 0;
};

// A toy engine: boxes whose axes are parallel, with a sphere's bounds for a sphere. It is whole:
// nothing else than this type and its place in a list makes it one of the engines.
struct ParallelBoxes : EngineBase {
  static constexpr Engine kWord = Engine::kClip;
  using Scratch = TypeList<Calls>;
  static constexpr bool kExact = true;

  template <typename A, typename B>
  static constexpr bool serves() {
    return std::is_same_v<A, Box> && (std::is_same_v<B, Box> || std::is_same_v<B, Sphere>);
  }
  template <typename A, typename B>
  static Answer run(const Question<A, B>& q, Calls& calls, Interference& out) noexcept {
    ++calls.count;
    if (!(q.X_AB.rotation == Mat3::Identity())) return Answer::kBeyond;
    const Aabb a = q.a.bounds(), b = q.b.bounds();
    const Vec3 low = a.min.cwiseMax(b.min + q.X_AB.translation);
    const Vec3 high = a.max.cwiseMin(b.max + q.X_AB.translation);
    out.sites.clear();
    out.total = VolumeMetrics{};
    if (!low.less_than(high)) return Answer::kGiven;
    const Vec3 size = high - low;
    MomentSum sum;
    sum.volume = size.prod();
    sum.first = sum.volume * 0.5 * (low + high);
    sum.second = outer(sum.first, 0.5 * (low + high)) +
                 Mat3((sum.volume / 12.0 * size.cwiseAbs2()).asDiagonal());
    sum.area_vector = Vec3(-size.y() * size.z(), 0.0, 0.0);
    sum.area = sum.counter_area = size.y() * size.z();
    out.total = sum.metrics();
    out.sites.push_back(out.total);
    return Answer::kGiven;
  }
};

/// What the other toy does.
enum class Trick { kBeyond, kImpossible, kNoNumber };

// A toy engine that serves all and is never right.
struct Trickster : EngineBase {
  static constexpr Engine kWord = Engine::kLines;
  using Scratch = TypeList<Trick>;
  static constexpr bool kExact = true;

  template <typename A, typename B>
  static constexpr bool serves() {
    return true;
  }
  template <typename A, typename B>
  static Answer run(const Question<A, B>&, Trick& trick, Interference& out) noexcept {
    if (trick == Trick::kBeyond) return Answer::kBeyond;
    out.total = VolumeMetrics{};
    out.total.volume = trick == Trick::kImpossible ? 1e9 : std::numeric_limits<double>::quiet_NaN();
    out.sites.assign(1, out.total);
    return Answer::kGiven;
  }
};

const Shape kBox = Box({.half_sizes = Vec3(0.5, 0.4, 0.3)});
const Shape kBall = Sphere({.radius = 0.5});
const Pose kShifted{Mat3::Identity(), Vec3(0.6, 0.2, 0.1)};

using Toys = Dispatch<TypeList<Trickster, ParallelBoxes, Octree>>;

Interference asked(const Shape& a, const Shape& b, const Pose& X_AB, Engine engine = Engine::kAuto,
                   Trick trick = Trick::kBeyond, int* calls = nullptr) {
  Toys::Scratch scratch;
  std::get<Trick>(scratch) = trick;
  Interference out;
  Toys::interference(a, b, X_AB, {.tolerance = 1e-2, .engine = engine}, scratch, out);
  if (calls) *calls = std::get<Calls>(scratch).count;
  return out;
}

TEST(Dispatch, AToyEngineIsOneTypeAndOneWordInTheList) {
  const Interference out = asked(kBox, kBox, kShifted);
  EXPECT_EQ(out.engine, Engine::kClip);
  EXPECT_NEAR(out.total.volume, 0.4 * 0.6 * 0.5, 1e-15);
  ASSERT_EQ(out.sites.size(), 1u);
}

TEST(Dispatch, MakesTheMirrorImage) {
  const Interference there = asked(kBox, kBall, kShifted);
  const Interference back = asked(kBall, kBox, kShifted.inverse());
  EXPECT_EQ(there.engine, Engine::kClip);
  EXPECT_EQ(back.engine, Engine::kClip);
  EXPECT_TRUE(there.total.touching());
  EXPECT_TRUE(test::same(reversed(transformed(back.total, kShifted)), there.total, {1e-12, 1.0}));
  ASSERT_EQ(back.sites.size(), 1u);
  EXPECT_EQ(back.sites[0].volume, back.total.volume);
  EXPECT_EQ(back.sites[0].area_vector, back.total.area_vector);
}

TEST(Dispatch, AsksTheNextWhereOneIsBeyond) {
  const Pose turned{Mat3(rotation_about(Vec3::UnitZ(), 0.3)), kShifted.translation};
  const Interference out = asked(kBox, kBox, turned);
  EXPECT_EQ(out.engine, Engine::kOctree);
  EXPECT_EQ(out.total.volume,
            test::evaluated(kBox, kBox, turned, Engine::kOctree, 1e-2).total.volume);
}

TEST(Dispatch, AsksTheNextWhereAnAnswerCannotBe) {
  const Interference out = asked(kBox, kBox, kShifted, Engine::kAuto, Trick::kImpossible);
  EXPECT_EQ(out.engine, Engine::kClip);
  EXPECT_NEAR(out.total.volume, 0.4 * 0.6 * 0.5, 1e-15);
  EXPECT_EQ(asked(kBall, kBall, kShifted, Engine::kAuto, Trick::kImpossible).engine,
            Engine::kOctree);
}

TEST(Dispatch, WhatIsNoNumberIsSettledWhereOnlyBoundsAreLeft) {
  const Interference out = asked(kBall, kBall, kShifted, Engine::kAuto, Trick::kNoNumber);
  EXPECT_EQ(out.total.status, Status::kInvalid);
  EXPECT_EQ(out.engine, Engine::kLines);
  EXPECT_TRUE(out.sites.empty());
  EXPECT_EQ(asked(kBox, kBox, kShifted, Engine::kAuto, Trick::kNoNumber).engine, Engine::kClip);
}

TEST(Dispatch, AnEngineAskedForComesFirst) {
  int calls = 0;
  const Interference out = asked(kBox, kBox, kShifted, Engine::kOctree, Trick::kBeyond, &calls);
  EXPECT_EQ(out.engine, Engine::kOctree);
  EXPECT_EQ(calls, 0);
  // Beyond lines, and boxes do not stand in for them.
  EXPECT_EQ(asked(kBox, kBox, kShifted, Engine::kLines).engine, Engine::kOctree);
  // A word that serves not is as good as none.
  EXPECT_EQ(asked(kBox, kBox, kShifted, Engine::kColumns).engine, Engine::kClip);
}

TEST(Dispatch, NoEngineSeesAPoseThatIsNoNumber) {
  Pose bad = kShifted;
  bad.translation.x() = std::numeric_limits<double>::infinity();
  int calls = 0;
  const Interference out = asked(kBox, kBox, bad, Engine::kAuto, Trick::kBeyond, &calls);
  EXPECT_EQ(out.total.status, Status::kInvalid);
  EXPECT_EQ(out.engine, Engine::kLines);
  EXPECT_EQ(calls, 0);
}

TEST(Dispatch, TwoHalfSpacesAreUnbounded) {
  EXPECT_EQ(asked(HalfSpace(), HalfSpace(), Pose{}).total.status, Status::kUnbounded);
}

TEST(Dispatch, EveryWordIsThatOfAnEngine) {
  for (const Engine word : kEngines) {
    bool found = word == Engine::kAuto;
    for_each_type(Engines{},
                  [&](auto tag) { found = found || decltype(tag)::Type::kWord == word; });
    EXPECT_TRUE(found) << to_string(word);
  }
}

TEST(Dispatch, EnginesThatNameOneScratchShareIt) {
  using Scratch = Dispatch<TypeList<ParallelBoxes, Octree, ParallelBoxes>>::Scratch;
  EXPECT_EQ(std::tuple_size_v<Scratch>, 2u);
}

}  // namespace
}  // namespace volcontact::dispatch_test
