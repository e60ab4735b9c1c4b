// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "core/support/csg_solids.h"
#include "core/support/evaluated.h"
#include "core/support/random.h"
#include "core/support/sanitized.h"

namespace volcontact::stepped_holes_test {
namespace {

using test::evaluated;

Csg placed(const SimpleShape& shape, double height = 0.0) {
  return Csg(shape, Pose{Mat3::Identity(), Vec3(0.0, 0.0, height)});
}

// What two discs have in common.
double lens(double r, double R, double d) {
  if (d >= r + R) return 0.0;
  const double least = std::min(r, R);
  if (d <= std::abs(r - R)) return kPi * least * least;
  const double u = (d * d + r * r - R * R) / (2.0 * d), v = d - u;
  const double half = std::sqrt(std::max(0.0, (r - u) * (r + u)));
  return r * r * std::atan2(half, u) - u * half + R * R * std::atan2(half, v) - v * half;
}

// Two bodies of revolution about parallel axes a distance d apart, as their radii over the height;
// the hole ends at the heights `from` and `to` of the block around it. Discs less lenses, slice by
// slice between the heights where a radius jumps or bends: nothing of it is of the engines.
double volume_in_wall(const std::function<double(double)>& body,
                      const std::function<double(double)>& hole, double d,
                      std::vector<double> breaks) {
  constexpr int kSlices = 20000;
  std::sort(breaks.begin(), breaks.end());
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    const double width = breaks[i + 1] - breaks[i];
    for (int k = 0; k < kSlices; ++k) {
      const double z = breaks[i] + width * (k + 0.5) / kSlices, r = body(z), R = hole(z);
      if (r > 0.0) sum += (kPi * r * r - lens(r, R, d)) * width / kSlices;
    }
  }
  return sum;
}

// A screw with a cylinder for a head in a hole with a counterbore, chamfers at its mouth and at the
// narrow bore: shifted until it presses on walls, sunk until it presses on the shoulder.
TEST(SteppedHoles, AScrewShiftedInAChamferedCounterbore) {
  test::Random random(41);
  for (int i = 0; i < test::cases(80, 16); ++i) {
    const double scale = random.log_uniform(1e-3, 1.0);
    const double bore = 0.1 * scale, wide = random.uniform(0.15, 0.2) * scale, half = 0.3 * scale,
                 floor = random.uniform(0.05, 0.15) * scale,
                 chamfer = random.uniform(0.005, 0.03) * scale, edge = 0.5 * chamfer;
    const auto cone = [&](double low, double high, double height) {
      return Frustum({.bottom_radius = low, .top_radius = high, .half_length = 0.5 * height});
    };
    const Csg block = placed(Box({.half_sizes = Vec3(0.4, 0.4, 0.3) * scale})) -
                      placed(Cylinder({.radius = bore, .half_length = 2.0 * half})) -
                      placed(Cylinder({.radius = wide, .half_length = half}), half + floor) -
                      placed(cone(wide, wide + chamfer, chamfer), half - 0.5 * chamfer) -
                      placed(cone(bore, bore + edge, edge), floor - 0.5 * edge);
    const double shank = bore * random.uniform(0.9, 0.999),
                 head = wide * random.uniform(0.9, 0.999);
    const double sunk =
        random.uniform(0.0, 1.0) < 0.5 ? -1e-3 * scale : random.log_uniform(1e-5, 1e-2) * scale;
    const double under = floor - sunk, long_half = 0.35 * scale;
    const Csg screw =
        placed(Cylinder({.radius = shank, .half_length = long_half}),
               under - long_half + 0.01 * scale) +
        placed(Cylinder({.radius = head, .half_length = 0.1 * scale}), under + 0.1 * scale);
    const double least = std::min(bore - shank, wide - head);
    const double d = least + random.log_uniform(1e-4, 3e-2) * scale;
    const double tip = under - 2.0 * long_half + 0.01 * scale, top = under + 0.2 * scale;
    const auto body = [&](double z) {
      return std::max(z > tip && z < under + 0.01 * scale ? shank : 0.0,
                      z > under && z < top ? head : 0.0);
    };
    const auto hole = [&](double z) {
      double r = bore;
      if (z > floor - edge) r = std::max(r, bore + (z - (floor - edge)));
      if (z > floor) r = wide;
      if (z > half - chamfer) r = std::max(r, wide + (z - (half - chamfer)));
      return r;
    };
    std::vector<double> breaks = {-half, half};
    for (const double z :
         {tip, under, under + 0.01 * scale, top, floor - edge, floor, half - chamfer}) {
      if (z > -half && z < half) breaks.push_back(z);
    }
    const double expected = volume_in_wall(body, hole, d, breaks);
    ASSERT_GT(expected, 0.0);
    const double turned = random.uniform(0.0, 2.0 * kPi), spun = random.uniform(0.0, 2.0 * kPi);
    const Pose X{test::turn(Vec3::UnitZ(), spun),
                 d * Vec3(std::cos(turned), std::sin(turned), 0.0)};
    for (const VolumeMetrics& m :
         {evaluated(block, screw, X).total, evaluated(screw, block, X.inverse()).total}) {
      EXPECT_NEAR(m.volume, expected, m.volume_error + 1e-5 * expected) << i << " " << d / scale;
      EXPECT_NEAR(m.volume, expected, 1e-3 * expected) << i << " " << d / scale;
    }
  }
}

// The tip of a cone in a conical hollow with a floor, a micrometre large: sizes are no reason.
TEST(SteppedHoles, AConeTipInAMicroCup) {
  test::Random random(42);
  int touching = 0;
  for (int i = 0; i < 120; ++i) {
    const double scale = i % 3 == 0 ? 1.0 : i % 3 == 1 ? 1e-3 : 1e-6;
    const double low = random.uniform(0.02, 0.1) * scale, high = 0.3 * scale, half = 0.25 * scale;
    const Csg cup = placed(Frustum({.bottom_radius = 0.2 * scale,
                                    .top_radius = 0.4 * scale,
                                    .half_length = 0.3 * scale})) -
                    placed(Frustum({.bottom_radius = low, .top_radius = high, .half_length = half}),
                           0.1 * scale);
    // The hollow goes from its floor at -0.15 to beyond the rim at 0.3.
    const double tip_radius = i % 2 == 0 ? 0.0 : random.log_uniform(1e-6, 1e-2) * scale;
    const double base = random.uniform(0.1, 0.25) * scale, cone_half = 0.2 * scale;
    const Frustum cone({.bottom_radius = tip_radius, .top_radius = base, .half_length = cone_half});
    const double sunk = random.log_uniform(1e-4, 5e-2) * scale;
    const double tip = -0.15 * scale - (i % 4 < 2 ? sunk : -sunk);
    const double d = random.uniform(0.0, 0.1) * scale;
    const auto body = [&](double z) {
      const double share = (z - tip) / (2.0 * cone_half);
      return share > 0.0 && share < 1.0 ? tip_radius + share * (base - tip_radius) : 0.0;
    };
    const auto hole = [&](double z) {
      const double share = (z + 0.15 * scale) / (2.0 * half);
      return share > 0.0 ? low + share * (high - low) : 0.0;
    };
    std::vector<double> breaks = {-0.3 * scale, -0.15 * scale, 0.3 * scale};
    for (const double z : {tip, tip + 2.0 * cone_half}) {
      if (z > -0.3 * scale && z < 0.3 * scale) breaks.push_back(z);
    }
    const double expected = volume_in_wall(body, hole, d, breaks);
    touching += expected > 1e-9 * std::pow(scale, 3);
    const Pose X{test::turn(Vec3::UnitZ(), random.uniform(0.0, 2.0 * kPi)),
                 Vec3(d, 0.0, tip + cone_half)};
    for (const VolumeMetrics& m :
         {evaluated(cup, cone, X).total, evaluated(cone, cup, X.inverse()).total}) {
      EXPECT_NEAR(m.volume, expected, m.volume_error + 1e-5 * expected + 1e-14 * std::pow(scale, 3))
          << i << " scale " << scale;
      EXPECT_NEAR(m.volume, expected, 1e-3 * expected + 1e-12 * std::pow(scale, 3)) << i;
    }
  }
  EXPECT_GT(touching, 60);
}

}  // namespace
}  // namespace volcontact::stepped_holes_test
