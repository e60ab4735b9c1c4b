// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/clip/clip.h"

#include <gtest/gtest.h>

#include <functional>

#include "core/reference/column_oracle.h"
#include "core/support/gradient.h"
#include "core/support/matchers.h"
#include "core/support/random_shapes.h"
#include "core/support/sanitized.h"

namespace volcontact::clip_test {
namespace {

using test::polytope_of;
using test::Random;
using test::random_box;
using test::random_polytope;
using test::Tolerance;

// The oracle and the engine both round at 1e-16 of the solids; the smallest overlaps measured here
// are a thousandth of them across.
constexpr double kMinVolume = 1e-9;
constexpr Tolerance kExact{1e-10, 1.0};

// The pair, or its mirror image where the engine serves the other order.
template <typename A, typename B>
VolumeMetrics clipped(const A& a, const B& b, const Pose& X_AB) {
  ClipScratch scratch;
  if constexpr (requires { clip(a, b, X_AB, scratch); }) {
    return clip(a, b, X_AB, scratch);
  } else {
    return reversed(transformed(clip(b, a, X_AB.inverse(), scratch), X_AB));
  }
}

// Calls test(a, b, X_AB) for random solids and poses of every pair of types.
template <typename Test>
void for_random_pairs(int seed, int count, Test&& test) {
  Random random(seed);
  for (int i = 0; i < count; ++i) {
    test(HalfSpace(), random_box(random), random.pose(1.0));
    test(random_box(random), random_box(random), random.pose(1.2));
    test(HalfSpace(), random_polytope(8, random), random.pose(1.0));
    test(random_box(random), random_polytope(7, random), random.pose(1.2));
    test(random_polytope(7, random), random_polytope(6, random), random.pose(1.0));
  }
}

bool has_direction(const VolumeMetrics& m) { return m.area_vector.squaredNorm() > 0.0; }

TEST(Clip, EqualsTheColumnOracle) {
  int touching = 0;
  for_random_pairs(1, test::cases(60, 15), [&](const auto& a, const auto& b, const Pose& X) {
    const VolumeMetrics m = clipped(a, b, X);
    const VolumeMetrics expected = test::oracle(a, b, X);
    if (!m.touching()) {
      EXPECT_LT(expected.volume, 1e-13);
      return;
    }
    if (m.volume < kMinVolume) return;
    if (m.status == Status::kContained || !has_direction(m)) {
      EXPECT_NEAR(m.volume / expected.volume, 1.0, kExact.relative);
      EXPECT_LT((m.centroid - expected.centroid).norm(), kExact.relative);
      EXPECT_LT((m.inertia - expected.inertia).norm(), kExact.relative);
      return;
    }
    ++touching;
    EXPECT_TRUE(test::same(m, expected, kExact));
  });
  EXPECT_GT(touching, test::cases(150, 30));
}

TEST(Clip, AreaVectorAndMomentAreTheGradientOfTheVolume) {
  // V is a polynomial between changes of topology; a change within a step costs step^2 times the
  // jump of its third derivative.
  for_random_pairs(2, 60, [&](const auto& a, const auto& b, const Pose& X) {
    const VolumeMetrics m = clipped(a, b, X);
    if (m.volume < kMinVolume) return;
    const auto volume = [&](const Pose& pose) { return clipped(a, b, pose).volume; };
    const test::Gradient gradient = test::gradient_of_A(volume, X, 2e-5);
    EXPECT_LT((m.area_vector - gradient.shift).norm(), 1e-8);
    EXPECT_LT((m.area_moment - gradient.turn).norm(), 1e-8);
  });
}

TEST(Clip, TwoOrdersAgreeWithinTheirErrorBounds) {
  Random random(3);
  int touching = 0;
  for (int i = 0; i < 2000; ++i) {
    const Box a = random_box(random), b = random_box(random);
    const Pose X = random.pose(1.2);
    const VolumeMetrics m = clipped(a, b, X), swapped = clipped(b, a, X.inverse());
    EXPECT_LE(std::abs(m.volume - swapped.volume), m.volume_error + swapped.volume_error);
    if (m.volume < 1e-6) continue;
    ++touching;
    EXPECT_LT(m.volume_error, 1e-12 * m.volume + 1e-14);  // a bound that says something
    EXPECT_TRUE(test::same(reversed(transformed(swapped, X)), m, {1e-9, 1.0}));
  }
  EXPECT_GT(touching, 1000);
}

TEST(Clip, BoxAndItsPolytopeAreTheSame) {
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    const Box a = random_box(random), b = random_box(random);
    const Pose X = random.pose(1.0);
    const VolumeMetrics m = clipped(a, b, X);
    if (m.volume < 1e-6) continue;
    EXPECT_TRUE(test::same(clipped(a, polytope_of(b), X), m, {1e-10, 1.0}));
    EXPECT_TRUE(test::same(clipped(polytope_of(a), polytope_of(b), X), m, {1e-10, 1.0}));
    const VolumeMetrics ground = clipped(HalfSpace(), b, X);
    if (ground.volume < 1e-6) continue;
    EXPECT_TRUE(test::same(clipped(HalfSpace(), polytope_of(b), X), ground, {1e-10, 1.0}));
  }
}

TEST(Clip, LargeFloorBoxIsAHalfSpace) {
  Random random(5);
  const Box floor({.half_sizes = Vec3(50.0, 50.0, 20.0)});
  const Pose top{Mat3::Identity(), Vec3(0, 0, 20)};  // of the half-space in the floor
  for (int i = 0; i < 200; ++i) {
    const Box b = random_box(random);
    Pose X = random.pose(1.0);  // in the half-space
    const VolumeMetrics ground = clipped(HalfSpace(), b, X);
    if (ground.volume < 1e-6) continue;
    // 40 m from the origin of the floor: positions round at 1e-14 m.
    X.translation += Vec3(30.0, -25.0, 0.0);
    const VolumeMetrics m = clipped(floor, b, top * X);
    const VolumeMetrics moved = transformed(ground, Pose{Mat3::Identity(), Vec3(30, -25, 20)});
    EXPECT_NEAR(m.volume, moved.volume, 1e-12);
    EXPECT_LT((m.centroid - moved.centroid).norm(), 1e-9);
    EXPECT_LT((m.inertia - moved.inertia).norm(), 1e-11);
    EXPECT_LT((m.area_vector - moved.area_vector).norm(), 1e-11);
    if (ground.status == Status::kContained) continue;  // the box has no direction then
    EXPECT_LT((m.area_moment - moved.area_moment).norm(), 1e-9);
    EXPECT_NEAR(m.depth_moment, moved.depth_moment, 1e-12);
  }
}

TEST(Clip, RestingCubeOfTheStaticCheck) {
  // A flat 0.2 m cube of 1 kg on k = 1e7 N/m^3 rests 24.525 um deep: m g = k V.
  const Box cube({.half_sizes = Vec3::Constant(0.1)});
  const VolumeMetrics m =
      clipped(HalfSpace(), cube, Pose{Mat3::Identity(), Vec3(7, -3, 0.1 - 24.525e-6)});
  EXPECT_NEAR(1e7 * m.volume, 9.81, 1e-9);
  EXPECT_LT((m.centroid - Vec3(7, -3, -0.5 * 24.525e-6)).norm(), 1e-15);
  EXPECT_NEAR(m.depth_moment, 0.5 * 0.04 * 24.525e-6 * 24.525e-6, 1e-22);
  EXPECT_DOUBLE_EQ(m.flatness(), 1.0);
}

// ---- energy
// --------------------------------------------------------------------------------------

TEST(Clip, BuoyancyAtTheCentroidIsTheGradientOfTheDepthMoment) {
  // On a plane f = V through the centroid is conservative (Archimedes), overhanging sides and full
  // immersion included.
  Random random(6);
  for (int i = 0; i < 200; ++i) {
    const Box box = random_box(random);
    const Pose X = random.pose(1.0);
    const VolumeMetrics m = clipped(HalfSpace(), box, X);
    if (m.volume < kMinVolume) continue;
    const auto potential = [&](const Pose& pose) {
      return clipped(HalfSpace(), box, pose).depth_moment;
    };
    const test::Gradient gradient = test::gradient_of_A(potential, X, 1e-4);
    const Vec3 force_on_A = -m.volume * Vec3::UnitZ();
    EXPECT_LT((gradient.shift + force_on_A).norm(), 1e-9);
    EXPECT_LT((gradient.turn + m.centroid.cross(force_on_A)).norm(), 1e-9);
  }
}

TEST(Clip, DepthMomentGrowsWithTheVolumeAlongTheNormal) {
  // dQ/dn = -V for every pair when the normal is held: here for boxes on edges and corners, where
  // the normal turns little along itself.
  const Box a({.half_sizes = Vec3(0.5, 0.4, 0.3)});
  for (const bool from_b : {false, true}) {
    // Edge against edge, crossed at a right angle: the normal stays z by symmetry.
    const Mat3 on_edge = test::turn(Vec3::UnitX(), kPi / 4);
    const Mat3 R = test::turn(Vec3::UnitZ(), kPi / 2) * on_edge;
    std::vector<Vec3> corners = polytope_of(a).vertices();
    for (Vec3& v : corners) v = on_edge * v;
    const ConvexPolytope roof(corners);
    const double sign = from_b ? -1.0 : 1.0;
    const auto at = [&](double z) { return clipped(roof, a, Pose{R, Vec3(0, 0, sign * z)}); };
    const double z = 2.0 * (0.4 + 0.3) / std::sqrt(2.0) - 0.08;
    const VolumeMetrics m = at(z);
    EXPECT_LT((m.normal() + sign * Vec3::UnitZ()).norm(), 1e-12);
    const double slope = test::derivative([&](double h) { return at(z + h).depth_moment; }, 1e-3);
    EXPECT_NEAR(slope, -m.volume, 1e-9 * m.volume);
  }
}

// Power of f = V on B against the half-space, for a motion of B along a closed path.
struct Loop {
  Box box{{.half_sizes = Vec3(0.1, 0.08, 0.05)}};

