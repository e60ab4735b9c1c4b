// SPDX-License-Identifier: Apache-2.0

// Poses that the search for failures found, once mended.
#include <gtest/gtest.h>

#include "core/search/contact_poses.h"
#include "core/search/overlap_checks.h"
#include "core/support/evaluated.h"
#include "volcontact/pair/interference.h"

namespace volcontact::test::found_poses_test {
namespace {

struct Found {
  const char *a, *b;   // names of examples
  double rotation[9];  // of B in A, row by row
  double translation[3];
};

constexpr Found kFound[] = {
#include "core/characterisation/found_poses.inc"
};

// Plane faces that are parallel to a millionth: what rounding leaves of a cell had moments of its
// own, and counted as a site.
constexpr Found kThin[] = {
    {"counterbored",
     "hollow_cylinder",
     {-0.14156392246901778, -0.27685718565882306, -0.95042609107929166, 0.43269010589777812,
      0.84622043633043764, -0.31095055136611854, 0.89035887602323338, -0.45525934574240157,
      -9.1925910395688064e-07},
     {0.19630538963655142, -0.19049396380027828, 0.59999894255898312}},
    {"hollow_cylinder",
     "counterbored",
     {0.81229629601880893, -0.38746299357055897, 0.43594398274028812, -0.39346159641053441,
      0.18771022571620621, 0.89997380145848971, -0.43053768664798364, -0.90257260083325841,
      2.4513073851580434e-05},
     {-0.052159277298430895, 0.69195578596184926, -0.24488555043696941}},
};

const Example& example(const std::string& name) {
  for (const Example& e : examples()) {
    if (e.name == name) return e;
  }
  throw std::invalid_argument("no example is named " + name);
}

Pose pose(const Found& found) { return {Mat3::from_rows(found.rotation), Vec3(found.translation)}; }

TEST(FoundPoses, VolumesAreWithinTheCertifiedBoundsInBothOrders) {
  for (const Found& found : kFound) {
    const Example &of_a = example(found.a), &of_b = example(found.b);
    const Shape &a = of_a.shape, &b = of_b.shape;
    const Pose X = pose(found);
    const Interference own = evaluated(a, b, X);
    const Interference by_octree =
        evaluated(a, b, X, {.tolerance = 1e-2, .engine = Engine::kOctree});
    const VolumeMetrics &m = own.total, &bound = by_octree.total;
    const VolumeMetrics other = evaluated(b, a, X.inverse()).total;
    // Where thin overlaps are long, an estimate is not a bound; the worst say that they are rough.
    const bool rough = m.status == Status::kApproximate;
    const double slack = bound.volume_error + (rough ? 0.05 : 1e-3) * bound.volume + 1e-13;
    const std::string names = std::string(found.a) + " and " + found.b;
    EXPECT_STREQ(fault_of(own, of_a, of_b, X, m.centroid), nullptr) << names;
    EXPECT_NEAR(m.volume, bound.volume, slack + m.volume_error) << names;
    EXPECT_NEAR(other.volume, bound.volume, slack + other.volume_error) << names;
    EXPECT_LE(m.area_vector.norm(), (1.0 + 5e-3) * std::min(m.area, m.counter_area)) << names;
    EXPECT_NEAR(m.area + m.counter_area, other.area + other.counter_area,
                0.05 * (m.area + m.counter_area))
        << names;
  }
}

TEST(FoundPoses, ThinOverlapsAreWhereTheBodiesAre) {
  for (const Found& found : kThin) {
    const Example &a = example(found.a), &b = example(found.b);
    const Pose X = pose(found);
    for (const Engine engine : {Engine::kAuto, Engine::kOctree}) {
      const Interference answer = evaluated(a.shape, b.shape, X, {.engine = engine});
      EXPECT_STREQ(fault_of(answer, a, b, X, answer.total.centroid), nullptr) << found.a;
      EXPECT_LE(answer.sites.size(), 2u) << found.a;
      for (const VolumeMetrics& site : answer.sites) {
        EXPECT_GT(site.volume, 1e-3 * answer.total.volume) << found.a;
      }
    }
  }
}

}  // namespace
}  // namespace volcontact::test::found_poses_test
