// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/torus_pair/torus_events.h"

#include <gtest/gtest.h>

#include "core/support/random.h"

namespace volcontact::torus_events_test {
namespace {

constexpr TorusSize kRing{0.3, 0.1};

// Of two rings in one plane, where the places are twofold, as the rings are alike above and below:
// the circles of one leave the other where its outermost or innermost point does, circle with
// circle.
TEST(TorusEvents, AreWhereAPointOfTheCircleTouches) {
  const double d = 0.6;
  const Pose X{Mat3::Identity(), {d, 0.0, 0.0}};
  std::vector<TorusPatchScratch::Sample> samples;
  for (double angle : {0.6 * kPi, 0.8 * kPi, kPi, 1.2 * kPi, 1.4 * kPi}) {
    CircleArcs arcs;
    find_arcs(section_circle(kRing, X, angle), kRing, ArcSearch::kCount, false, arcs);
    samples.push_back({angle, arc_count(arcs)});
  }
  std::vector<double> events;
  find_torus_events(kRing, X, kRing, false, samples, events);
  ASSERT_GE(events.size(), 2u);
  // A point of the ring's outline, at 0.2 or 0.4 from its axis, on the other's outer circle 0.4.
  const auto crossing = [&](double own) {
    return kPi - std::acos((d * d + own * own - 0.4 * 0.4) / (2.0 * d * own));
  };
  for (double event : events) {
    const double near = std::min(event, 2.0 * kPi - event);
    EXPECT_LE(std::min(std::abs(near - crossing(0.4)), std::abs(near - crossing(0.2))), 1e-6);
  }
}

TEST(TorusEvents, CountsDifferOnTheirTwoSides) {
  test::Random random(1);
  int found = 0;
  for (int i = 0; i < 30; ++i) {
    const Pose X{random.rotation(), random.in_box(0.4)};
    const auto count = [&](double angle) {
      CircleArcs arcs;
      find_arcs(section_circle(kRing, X, angle), kRing, ArcSearch::kCount, false, arcs);
      return arc_count(arcs);
    };
    std::vector<TorusPatchScratch::Sample> samples;
    for (int k = 0; k <= 64; ++k) {
      const double angle = 2.0 * kPi * k / 64;
      samples.push_back({angle, count(angle)});
    }
    std::vector<double> events;
    find_torus_events(kRing, X, kRing, false, samples, events);
    for (double event : events) {
      EXPECT_NE(count(event - 1e-6), count(event + 1e-6)) << i << ' ' << event;
      ++found;
    }
  }
  EXPECT_GT(found, 20);
}

}  // namespace
}  // namespace volcontact::torus_events_test