  Pose pose(double s) const {
    return {test::turn(Vec3::UnitY(), 0.35 + 0.12 * std::sin(s)) *
                test::turn(Vec3::UnitX(), 0.2 * std::cos(s)),
            Vec3(0.01 * std::sin(s), 0.0, 0.055 + 0.004 * std::cos(s))};
  }
  // Velocity and turning rate of B per s, by differences of the path.
  Twist twist(double s) const {
    constexpr double kStep = 1e-3;
    const auto entry = [&](auto&& of) { return test::derivative(of, kStep); };
    Twist twist;
    Mat3 rate;
    for (int i = 0; i < 3; ++i) {
      twist.linear[i] = entry([&](double h) { return pose(s + h).translation[i]; });
      for (int j = 0; j < 3; ++j) {
        rate(i, j) = entry([&](double h) { return pose(s + h).rotation(i, j); });
      }
    }
    const Mat3 w = rate * pose(s).rotation.transpose();
    twist.angular = 0.5 * Vec3(w(2, 1) - w(1, 2), w(0, 2) - w(2, 0), w(1, 0) - w(0, 1));
    return twist;
  }
  double power(double s) const {
    const Pose X = pose(s);
    const VolumeMetrics m = clipped(HalfSpace(), box, X);
    return m.volume * twist(s).at(m.centroid - X.translation).z();
  }
};

TEST(Clip, LoopWorkOfATiltingAndHeavingBoxIsZero) {
  const Loop loop;
  double work = 0.0, most = 0.0, start = 0.0;
  constexpr int kSteps = 2000;
  const auto energy = [&](double s) {
    return clipped(HalfSpace(), loop.box, loop.pose(s)).depth_moment;
  };
  start = energy(0.0);
  for (int i = 0; i < kSteps; ++i) {
    const double from = 2.0 * kPi * i / kSteps, to = 2.0 * kPi * (i + 1) / kSteps;
    test::gauss({from, to}, [&](double weight, double s) { work += weight * loop.power(s); });
    most = std::max(most, energy(to));
    EXPECT_NEAR(work, start - energy(to), 1e-11 * most) << "at step " << i;
  }
  EXPECT_GT(most, 1e-7);
  EXPECT_NEAR(work, 0.0, 1e-12 * most);
}

// ---- limits
// --------------------------------------------------------------------------------------

TEST(Clip, TouchingIsNothing) {
  const Box a({.half_sizes = Vec3(0.5, 0.4, 0.3)});
  EXPECT_FALSE(clipped(a, a, Pose{Mat3::Identity(), Vec3(1.0, 0, 0)}).touching());
  EXPECT_FALSE(clipped(HalfSpace(), a, Pose{Mat3::Identity(), Vec3(0, 0, 0.3)}).touching());
  EXPECT_FALSE(
      clipped(polytope_of(a), polytope_of(a), Pose{Mat3::Identity(), Vec3(0, 0.8, 0)}).touching());
  // Corner to corner, edge to face.
  EXPECT_FALSE(clipped(a, a, Pose{Mat3::Identity(), Vec3(1.0, 0.8, 0.6)}).touching());
  EXPECT_FALSE(
      clipped(a, a,
              Pose{test::turn(Vec3::UnitX(), kPi / 4), Vec3(0, 0, 0.3 + 0.7 / std::sqrt(2.0))})
          .volume > 1e-30);
}

// Plates that lie on a face by a few units in the last place: what is reported, or none, is the
// plate's area times what the numbers of the pose say, within the error.
TEST(Clip, NothingIsKnownToTheRounding) {
  Random random(19);
  int none = 0;
  for (int i = 0; i < test::cases(3000, 500); ++i) {
    const Vec3 half(random.uniform(0.05, 0.4), random.uniform(0.05, 0.4),
                    random.log_uniform(1e-6, 1e-2));
    const double thick = random.log_uniform(0.01, 1.0);
    const Box plate({.half_sizes = half}), table({.half_sizes = Vec3(3.0, 3.0, thick)});
    const double height = thick + half.z() - random.log_uniform(1e-18, 1e-13);
    const long double depth = static_cast<long double>(thick) + half.z() - height;
    const double expected = static_cast<double>(std::max(0.0L, depth)) * 4.0 * half.x() * half.y();
    const double slack = 1e-15 * half.z() * half.x() * half.y();
    const Mat3 R = test::turn(Vec3::UnitZ(), random.uniform(0.0, 2.0 * kPi)) *
                   Vec3(1.0, -1.0, -1.0).asDiagonal();
    const Vec3 at(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), height);
    for (const VolumeMetrics& m :
         {clipped(table, plate, {R, at}), clipped(polytope_of(table), plate, {R, at}),
          clipped(polytope_of(table), polytope_of(plate), {R, at}),
          clipped(HalfSpace(), plate, {R, at - Vec3(0.0, 0.0, thick)}),
          clipped(HalfSpace(), polytope_of(plate), {R, at - Vec3(0.0, 0.0, thick)})}) {
      // Of the half-space the height is another number, as far off as its last place.
      EXPECT_NEAR(m.volume, expected, m.volume_error + slack) << i;
      none += !m.touching();
    }
  }
  EXPECT_GT(none, test::cases(1000, 160));
}

