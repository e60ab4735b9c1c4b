// SPDX-License-Identifier: Apache-2.0
// Faces of a mesh that hold the circle in the middle of a torus's tube, or touch it: the lines to
// the wall begin there.
#include <gtest/gtest.h>

#include <cmath>

#include "core/support/evaluated.h"
#include "core/support/meshes.h"
#include "core/support/sanitized.h"

namespace volcontact::grazing_faces_test {
namespace {

using test::box_soup;
using test::evaluated;
using test::mesh_of;
using test::shifted;

const double kOffsets[] = {0.0, 1e-15, -1e-12, 1e-9, -1e-7, 1e-6, -1e-5, 3e-5, -1e-4, 3e-4, -1e-3};

// The top of a box around the lower half: half of the torus, and a slice of the other.
TEST(GrazingFaces, AFaceThroughTheMiddleOfTheTubeTakesHalf) {
  for (const double r : {0.1, 0.25, 0.3}) {
    if (test::kSanitized && r != 0.25) continue;
    const Torus torus({.major_radius = 0.3, .minor_radius = r});
    const Shape mesh = mesh_of(box_soup(Vec3(0.8, 0.8, 0.4), 2));
    for (const double off : kOffsets) {
      const VolumeMetrics m = evaluated(torus, mesh, shifted(0.0, 0.0, off - 0.4)).total;
      // Discs below a height: pi r^2 / 2 + h sqrt(r^2 - h^2) + r^2 asin(h / r), about the axis.
      const double disc =
          0.5 * kPi * r * r + off * std::sqrt(r * r - off * off) + r * r * std::asin(off / r);
      const double expected = 2.0 * kPi * 0.3 * disc;
      EXPECT_NEAR(m.volume, expected, m.volume_error) << r << " " << off;
      EXPECT_LE(m.volume_error, 1e-3 * m.volume) << r << " " << off;
      const double area = 2.0 * kPi * 0.3 * 2.0 * std::sqrt(r * r - off * off);
      EXPECT_NEAR(std::abs(m.area_vector.z()), area, 2e-3 * area) << r << " " << off;
    }
  }
}

// The box itself goes another way: by half-planes.
TEST(GrazingFaces, AFaceThatTouchesTheCircleIsThatOfTheBox) {
  for (const double r : {0.1, 0.3}) {
    if (test::kSanitized && r == 0.1) continue;
    const Torus torus({.major_radius = 0.3, .minor_radius = r});
    const Vec3 half(0.5, 0.35, 0.25);
    const Shape mesh = mesh_of(box_soup(half, 2)), box = Box({.half_sizes = half});
    for (const double side : {1.0, -1.0}) {
      if (test::kSanitized && side < 0.0) continue;
      for (const double off : kOffsets) {
        const Pose X = shifted(side * 0.3 + 0.5 + off, 0.05, 0.02);
        const VolumeMetrics m = evaluated(torus, mesh, X).total;
        const VolumeMetrics expected = evaluated(torus, box, X, Engine::kLines, 1e-6).total;
        EXPECT_NEAR(m.volume, expected.volume, m.volume_error + expected.volume_error)
            << r << " " << side << " " << off;
        EXPECT_LE(m.volume_error, 2e-3 * m.volume) << r << " " << side << " " << off;
      }
    }
  }
}

}  // namespace
}  // namespace volcontact::grazing_faces_test
