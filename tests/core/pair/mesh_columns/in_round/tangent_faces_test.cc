// SPDX-License-Identifier: Apache-2.0
// Faces of a mesh that touch a round face along a line or in a point: the search for what they cut
// off must end. Volumes are closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <ctime>

#include "core/support/evaluated.h"
#include "core/support/meshes.h"
#include "core/support/sanitized.h"

namespace volcontact::tangent_faces_test {
namespace {

using test::box_soup;
using test::mesh_of;
using test::shifted;

// Of the processor; without an end it were 10 to hundreds, and under the sanitizers ten times that.
const double kMostSeconds = test::kSanitized ? 10.0 : 0.5;

Interference in_time(const Shape& mesh, const Shape& round, const Pose& X) {
  const std::clock_t begin = std::clock();
  const Interference result = test::evaluated(mesh, round, X);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, kMostSeconds)
      << name_of(round);
  return result;
}

struct Round {
  Shape solid;
  double radius, volume;
};
std::vector<Round> round_solids() {
  const double r = 0.15, h = 0.2, ball = 4.0 / 3.0 * kPi * r * r * r;
  return {{Cylinder({.radius = r, .half_length = h}), r, kPi * r * r * 2.0 * h},
          {Capsule({.radius = r, .half_length = h}), r, kPi * r * r * 2.0 * h + ball},
          {Sphere({.radius = r}), r, ball},
          {Ellipsoid({.semi_axes = Vec3(r, 0.2, 0.1)}), r, 4.0 / 3.0 * kPi * r * 0.2 * 0.1}};
}

// A box from the middle of the solid to its side: half of it.
TEST(TangentFaces, ABoxThatEndsAtTheSideTakesHalf) {
  for (const Round& round : round_solids()) {
    const Shape mesh = mesh_of(box_soup(Vec3(0.5 * round.radius, 0.4, 0.5), 2));
    for (const double off : {0.0, 1e-16, -1e-16, 1e-13, -1e-13, 1e-10, -1e-10, 1e-8, -1e-8}) {
      for (const double turned : {0.0, 1.234}) {
        Pose X = shifted(-0.5 * round.radius + off, 0.0, 0.0);
        if (turned != 0.0 && round.volume != round_solids()[3].volume) {
          X.rotation = test::turn(Vec3::UnitZ(), turned);
        }
        const VolumeMetrics m = in_time(mesh, round.solid, X).total;
        EXPECT_NEAR(m.volume, 0.5 * round.volume, m.volume_error + 1e-7 * round.volume)
            << name_of(round.solid) << " " << off;
        EXPECT_LE(m.volume_error, 1e-3 * m.volume);
      }
    }
  }
}

// All sides of a box touch it: the whole solid.
TEST(TangentFaces, ABoxAroundHoldsAll) {
  for (const Round& round : round_solids()) {
    const double width = std::holds_alternative<Ellipsoid>(round.solid) ? 0.2 : round.radius;
    for (const double off : {0.0, 1e-15, -1e-15, 1e-12, -1e-12}) {
      const Shape mesh = mesh_of(box_soup(Vec3(round.radius + off, width + off, 0.5), 3));
      const VolumeMetrics m = in_time(mesh, round.solid, Pose{}).total;
      EXPECT_NEAR(m.volume, round.volume, m.volume_error + 1e-9 * round.volume)
          << name_of(round.solid) << " " << off;
    }
  }
}

// Of a half ball about the origin, in a bar of these half sizes: a sum over disks and their strips.
double half_ball_in_bar(double r, double a, double b) {
  constexpr int kDisks = 400, kStrips = 400;
  double sum = 0.0;
  for (int i = 0; i < kDisks; ++i) {
    const double z = r * (i + 0.5) / kDisks, rho = std::sqrt(r * r - z * z);
    const double wide = std::min(a, rho);
    for (int j = 0; j < kStrips; ++j) {
      const double x = wide * (j + 0.5) / kStrips;
      sum += wide / kStrips * std::min(b, std::sqrt(rho * rho - x * x));
    }
  }
  return 4.0 * r / kDisks * sum;
}

// Up to the seam between ball and tube, which touch the edges of the bar there.
TEST(TangentFaces, ACapsuleWithItsEndInABarAsWideAcross) {
  const double a = 0.05, b = 0.0844, r = std::hypot(a, b);
  const Capsule capsule({.radius = r, .half_length = 0.3763});
  const Shape bar = mesh_of(box_soup(Vec3(a, b, 0.4)));
  const double volume = half_ball_in_bar(r, a, b);
  for (const double off : {0.0, 1e-15, 1e-13, 1e-12, 1.7e-11, -1.7e-11, 1e-10, 1e-8}) {
    for (int i = 0; i < 8; ++i) {
      const Vec3 to(0.04 * off, off, 0.4 + capsule.half_length() + (i % 3 - 1) * off);
      const Pose X{
          test::turn(Vec3::UnitZ(), 0.8 * i) * test::turn(Vec3::UnitX(), i < 4 ? kPi : 0.0), to};
      const VolumeMetrics m = in_time(bar, capsule, X).total;
      EXPECT_NEAR(m.volume, volume, m.volume_error + 2e-5 * volume) << off << " " << i;
    }
  }
}

// The wall of a cone on a face of a large box, and half of it outside by a hair or not at all.
TEST(TangentFaces, AConeLiesOnAFace) {
  for (const double top : {0.1, 0.0}) {
    const Frustum cone({.bottom_radius = 0.3, .top_radius = top, .half_length = 0.25});
    const double volume = kPi * 0.5 / 3.0 * (0.3 * 0.3 + 0.3 * top + top * top);
    const Vec3 normal = Vec3(0.5, 0.0, 0.3 - top).normalized();
    const Vec3 on_wall(0.5 * (0.3 + top), 0.0, 0.0);
    const Mat3 turned = Mat3::with_columns(normal, Vec3::UnitY(), normal.cross(Vec3::UnitY()));
    for (const double off : {0.0, 1e-15, -1e-15, 1e-12}) {
      const Pose X_CB{turned, on_wall - (1.0 - off) * normal};
      const Shape mesh = mesh_of(box_soup(Vec3(1.0, 1.0, 1.0), 2));
      const VolumeMetrics m = in_time(mesh, cone, X_CB.inverse()).total;
      EXPECT_NEAR(m.volume, volume, m.volume_error + 1e-9 * volume) << top << " " << off;
    }
  }
}

// Faces across the axis of a cone but for rounding do not touch it, they cut it: the slab between.
TEST(TangentFaces, FacesAcrossAConeCutIt) {
  for (const double top : {0.36, 0.2, 0.0}) {
    const Frustum cone({.bottom_radius = 0.3, .top_radius = top, .half_length = 0.25});
    const double slope = (top - 0.3) / 0.5;
    for (const double middle : {0.0, 0.07}) {
      for (const double half : {0.05, 0.1}) {
        for (int i = 0; i < test::cases(40, 8); ++i) {
          const double angle = 0.1 * i;
          const Mat3 turned = test::turn(Vec3::UnitZ(), angle) *
                              test::turn(Vec3::UnitX(), i % 2 == 0 ? 0.5 * kPi : -0.5 * kPi) *
                              test::turn(Vec3::UnitY(), 0.7 * angle);
          const Pose X{turned, Vec3(0.01 * i, 0.0, middle)};
          const Shape mesh = mesh_of(box_soup(Vec3(1.0, half, 1.0), 1 + i % 3));
          const double r = 0.5 * (0.3 + top) + slope * (middle - half), R = r + slope * 2.0 * half;
          const double volume = kPi * 2.0 * half / 3.0 * (r * r + r * R + R * R);
          const VolumeMetrics m = in_time(cone, mesh, X).total;
          EXPECT_NEAR(m.volume, volume, m.volume_error + 1e-9 * volume) << top << " " << i;
        }
      }
    }
  }
}

}  // namespace
}  // namespace volcontact::tangent_faces_test