TEST(Clip, ZeroSizesAreNothing) {
  Random random(7);
  const Box solid({.half_sizes = Vec3(0.5, 0.4, 0.3)});
  for (const Vec3& half : {Vec3(0, 0.1, 0.1), Vec3(0.1, 0, 0), Vec3(0, 0, 0)}) {
    const Box flat({.half_sizes = half});
    for (int i = 0; i < 50; ++i) {
      const Pose X = random.pose(0.3);
      EXPECT_FALSE(clipped(solid, flat, X).touching());
      EXPECT_FALSE(clipped(flat, solid, X).touching());
      EXPECT_FALSE(clipped(flat, flat, X).touching());
      EXPECT_FALSE(clipped(HalfSpace(), flat, X).touching());
      EXPECT_FALSE(clipped(flat, polytope_of(solid), X).touching());
    }
  }
}

TEST(Clip, IdenticalPosesAreContained) {
  Random random(8);
  for (int i = 0; i < 100; ++i) {
    const Box box = random_box(random);
    const ConvexPolytope solid = random_polytope(12, random);
    // Exactly equal, and equal up to the rounding of a product of rotations.
    const Mat3 r = random.rotation();
    for (const Mat3& R : {Mat3(Mat3::Identity()), Mat3(r.transpose() * r)}) {
      const Pose X{R, Vec3::Zero()};
      for (const VolumeMetrics& m : {clipped(box, box, X), clipped(box, polytope_of(box), X)}) {
        EXPECT_NEAR(m.volume, box.own_metrics().volume, 1e-13);
        EXPECT_LT((m.inertia - box.own_metrics().inertia).norm(), 1e-13);
        EXPECT_EQ(m.status, Status::kContained);
        EXPECT_EQ(m.area_vector, Vec3(Vec3::Zero()));
      }
      const VolumeMetrics m = clipped(solid, solid, X);
      EXPECT_NEAR(m.volume, solid.own_metrics().volume, 1e-13);
      EXPECT_EQ(m.status, Status::kContained);
    }
  }
}

