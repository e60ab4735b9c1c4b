// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/support/evaluated.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"

namespace volcontact::meeting_faces_test {
namespace {

using test::evaluated;

// A body of revolution about z: its radius squared, a parabola in z, between two heights.
struct Turned {
  double one, z, zz;
  double low, high;

  double square(double at) const { return one + at * (z + at * zz); }
};
Turned cone(double slope, double height) { return {0.0, 0.0, slope * slope, 0.0, height}; }
Turned spheroid(double radius, double half, double center) {
  const double share = radius * radius / (half * half);
  return {radius * radius - share * center * center, 2.0 * share * center, -share, center - half,
          center + half};
}

// The smaller disc at every height, which is a parabola between the heights where they are alike.
double volume(const Turned& a, const Turned& b) {
  const double low = std::max(a.low, b.low), high = std::min(a.high, b.high);
  if (!(low < high)) return 0.0;
  std::vector<double> places{low, high};
  const double p = a.zz - b.zz, q = 0.5 * (a.z - b.z), r = a.one - b.one;
  const double root = std::sqrt(std::max(0.0, q * q - p * r));
  const double larger = q > 0.0 ? -q - root : -q + root;
  for (const double place : {larger / p, r / larger}) {
    if (place > low && place < high) places.push_back(place);
  }
  std::sort(places.begin(), places.end());
  double sum = 0.0;
  for (std::size_t i = 1; i < places.size(); ++i) {
    const double from = places[i - 1], to = places[i], middle = 0.5 * (from + to);
    const Turned& least = a.square(middle) < b.square(middle) ? a : b;
    sum += kPi / 6.0 * (to - from) *
           (least.square(from) + 4.0 * least.square(middle) + least.square(to));
  }
  return sum;
}

// None, or 1e-16 to 1e-3 to either side.
double hair(test::Random& random) {
  if (random.uniform() < 0.3) return 0.0;
  return random.log_uniform(1e-16, 1e-3) * (random.uniform() < 0.5 ? 1.0 : -1.0);
}

// A cone with its apex in the origin and a spheroid about its axis, in both orders.
void check(double slope, double height, double radius, double half, double center,
           test::Random& random) {
  const double expected = volume(cone(slope, height), spheroid(radius, half, center));
  const Shape a =
      Frustum({.bottom_radius = 0.0, .top_radius = slope * height, .half_length = 0.5 * height});
  const Shape b = radius == half ? Shape(Sphere({.radius = radius}))
                                 : Shape(Ellipsoid({.semi_axes = {radius, radius, half}}));
  const Mat3 about_z = test::turn(Vec3::UnitZ(), random.uniform(0.0, 2.0 * kPi));
  const Pose X{about_z, Vec3(0.0, 0.0, center - 0.5 * height)};
  for (const VolumeMetrics& m : {evaluated(a, b, X, Engine::kLines).total,
                                 evaluated(b, a, X.inverse(), Engine::kLines).total}) {
    EXPECT_NEAR(m.volume, expected, m.volume_error + 1e-12 * expected)
        << "slope " << slope << ", height " << height << ", radius " << radius << ", half " << half
        << ", center " << center;
  }
}

// A flat cone stands with its apex on the bottom of a ball, on the inside: near the axis the cone
// bounds the overlap below, and farther out the ball.
TEST(MeetingFaces, OfAConeOnTheBottomOfABall) {
  test::Random random(3);
  for (int i = 0; i < test::cases(1500, 100); ++i) {
    const double radius = random.uniform(0.1, 0.4);
    const double half = radius * (random.uniform() < 0.5 ? 1.0 : random.uniform(0.4, 2.0));
    // The height, of that of the ball, at which the cone is as wide.
    const double meets = random.log_uniform(1e-4, 1.0);
    const double slope = radius / half * std::sqrt((2.0 - meets) / meets);
    const double height = half * std::min(1.9, meets * random.log_uniform(1.0, 1e4));
    check(slope, height, radius, half, half * (1.0 + hair(random)), random);
  }
}

// A ball through the rim of a cone, whose face it meets there at a small angle: it leaves the cone
// next to the rim only.
TEST(MeetingFaces, OfABallThroughTheRimOfACone) {
  test::Random random(5);
  for (int i = 0; i < test::cases(1500, 100); ++i) {
    const double height = random.uniform(0.05, 0.4), rim = random.log_uniform(0.1, 10.0) * height;
    const double slope = rim / height,
                 share = random.uniform() < 0.5 ? 1.0 : random.uniform(0.4, 2.0);
    // Tangent in the rim where `lead` is 1.
    const double lead = 1.0 + random.log_uniform(1e-3, 0.5) * (random.uniform() < 0.5 ? 1.0 : -1.0);
    const double above = lead * slope * rim * share * share;
    const double radius = std::hypot(rim, above / share);
    check(slope, height, radius, radius * share, height + above + hair(random) * height, random);
  }
}

}  // namespace
}  // namespace volcontact::meeting_faces_test
