// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/sections/torus/torus_sections.h"

#include <gtest/gtest.h>

#include "core/support/evaluated.h"
#include "core/support/gradient.h"
#include "core/support/matchers.h"
#include "core/support/random_shapes.h"
#include "core/support/sanitized.h"
#include "volcontact/pair/octree/octree.h"

namespace volcontact::torus_sections_test {
namespace {

using test::evaluated;

constexpr double kMajor = 0.3, kMinor = 0.1;
const Shape kRing = Torus({.major_radius = kMajor, .minor_radius = kMinor});

// One of each shape that meets a ring.
std::vector<Shape> bodies() {
  test::Random random(1);
  return {Sphere({.radius = 0.25}),
          Ellipsoid({.semi_axes = {0.3, 0.2, 0.15}}),
          Capsule({.radius = 0.1, .half_length = 0.2}),
          Cylinder({.radius = 0.15, .half_length = 0.2}),
          Frustum({.bottom_radius = 0.2, .top_radius = 0.1, .half_length = 0.2}),
          Box({.half_sizes = {0.25, 0.2, 0.15}}),
          test::random_polytope(12, random)};
}

TEST(TorusSections, ServesEveryConvexBodyInBothOrders) {
  test::Random random(2);
  for (const Shape& body : bodies()) {
    EXPECT_EQ(engine_for(kRing, body), Engine::kLines);
    EXPECT_EQ(engine_for(body, kRing), Engine::kLines);
    const Pose X{random.rotation(), {0.3, 0.1, 0.1}};
    const Interference out = evaluated(kRing, body, X),
                       swapped = evaluated(body, kRing, X.inverse());
    EXPECT_EQ(out.engine, Engine::kLines);
    EXPECT_GT(out.total.volume, 0.0);
    EXPECT_TRUE(test::same(reversed(transformed(swapped.total, X)), out.total, {1e-9, kMajor}));
  }
}

// The closed form of a ring on a plane, at all angles and depths.
TEST(TorusSections, AWideFaceIsAHalfSpace) {
  test::Random random(3);
  const Shape plate = Box({.half_sizes = {2.0, 2.0, 1.0}}), ground = HalfSpace();
  for (int i = 0; i < test::cases(200, 30); ++i) {
    const Mat3 R = random.rotation();
    const Vec3 up = R.transpose() * Vec3::UnitZ();  // of the plate, in the ring's frame
    const double reach = std::get<Torus>(kRing).support_height(up);
    const double depth = random.log_uniform(1e-8, 2.0 * reach);
    const Pose X_PlateRing{R, {0.0, 0.0, reach - depth}};
    const VolumeMetrics expected = evaluated(ground, kRing, X_PlateRing).total;
    const Pose X_top{Mat3::Identity(), {0.0, 0.0, 1.0}};
    const VolumeMetrics m =
        transformed(evaluated(plate, kRing, X_top * X_PlateRing).total, X_top.inverse());
    ASSERT_GT(expected.volume, 0.0);
    EXPECT_NEAR(m.volume, expected.volume, 2e-5 * expected.volume) << "depth " << depth;
    EXPECT_LE((m.centroid - expected.centroid).norm(), 1e-4 * kMajor);
    EXPECT_LE((m.inertia - expected.inertia).norm(), 1e-4 * expected.inertia.norm());
    EXPECT_LE((m.area_vector - expected.area_vector).norm(), 2e-3 * expected.area);
    EXPECT_LE((m.area_moment - expected.area_moment).norm(), 2e-3 * expected.area * kMajor);
    EXPECT_NEAR(m.depth_moment, expected.depth_moment, 1e-4 * expected.depth_moment);
    EXPECT_NEAR(m.depth, expected.depth, 1e-9 * kMajor);
  }
}

TEST(TorusSections, ARingInABoxIsContained) {
  const Shape box = Box({.half_sizes = {0.5, 0.5, 0.5}});
  test::Random random(4);
  for (int i = 0; i < 20; ++i) {
    const VolumeMetrics m = evaluated(kRing, box, {random.rotation(), random.in_box(0.02)}).total;
    EXPECT_EQ(m.status, Status::kContained);
    EXPECT_NEAR(m.volume, 2.0 * kPi * kMajor * kPi * kMinor * kMinor, 1e-15);  // Pappus
  }
}

TEST(TorusSections, ABallInTheTubeIsContained) {
  const double r = 0.04;
  const Shape ball = Sphere({.radius = r});
  for (double angle : {0.0, 1.0, 2.5}) {
    const Vec3 middle(kMajor * std::cos(angle), kMajor * std::sin(angle), 0.03);
    const VolumeMetrics m = evaluated(kRing, ball, {Mat3::Identity(), middle}).total;
    EXPECT_EQ(m.status, Status::kContained);
    EXPECT_NEAR(m.volume, 4.0 / 3.0 * kPi * r * r * r, 1e-15);
    EXPECT_LE((m.centroid - middle).norm(), 1e-12);
  }
}

// By Pappus, from the segment of the disc that lies within the peg.
TEST(TorusSections, APegInTheHoleIsASegmentThatGoesRound) {
  for (double depth : {1e-7, 1e-4, 0.03, 0.1, 0.17}) {
    const double radius = kMajor - kMinor + depth;
    const double far = kMinor - depth, angle = std::acos(far / kMinor);
    const double half = std::sqrt(kMinor * kMinor - far * far);
    const double area = kMinor * kMinor * angle - far * half;
    const double first = -2.0 / 3.0 * half * half * half;  // about the middle of the disc
    const double expected = 2.0 * kPi * (kMajor * area + first);
    const Shape peg = Cylinder({.radius = radius, .half_length = 0.5});
    for (double tilt : {0.0, 1e-12}) {
      const Interference out =
          evaluated(kRing, peg, {test::turn(Vec3::UnitX(), tilt), {0, 0, 0.1}});
      ASSERT_EQ(out.sites.size(), 1u);
      // The closed form loses digits of thin segments itself.
      EXPECT_NEAR(out.total.volume, expected, 1e-5 * expected + 1e-17) << "depth " << depth;
      EXPECT_LE(out.total.area_vector.norm(), 1e-6 * out.total.area);
      EXPECT_NEAR(out.total.area, 2.0 * kPi * 2.0 * kMinor * (kMajor * angle - half),
                  1e-5 * out.total.area);
      EXPECT_NEAR(out.total.counter_area, 2.0 * kPi * radius * 2.0 * half,
                  1e-5 * out.total.counter_area);
    }
  }
}

TEST(TorusSections, ARodThroughTheHoleTouchesNothing) {
  const Shape rod = Capsule({.radius = 0.15, .half_length = 1.0});
  EXPECT_FALSE(evaluated(kRing, rod, {Mat3::Identity(), {0.04, 0.0, 0.0}}).total.touching());
  EXPECT_TRUE(evaluated(kRing, rod, {Mat3::Identity(), {0.051, 0.0, 0.0}}).total.touching());
}

TEST(TorusSections, ABarAcrossTheRingTouchesInTwoSites) {
  const Shape bar = Box({.half_sizes = {1.0, 0.02, 0.03}});
  const Interference out = evaluated(kRing, bar, {Mat3::Identity(), {0.0, 0.0, 0.12}});
  ASSERT_EQ(out.sites.size(), 2u);
  EXPECT_NEAR(out.sites[0].volume, out.sites[1].volume, 1e-7 * out.total.volume);
  EXPECT_NEAR(out.sites[0].centroid.x(), -out.sites[1].centroid.x(), 1e-7);
  EXPECT_NEAR(std::abs(out.sites[0].centroid.x()), kMajor, 0.02);
  const Interference octree =
      evaluated(kRing, bar, {Mat3::Identity(), {0.0, 0.0, 0.12}}, Engine::kOctree, 1e-3);
  EXPECT_NEAR(out.total.volume, octree.total.volume, octree.total.volume_error);
}

TEST(TorusSections, AreaVectorAndMomentAreTheGradientOfVolume) {
  test::Random random(5);
  const std::vector<Shape> all = bodies();
  for (const Shape& body : all) {
    for (int i = 0; i < test::cases(6, 1); ++i) {
      const double angle = random.uniform(0.0, 2.0 * kPi);
      const Pose X{random.rotation(),
                   Vec3(0.35 * std::cos(angle), 0.35 * std::sin(angle), random.uniform(0.0, 0.1))};
      const InterferenceOptions options{.tolerance = 1e-6};
      const VolumeMetrics m = evaluated(kRing, body, X, options).total;
      const auto volume = [&](const Pose& X_AB) {
        return evaluated(kRing, body, X_AB, options).total.volume;
      };
      if (m.volume < 1e-5 || m.status == Status::kContained) continue;
      const test::Gradient g = test::gradient_of_A(volume, X, 1e-3);
      EXPECT_LE((g.shift - m.area_vector).norm(), 1e-2 * m.area);
      EXPECT_LE((g.turn - m.area_moment).norm(), 1e-2 * m.area * kMajor);
    }
  }
}

// The side of a box through the axis of the ring, which no half-plane about the axis crosses.
TEST(TorusSections, AFaceThroughTheAxisCounts) {
  const Shape box = Box({.half_sizes = {0.3, 0.2, 0.25}});
  const InterferenceOptions options{.tolerance = 1e-6};
  for (const double aside : {0.0, 1e-12, 1e-9, 1e-6, 1e-3}) {
    const Pose X{Mat3::Identity(), Vec3(0.3, 0.2 + aside, 0.22)};
    const VolumeMetrics m = evaluated(kRing, box, X, options).total;
    const auto volume = [&](const Pose& X_AB) {
      return evaluated(kRing, box, X_AB, options).total.volume;
    };
    const test::Gradient g = test::gradient_of_A(volume, X, 1e-3);
    EXPECT_LE((g.shift - m.area_vector).norm(), 1e-3 * m.area) << aside;
    EXPECT_LE((g.turn - m.area_moment).norm(), 1e-3 * m.area * kMajor) << aside;
  }
}

// A bar moves outwards over the inner side of the ring: two sites become one.
TEST(TorusSections, VolumeIsContinuousWhereSitesMerge) {
  const Shape bar = Box({.half_sizes = {1.0, 0.02, 0.03}});
  double before = 0.0;
  std::size_t first = 0, last = 0;
  constexpr int kSteps = 200;
  for (int i = 0; i <= kSteps; ++i) {
    const double y = 0.17 + 0.06 * i / kSteps;
    const Interference out = evaluated(kRing, bar, {Mat3::Identity(), {0.0, y, 0.0}});
    if (i == 0) first = out.sites.size();
    last = out.sites.size();
    // A step sweeps no more than the bar's side, within the ring, times its own length.
    if (i > 0) {
      EXPECT_LE(std::abs(out.total.volume - before), 2.0 * 0.06 / kSteps * 0.06 * 0.8);
    }
    before = out.total.volume;
  }
  EXPECT_EQ(first, 2u);
  EXPECT_EQ(last, 1u);
}

TEST(TorusSections, EveryPathHasTheSameBits) {
  test::Random random(6);
  const std::vector<Shape> all = bodies();
  int compared = 0;
  const auto metrics = [&](const Shape& body, const Pose& X, SimdPath path) {
    TorusSectionsScratch scratch;
    scratch.path = path;
    LinesRegions regions;
    Interference out;
    std::visit(
        [&](const auto& solid) {
          if constexpr (HasFaces<std::decay_t<decltype(solid)>>) {
            torus_interference(std::get<Torus>(kRing), ConvexView(solid), X, {}, scratch, regions,
                               out);
          }
        },
        body);
    return out.total;
  };
  for (SimdPath path : {SimdPath::kAvx2, SimdPath::kAvx512}) {
    if (!can_run(path)) continue;
    for (const Shape& body : all) {
      for (int i = 0; i < 20; ++i) {
        const Pose X{random.rotation(), random.in_box(0.4)};
        const VolumeMetrics m = metrics(body, X, path);
        const VolumeMetrics portable = metrics(body, X, SimdPath::kPortable);
        EXPECT_EQ(m.volume, portable.volume);
        EXPECT_EQ(m.inertia, portable.inertia);
        EXPECT_EQ(m.area_vector, portable.area_vector);
        EXPECT_EQ(m.area_moment, portable.area_moment);
        EXPECT_EQ(m.depth_moment, portable.depth_moment);
        ++compared;
      }
    }
  }
  if (compared == 0) GTEST_SKIP() << "this machine has the portable path only";
}

// int rho dA over the part of a disc about m that lies towards a chord in the direction d, seen
// from m under the half angle a.
double moment_of_segment(const Vec2& m, double radius, const Vec2& d, double cosine) {
  const double a = std::acos(std::clamp(cosine, -1.0, 1.0)), sine = std::sin(a);
  return m.x() * radius * radius * (a - sine * std::cos(a)) +
         d.x() * 2.0 / 3.0 * radius * radius * radius * sine * sine * sine;
}

// In a half-plane through the axis a ball is a disc as well, and two discs share two segments;
// those have closed forms. The half-planes are summed by the midpoint rule.
double ring_and_ball(double major, double minor, double radius, const Vec3& center) {
  constexpr int kHalfPlanes = 100000;
  const double across = std::hypot(center.x(), center.y());
  double sum = 0.0;
  for (int i = 0; i < kHalfPlanes; ++i) {
    const double angle = kPi * (i + 0.5) / kHalfPlanes, off = across * std::sin(angle);
    const double square = radius * radius - off * off;
    if (!(square > 0.0)) continue;
    const Vec2 tube(major, 0.0), ball(across * std::cos(angle), center.z());
    const Vec2 way = ball - tube;
    const double s = std::sqrt(square), d = way.norm();
    if (d >= minor + s) continue;
    const Vec2 e = way / d;
    sum += moment_of_segment(tube, minor, e, (d * d + minor * minor - s * s) / (2.0 * d * minor)) +
           moment_of_segment(ball, s, -e, (d * d - minor * minor + s * s) / (2.0 * d * s));
  }
  return sum * 2.0 * kPi / kHalfPlanes;
}

// The ball crosses the tube within a small part of a section, twice: in windows of poses a
// thousandth wide such a part falls between the places that are looked at.
TEST(TorusSections, ABallSharesSegmentsOfDiscsWithTheRing) {
  test::Random random(21);
  for (int i = 0; i < 200; i += test::cases(1, 7)) {
    const Vec3 center = i < 100 ? Vec3(0.1405 + 4e-5 * i, 0.0, 0.0) : random.in_box(0.2);
    const double radius = i < 100 ? 0.3 : random.uniform(0.15, 0.4);
    const double expected = ring_and_ball(kMajor, kMinor, radius, center);
    const Shape ball = Sphere({.radius = radius});
    const Pose X{random.rotation(), center};
    for (const VolumeMetrics& m :
         {evaluated(kRing, ball, X).total, evaluated(ball, kRing, X.inverse()).total}) {
      EXPECT_NEAR(m.volume, expected, m.volume_error + 1e-7 * expected) << center;
      EXPECT_NEAR(m.volume, expected, 1e-3 * expected) << center;
    }
  }
}

// V of a ring and a ball about c, in the ring's frame: in each half-plane through the axis two
// discs, by the midpoints of angles and of rho = R - r cos t.
double volume_with_ball(const Torus& ring, double radius, const Vec3& c) {
  constexpr int kSteps = 600;
  const double R = ring.major_radius(), r = ring.minor_radius();
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = 2.0 * kPi * (i + 0.5) / kSteps;
    const double along = c.x() * std::cos(angle) + c.y() * std::sin(angle);
    const double across = c.y() * std::cos(angle) - c.x() * std::sin(angle);
    const double disc2 = radius * radius - across * across;
    if (!(disc2 > 0.0)) continue;
    for (int k = 0; k < kSteps; ++k) {
      const double t = kPi * (k + 0.5) / kSteps, rho = R - r * std::cos(t), h = r * std::sin(t);
      const double high2 = disc2 - (rho - along) * (rho - along);
      if (!(high2 > 0.0)) continue;
      const double length =
          std::min(h, c.z() + std::sqrt(high2)) - std::max(-h, c.z() - std::sqrt(high2));
      sum += std::max(0.0, length) * rho * h;
    }
  }
  return sum * (2.0 * kPi / kSteps) * (kPi / kSteps);
}

// Balls that cut the tube all round: sixteen half-planes may agree by chance on a wrong sum.
TEST(TorusSections, AWholeTurnIsAsGoodAsItClaims) {
  test::Random random(31);
  struct Case {
    Torus ring;
    double radius;
    Vec3 at;
  };
  std::vector<Case> cases = {
      {Torus({.major_radius = 0.1, .minor_radius = 0.05}),
       0.15649541487659269,
       {-0.084487794450899448, 0.025756266013134216, 0.055180092352032528}},
      {Torus({.major_radius = 0.3, .minor_radius = 0.1}), 0.3, {0.1425, 0.0, 0.0}},
  };
  for (int i = 0; i < test::cases(150, 15); ++i) {
    const double R = random.uniform(0.1, 0.4), r = random.uniform(0.1, 1.0) * R;
    cases.push_back({Torus({.major_radius = R, .minor_radius = r}), random.uniform(0.6, 1.4) * R,
                     random.in_box(0.6 * R)});
  }
  for (const Case& c : cases) {
    const double expected = volume_with_ball(c.ring, c.radius, c.at);
    if (!(expected > 1e-3 * c.ring.own_metrics().volume)) continue;
    const Shape ball = Sphere({.radius = c.radius});
    const Pose X{Mat3::Identity(), c.at};
    for (const VolumeMetrics& m :
         {evaluated(c.ring, ball, X).total, evaluated(ball, c.ring, X.inverse()).total}) {
      EXPECT_LE(std::abs(m.volume - expected), m.volume_error + 2e-5 * expected)
          << "ring " << c.ring.major_radius() << " " << c.ring.minor_radius() << ", ball "
          << c.radius << " at " << c.at << ": " << m.volume << " for " << expected;
    }
  }
}

// The axis of the ring lies in a thin disc: V is the thickness times what two circles have in
// common. Its rim is farthest off where a search along it begins and ends.
TEST(TorusSections, AThinDiscThroughTheAxis) {
  const double R = 0.2, r = 0.1, disc = 0.1, half = 1e-4, x = 0.012, z = -0.011;
  const double d = std::hypot(R - x, z), a = (d * d + disc * disc - r * r) / (2.0 * d), b = d - a;
  const double common = disc * disc * std::acos(a / disc) - a * std::sqrt(disc * disc - a * a) +
                        r * r * std::acos(b / r) - b * std::sqrt(r * r - b * b);
  const Shape ring = Torus({.major_radius = R, .minor_radius = r});
  const Shape plate = Cylinder({.radius = disc, .half_length = half});
  for (int turn = 0; turn < 24; ++turn) {
    for (int own = 0; own < 24; ++own) {
      const Mat3 round = rotation_about(Vec3::UnitZ(), 2.0 * kPi * turn / 24);
      // the disc's axis across that of the ring
      Mat3 upright = Mat3::with_columns(Vec3::UnitX(), Vec3::UnitZ(), -Vec3::UnitY());
      const Mat3 spin = rotation_about(Vec3::UnitZ(), 2.0 * kPi * own / 24);
      const Pose X{round * upright * spin, round * Vec3(x, 0.0, z)};
      const VolumeMetrics m = evaluated(ring, plate, X).total;
      EXPECT_NEAR(m.volume, 2.0 * half * common, 2e-5 * m.volume) << turn << " " << own;
    }
  }
}

// One face of a plate holds the axis of the ring. The plate, wider than the ring, is so thin that V
// is its thickness times two circles, to the square of the one by the other.
TEST(TorusSections, AFaceThroughTheAxisOfAPlateIsWhereItIs) {
  const double area = 2.0 * kPi * kMinor * kMinor;
  for (const double half : {1e-4, 1e-5, 1e-6, 1e-7}) {
    const Shape plate = Cylinder({.radius = 0.5, .half_length = half});
    for (const double angle : {0.0, 0.3, 2.0}) {
      // the disc's axis across that of the ring
      Mat3 upright = Mat3::with_columns(Vec3::UnitX(), Vec3::UnitZ(), -Vec3::UnitY());
      const Mat3 R = test::turn(Vec3::UnitZ(), angle) * upright;
      for (const double from : {0.0, 1e-12, 1e-9, -1e-9}) {
        const Pose X{R, (half + from) * R.col(2)};
        const VolumeMetrics m = evaluated(kRing, plate, X).total;
        EXPECT_NEAR(m.volume, 2.0 * half * area, m.volume_error + 1e-8 * m.volume)
            << half << " " << angle << " " << from;
      }
    }
  }
}

// The end of a cone holds the axis of the ring: what the half-planes see of it tells nothing, and a
// range that looks smooth may not be.
TEST(TorusSections, AConeWhoseEndHoldsTheAxis) {
  static OctreeScratch scratch;
  const Shape ring = Torus({.major_radius = 0.359, .minor_radius = 0.15});
  for (const double top : {0.0, 2.8e-7, 0.02}) {
    const Shape cone = Frustum({.bottom_radius = 0.283, .top_radius = top, .half_length = 0.2698});
    for (const double off : {0.0, 1e-7, 1e-3}) {
      if (test::kSanitized && off != 1e-7) continue;
      // the cone's axis across that of the ring
      Mat3 R = {-0.922, 0.0, 0.387, 0.387, 0.0, 0.922, 0.0, 1.0, 0.0};
      R.col(0).normalize();
      R.col(2) = R.col(0).cross(R.col(1));
      const Pose X{R, Vec3(-0.2698 * R.col(2)) + Vec3(0.0, 0.0, off)};
      Interference bounded;
      octree_interference(ring, cone, X, {.tolerance = 1e-4}, scratch, bounded);
      for (const VolumeMetrics& m :
           {evaluated(ring, cone, X).total, evaluated(cone, ring, X.inverse()).total}) {
        EXPECT_NEAR(m.volume, bounded.total.volume, bounded.total.volume_error + m.volume_error)
            << top << " " << off;
      }
    }
  }
}

// A body whose nearest place to the middle of a ball of the tube is a corner: the half-plane
// through it meets nothing else, and the overlap lies beside it.
TEST(TorusSections, ACornerInTheTubeIsNotMissed) {
  static OctreeScratch scratch;
  const Shape ring = Torus({.major_radius = 0.27228824696060872, .minor_radius = 0.05});
  const Shape body =
      ConvexPolytope({{0.06, 0.074, 0.0318},
                      {-0.186, -0.00936, 0.021},
                      {0.1164, 0.0507, 0.1342},
                      {-0.036955437268140684, -0.03948445807008797, -0.25263869529206823},
                      {-0.0476, 0.0565, 0.1945},
                      {0.138, 0.0319, -0.1631},
                      {0.0949, -0.0462, 0.1894},
                      {-0.1644, -0.0274, -0.1005},
                      {-0.069256148499206208, -0.042289816502973004, -0.22744525700886276},
                      {-0.0383, -0.0761, 0.0455}});
  Mat3 R = {0.22102619235636844,  0.73736177258757007,  -0.63831421621248718,
            0.92538930711318512,  -0.36519372440609876, -0.10143063607698144,
            -0.30789941957240585, -0.56827032298098978, -0.76306407820448241};
  int seen = 0;
  for (const double deeper : {-1e-3, -3e-4, -1e-4, 0.0, 1e-4, 3e-4, 1e-3}) {
    const Vec3 way = Vec3(-0.0363301, -0.0381294, -0.244551).normalized();
    const Pose X{
        R, Vec3(-0.22750304009435771, -0.134189772608619, -0.12112660029508712) - deeper * way};
    Interference bounded;
    octree_interference(body, ring, X, {}, scratch, bounded);
    if (!(bounded.total.volume > 1e-9)) continue;
    ++seen;
    for (const VolumeMetrics& m :
         {evaluated(body, ring, X).total, evaluated(ring, body, X.inverse()).total}) {
      EXPECT_NEAR(m.volume, bounded.total.volume, bounded.total.volume_error + m.volume_error)
          << deeper;
    }
  }
  EXPECT_GE(seen, 4);
}

}  // namespace
}  // namespace volcontact::torus_sections_test