TEST(Clip, OneInsideTheOtherIsTheInnerOne) {
  Random random(9);
  const Box large({.half_sizes = Vec3(2, 2, 2)});
  for (int i = 0; i < 50; ++i) {
    const Box box = random_box(random);
    const ConvexPolytope solid = random_polytope(10, random);
    const Pose X{random.rotation(), random.in_box(0.2)};
    const VolumeMetrics b_inside = clipped(large, box, X), a_inside = clipped(box, large, X);
    const VolumeMetrics expected = transformed(box.own_metrics(), X);
    EXPECT_NEAR(b_inside.volume, expected.volume, 1e-14);
    EXPECT_LT((b_inside.centroid - expected.centroid).norm(), 1e-14);
    EXPECT_LT((b_inside.inertia - expected.inertia).norm(), 1e-14);
    EXPECT_EQ(b_inside.area, 0.0);
    EXPECT_NEAR(b_inside.counter_area, polytope_of(box).surface_area(), 1e-12);
    EXPECT_NEAR(a_inside.area, polytope_of(box).surface_area(), 1e-12);
    for (const VolumeMetrics& m :
         {b_inside, a_inside, clipped(large, solid, X), clipped(polytope_of(large), solid, X),
          clipped(solid, polytope_of(large), X)}) {
      EXPECT_EQ(m.status, Status::kContained);
      EXPECT_EQ(m.area_vector, Vec3(Vec3::Zero()));
      EXPECT_EQ(m.area_moment, Vec3(Vec3::Zero()));
      EXPECT_EQ(m.depth, 0.0);
      EXPECT_EQ(m.depth_moment, 0.0);
      EXPECT_TRUE(is_finite(m));
    }
  }
}

