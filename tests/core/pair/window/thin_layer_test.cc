// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "core/support/csg_solids.h"
#include "core/support/evaluated.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"
#include "volcontact/pair/window/convex_window.h"

namespace volcontact::thin_layer_test {
namespace {

using test::evaluated;

// The end of a drum, at z = kEnd, and a face of a box or of a drum, nearly in one plane: how far
// the second reaches behind the first is linear, and V a sum over strips of the common footprint.
constexpr double kRadius = 0.3, kEnd = 0.2, kWide = 0.25, kLong = 0.4, kThick = 0.05;

struct Case {
  bool box;
  Pose X;
  Vec3 plate{kWide, kLong, kThick};  // half sizes of the box
  double end = kEnd;

  // How far the second reaches behind the end of the first, at a place of it.
  double reach(double x, double y) const {
    const Vec3 w = X.rotation.col(2), middle = X.translation - kThick * w;
    return end - middle.z() + (w.x() * (x - middle.x()) + w.y() * (y - middle.y())) / w.z();
  }

  // Where the line at x, along y, lies in both footprints.
  bool common(double radius, double x, double& low, double& high) const {
    const Vec3 &u = X.rotation.col(0), &v = X.rotation.col(1);
    const Vec3 middle = X.translation - kThick * X.rotation.col(2);
    high = std::sqrt(radius * radius - x * x);
    low = -high;
    if (!box) {
      const double square = kLong * kLong - (x - middle.x()) * (x - middle.x());
      if (!(square > 0.0)) return false;
      low = std::max(low, middle.y() - std::sqrt(square));
      high = std::min(high, middle.y() + std::sqrt(square));
    }
    for (int side = 0; side < 2 && box; ++side) {
      const Vec3& e = side == 0 ? u : v;
      const double half = plate[side];
      const double at = e.x() * (x - middle.x()) - e.y() * middle.y();
      const double one = (-half - at) / e.y(), other = (half - at) / e.y();
      low = std::max(low, std::min(one, other));
      high = std::min(high, std::max(one, other));
    }
    return low < high;
  }

  // Of what lies over a disc.
  double volume(double radius = kRadius) const {
    constexpr int kStrips = 20000;
    const double step = 2.0 * radius / kStrips;
    double sum = 0.0;
    for (int i = 0; i < kStrips; ++i) {
      const double x = (i + 0.5) * step - radius;
      double low, high;
      if (!common(radius, x, low, high)) continue;
      const double one = reach(x, low), other = reach(x, high), most = std::max(one, other);
      if (!(most > 0.0)) continue;
      sum +=
          (high - low) * (std::min(one, other) >= 0.0 ? 0.5 * (one + other)
                                                      : 0.5 * most * most / std::abs(one - other));
    }
    return sum * step;
  }
};

Case random_case(test::Random& random, double lean, double depth, double nearest) {
  const double at = random.uniform(0.0, 2.0 * kPi), far = random.uniform(nearest, 0.6);
  const double to = random.uniform(0.0, 2.0 * kPi);
  Case c{random.uniform() < 0.5, {}};
  c.X.rotation = rotation_about(Vec3(std::cos(to), std::sin(to), 0), lean) *
                 rotation_about(Vec3::UnitZ(), random.uniform(0.0, 6.0));
  c.X.translation = Vec3(far * std::cos(at), far * std::sin(at), 0.0);
  c.X.translation.z() = kEnd + kThick - depth;
  return c;
}

// Both orders, to the error that they claim and 1e-5 of the sum over strips.
void expect_right(const Shape& a, const Case& c, double expected, double rounding, int number) {
  const Shape b = c.box ? Shape(Box({.half_sizes = c.plate}))
                        : Shape(Cylinder({.radius = kLong, .half_length = kThick}));
  const double slack = 1e-5 * expected + rounding;
  const VolumeMetrics ab = evaluated(a, b, c.X).total, ba = evaluated(b, a, c.X.inverse()).total;
  EXPECT_NEAR(ab.volume, expected, ab.volume_error + slack) << number;
  EXPECT_NEAR(ba.volume, expected, ba.volume_error + slack) << number;
}

const Cylinder kDrum({.radius = kRadius, .half_length = kEnd});

TEST(ThinLayer, FacesNearlyInOnePlaneAreRightToTheirClaims) {
  test::Random random(11);
  const int kPoses = test::cases(600, 60);
  int touching = 0;
  for (int i = 0; i < kPoses; ++i) {
    const double lean = random.log_uniform(1e-11, 1e-8);
    const Case c = random_case(random, lean, lean * random.uniform(0.01, 0.3), 0.2);
    const double expected = c.volume();
    expect_right(kDrum, c, expected, 1e-15, i);
    touching += expected > 0.0 ? 1 : 0;
  }
  EXPECT_GT(3 * touching, 2 * kPoses);
}

TEST(ThinLayer, ANanometreIsRightToItsClaim) {
  test::Random random(12);
  for (int i = 0; i < test::cases(600, 60); ++i) {
    const double lean = i % 3 == 0 ? 0.0 : random.log_uniform(1e-10, 1e-7);
    const Case c = random_case(random, lean, 1e-9, 0.0);
    expect_right(kDrum, c, c.volume(), 1e-15, i);
  }
}

// The same on the rim of a bore in the drum's end, a tube or a cone.
TEST(ThinLayer, OnTheRimOfABore) {
  constexpr double kBore = 0.15;
  const Csg drum(kDrum);
  const Csg tube = drum - testing::tube(kBore, 0.5),
            cone = drum - testing::cone(0.05, 0.25, 0.1, testing::at(0, 0, kEnd));
  test::Random random(13);
  for (int i = 0; i < test::cases(400, 40); ++i) {
    const double lean = i % 4 == 0 ? 0.0 : random.log_uniform(1e-10, 1e-8);
    Case c = random_case(random, lean, 1e-9, 0.0);
    c.box = true;
    expect_right(i % 2 == 0 ? tube : cone, c, c.volume() - c.volume(kBore), 1e-15, i);
  }
}

// The end of a pin on the edge of a sheet that leans and is so long that it reaches far more into
// the pin's plane than the pin into its own.
TEST(ThinLayer, APinOnTheEdgeOfALongSheet) {
  constexpr double kPin = 2e-4, kLength = 0.1;
  const Shape pin = Cylinder({.radius = kPin, .half_length = kLength});
  test::Random random(14);
  for (int i = 0; i < test::cases(2000, 200); ++i) {
    const double lean = random.log_uniform(1e-10, 1e-7), to = random.uniform(0.0, 2.0 * kPi);
    Case c{true, {}, Vec3(0.3, random.log_uniform(2e-4, 1e-2), kThick), kLength};
    c.X.rotation = rotation_about(Vec3(std::cos(to), std::sin(to), 0), lean) *
                   rotation_about(Vec3::UnitZ(), random.uniform(0.0, 6.0));
    // This place of the sheet's face is in the plane of the pin's end, off its middle.
    const Vec3 place(0.9 * random.uniform(-c.plate.x(), c.plate.x()),
                     c.plate.y() - random.uniform(0.0, kPin), -c.plate.z());
    const double off = kPin * random.uniform(-1.0, 1.0);
    c.X.translation =
        Vec3(std::sin(to), -std::cos(to), 0.0) * off + Vec3(0, 0, kLength) - c.X.rotation * place;
    const double expected = c.volume(kPin);
    expect_right(pin, c, expected, 3e-16 * kPin * kPin, i);
  }
}

}  // namespace
}  // namespace volcontact::thin_layer_test