TEST(Clip, ImmersedInAHalfSpaceIsTheWholeSolid) {
  Random random(10);
  for (int i = 0; i < 50; ++i) {
    const ConvexPolytope solid = random_polytope(10, random);
    Pose X = random.pose(1.0);
    X.translation.z() = -2.0;
    const VolumeMetrics m = clipped(HalfSpace(), solid, X);
    const VolumeMetrics own = transformed(solid.own_metrics(), X);
    EXPECT_NEAR(m.volume, own.volume, 1e-14);
    EXPECT_LT((m.inertia - own.inertia).norm(), 1e-14);
    EXPECT_EQ(m.status, Status::kContained);
    EXPECT_NEAR(m.depth_moment, -own.centroid.z() * own.volume, 1e-13);
    const double extent =
        solid.support_height(X.rotation.row(2)) + solid.support_height(-X.rotation.row(2));
    EXPECT_NEAR(m.depth, extent, 1e-13);
  }
}

TEST(Clip, EvenlyPiercedPlateHasNoDirection) {
  // A peg right through a plate: S cancels, and its rounding must not be taken for a normal.
  const Box plate({.half_sizes = Vec3(1, 1, 0.05)}), peg({.half_sizes = Vec3(0.1, 0.1, 1)});
  const VolumeMetrics m =
      clipped(plate, peg, Pose{test::turn(Vec3(1, 2, 3), 0.1), Vec3(0.1, 0, 0)});
  EXPECT_GT(m.volume, 0.0);
  EXPECT_EQ(m.normal(), Vec3(Vec3::Zero()));
  EXPECT_EQ(m.flatness(), 0.0);
  EXPECT_TRUE(is_finite(m));
}

TEST(Clip, CoplanarFacesGiveExactVolumes) {
  // Blocks flush on one, two and three sides; every value a product of lengths.
  const Box a({.half_sizes = Vec3(0.5, 0.4, 0.3)}), b({.half_sizes = Vec3(0.25, 0.4, 0.3)});
  const auto at = [&](double x, double y, double z) {
    return clipped(a, b, Pose{Mat3::Identity(), Vec3(x, y, z)});
  };
  EXPECT_NEAR(at(0.7, 0, 0).volume, 0.05 * 0.8 * 0.6, 1e-16);
  EXPECT_NEAR(at(0.7, 0.1, 0).volume, 0.05 * 0.7 * 0.6, 1e-16);
  EXPECT_NEAR(at(0.25, 0, 0).volume, 0.5 * 0.8 * 0.6, 1e-16);
  EXPECT_LT((at(0.7, 0, 0).normal() - Vec3(-1, 0, 0)).norm(), 1e-15);
  EXPECT_NEAR(at(0.7, 0, 0).depth, 0.05, 1e-15);
  EXPECT_NEAR(at(0.7, 0, 0).depth_moment, 0.48 * 0.05 * 0.05 / 2.0, 1e-16);
  // The same turned by a random rotation, in the frame of a polytope.
  Random random(11);
  for (int i = 0; i < 100; ++i) {
    const Mat3 r = random.rotation();
    std::vector<Vec3> corners_a = polytope_of(a).vertices(), corners_b = polytope_of(b).vertices();
    for (Vec3& v : corners_a) v = r * v;
    for (Vec3& v : corners_b) v = r * (v + Vec3(0.7, 0, 0));
    const VolumeMetrics m = clipped(ConvexPolytope(corners_a), ConvexPolytope(corners_b), Pose{});
    EXPECT_NEAR(m.volume, 0.024, 1e-15);
    EXPECT_NEAR(m.depth_moment, 0.48 * 0.05 * 0.05 / 2.0, 1e-15);
    EXPECT_LT((m.normal() - r * Vec3(-1, 0, 0)).norm(), 1e-12);
  }
}

TEST(Clip, VertexOnAFaceIsContinuous) {
  // A corner of B exactly on A's top face, and one rounding step on either side.
  const Box a({.half_sizes = Vec3(1, 1, 1)});
  const ConvexPolytope tip({Vec3(0, 0, 0), Vec3(1, 0, 1), Vec3(-1, 0, 1), Vec3(0, 1, 1)});
  for (double depth : {-1e-15, -1e-16, 0.0, 1e-16, 1e-15, 1e-9}) {
    const VolumeMetrics m = clipped(a, tip, Pose{Mat3::Identity(), Vec3(0.2, 0.1, 1.0 - depth)});
    // The tip cut at depth d is a pyramid of volume d^3 / 3 (base d^2).
    const double d = std::max(0.0, depth);
    EXPECT_NEAR(m.volume, d * d * d / 3.0, 1e-15 * d * d + 1e-44);
    EXPECT_TRUE(is_finite(m));
    if (m.touching()) {
      EXPECT_LT((m.centroid - Vec3(0.2, 0.1, 1.0)).norm(), 1e-8);
    }
  }
}

// Largest change of a function of s between samples.
double largest_jump(const std::function<double(double)>& f, double from, double to, int samples) {
  double largest = 0.0, last = f(from);
  for (int i = 1; i <= samples; ++i) {
    const double value = f(from + (to - from) * i / samples);
    largest = std::max(largest, std::abs(value - last));
    last = value;
  }
  return largest;
}

TEST(Clip, IsContinuousThroughTouchEdgesAndFullImmersion) {
  const Box a({.half_sizes = Vec3(0.5, 0.5, 0.3)}), b({.half_sizes = Vec3(0.2, 0.15, 0.1)});
  const Mat3 r = test::turn(Vec3(1, 0.5, 0.2), 0.3);
  // Down through the top face, inside and out below; and along the top face over its edge.
  const auto down = [&](double s) { return Pose{r, Vec3(0.1, 0.05, 0.6 - 1.2 * s)}; };
  const auto along = [&](double s) { return Pose{r, Vec3(-0.9 + 1.8 * s, 0.1, 0.38)}; };
  for (const auto& path : {std::function<Pose(double)>(down), std::function<Pose(double)>(along)}) {
    const auto volume = [&](double s) { return clipped(a, b, path(s)).volume; };
    const auto first = [&](double s) {
      const VolumeMetrics m = clipped(a, b, path(s));
      return m.volume * m.centroid.x();
    };
    // Halving the step halves the largest change: no jump, however small.
    for (const auto& f :
         {std::function<double(double)>(volume), std::function<double(double)>(first)}) {
      const double coarse = largest_jump(f, 0.0, 1.0, 2000), fine = largest_jump(f, 0.0, 1.0, 4000);
      EXPECT_LT(fine, 0.6 * coarse);
      EXPECT_GT(coarse, 0.0);
    }
  }
  // The depth moment where there is a direction: over the edge, where faces come and go.
  const auto depth_moment = [&](double s) { return clipped(a, b, along(s)).depth_moment; };
  EXPECT_LT(largest_jump(depth_moment, 0.0, 1.0, 4000),
            0.6 * largest_jump(depth_moment, 0.0, 1.0, 2000));
}

TEST(Clip, ShallowFaceContactKeepsItsDigitsFarFromTheOrigin) {
  // 1 um deep, 10 m from the origin of the plate; positions there round at 1e-15 m.
  const Box plate({.half_sizes = Vec3(20, 20, 0.5)}), box({.half_sizes = Vec3(0.1, 0.2, 0.05)});
  const Pose X{Mat3::Identity(), Vec3(10.0, -7.0, 0.55 - 1e-6)};
  const VolumeMetrics m = clipped(plate, box, X);
  EXPECT_NEAR(m.volume / (0.2 * 0.4 * 1e-6), 1.0, 1e-9);
  EXPECT_LT((m.centroid - Vec3(10, -7, 0.5 - 0.5e-6)).norm(), 1e-14);
  EXPECT_NEAR(m.inertia(2, 2) / (m.volume / 3.0 * (0.01 + 0.04)), 1.0, 1e-12);
  EXPECT_NEAR(m.depth / 1e-6, 1.0, 1e-9);
}

// A small box that stands in the face of a large one, turned about its axis and tilted, with all of
// its lower face inside: one plane cuts it, and five of its own would cut the large box. V is that
// face times the depth of its middle along the small box's axis.
TEST(Clip, ASmallBoxInAFaceOfALargeOneIsAPrism) {
  const Vec3 half(0.1, 0.08, 0.05), large(0.4, 0.5, 0.3);
  const Box small({.half_sizes = half}), block({.half_sizes = large});
  Random random(14);
  for (const double most_tilt : {0.0, 1e-15, 1e-9, 1e-3, 0.1}) {
    for (int i = 0; i < 50; ++i) {
      // Upside down in the small box's frame: its upper face is in the block's lower one.
      const double tilt = most_tilt * random.uniform(-1.0, 1.0), turn = random.uniform(-3.0, 3.0);
      const Mat3 R = rotation_about(Vec3::UnitX(), tilt) *
                     rotation_about(Vec3::UnitZ(), i % 5 == 0 ? 0.0 : turn);
      const double depth = 0.012 + random.uniform(0.0, 0.02);
      const Vec3 normal = -R.col(2);  // out of the block's lower face
      const double d = depth * -normal.z();
      const Vec3 lower = Vec3(0.0, 0.0, half.z()) + d * normal;  // below the middle of that face
      const Vec3 aside = i % 7 == 0 ? 0.0 * R.col(0) : R.col(0) * random.uniform(-0.2, 0.2);
      const Pose X{R, lower + aside - large.z() * normal};
      const double expected = 4.0 * half.x() * half.y() * depth;
      const VolumeMetrics m = clipped(small, block, X);
      const VolumeMetrics n = transformed(clipped(block, small, X.inverse()), X);
      EXPECT_NEAR(m.volume, expected, 1e-12 * expected) << tilt << " " << turn;
      EXPECT_NEAR(n.volume, expected, 1e-12 * expected) << tilt << " " << turn;
      EXPECT_LT((m.centroid - n.centroid).norm(), 1e-13);
      EXPECT_LT((m.inertia - n.inertia).norm(), 1e-11 * m.inertia.norm());
      EXPECT_LT((m.area_vector + n.area_vector).norm(), 1e-11 * m.area);
      // S of the small box is its sides and the face inside: as large as the cut, along the normal.
      EXPECT_LT((m.area_vector + 4.0 * half.x() * half.y() / -normal.z() * normal).norm(),
                1e-11 * m.area);
      EXPECT_NEAR(m.depth_moment, n.depth_moment, 1e-10 * m.depth_moment);
      EXPECT_NEAR(m.depth, n.depth, 1e-12);
    }
  }
}

TEST(Clip, ScratchKeepsNoState) {
  // The same query before and after others gives the same bits.
  Random random(12);
  ClipScratch scratch;
  const Box a = random_box(random), b = random_box(random);
  const Pose X{random.rotation(), Vec3(0.3, 0.2, 0.4)};
  const VolumeMetrics first = clip(a, b, X, scratch);
  for (int i = 0; i < 20; ++i) {
    clip(random_polytope(30, random), random_polytope(20, random), random.pose(0.5), scratch);
  }
  const VolumeMetrics again = clip(a, b, X, scratch);
  EXPECT_EQ(first.volume, again.volume);
  EXPECT_EQ(first.inertia, again.inertia);
  EXPECT_EQ(first.depth_moment, again.depth_moment);
  EXPECT_EQ(first.area_moment, again.area_moment);
}

}  // namespace
}  // namespace volcontact::clip_test
