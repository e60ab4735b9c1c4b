// SPDX-License-Identifier: Apache-2.0
// Prisms, pyramids and rings whose edges lie on the wall of a round solid, or whose faces touch it
// along lines: as meshes of round parts do beside the parts themselves. Volumes are closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/support/evaluated.h"
#include "core/support/meshes.h"
#include "core/support/sanitized.h"

namespace volcontact::fitting_meshes_test {
namespace {

using test::mesh_of;
using test::ring_soup;
using test::Soup;

// With n sides, its corners at radius r below and `taper` r above.
Soup regular_prism(int n, double r, double half, double taper = 1.0) {
  Soup soup = test::regular_prism_soup(n, r, half);
  for (Vec3& v : soup.vertices) {
    if (v.z() > 0.0) v = {taper * v.x(), taper * v.y(), v.z()};
  }
  return soup;
}

struct Fit {
  const char* name;
  Shape round;
  Soup mesh;
  double volume;  ///< of the overlap
  double play;    ///< along the axis: the overlap stays the same
};

std::vector<Fit> fits(int n, double r, double h, double bore, double taper) {
  const double around = r / std::cos(kPi / n);  // of corners whose sides touch the circle
  const double disc = kPi * r * r * 2.0 * h;
  const double area = 0.5 * n * std::sin(2.0 * kPi / n), polygon = area * r * r * 2.0 * h;
  const double ring = area * (r * r - bore * bore) * 2.0 * h;
  const double third = (1.0 + taper + taper * taper) / 3.0;
  const auto drum = [&](double half) { return Cylinder({.radius = r, .half_length = half}); };
  const auto capsule = [&](double half) { return Capsule({.radius = r, .half_length = half}); };
  const Frustum cone({.bottom_radius = r, .top_radius = taper * r, .half_length = h});
  const double ball = 4.0 / 3.0 * kPi * r * r * r;
  return {
      {"prism in drum", drum(h), regular_prism(n, r, 2.0 * h), polygon, h},
      {"short prism in drum", drum(2.0 * h), regular_prism(n, r, h), polygon, h},
      {"prism as long as its drum", drum(h), regular_prism(n, r, h), polygon, 0.0},
      {"prism around drum", drum(h), regular_prism(n, around, 2.0 * h), disc, h},
      {"ring in drum", drum(h), ring_soup(bore, r, 2.0 * h, n), ring, h},
      {"drum in ring", drum(h), ring_soup(r, 2.0 * r, 2.0 * h, n), disc - polygon, h},
      {"drum as long as its ring", drum(h), ring_soup(r, 2.0 * r, h, n), disc - polygon, 0.0},
      {"drum in wide ring", drum(h), ring_soup(around, 3.0 * r, 2.0 * h, n), 0.0, h},
      {"pyramid in cone", cone, regular_prism(n, r, h, taper), polygon * third, 0.0},
      {"pyramid around cone", cone, regular_prism(n, around, h, taper), disc * third, 0.0},
      {"prism in capsule", capsule(2.0 * h), regular_prism(n, r, h), polygon, h},
      {"ring in capsule", capsule(2.0 * h), ring_soup(bore, r, h, n), ring, h},
      {"prism around capsule", capsule(h), regular_prism(n, around, 2.0 * (h + r)), disc + ball, h},
      {"capsule in wide ring", capsule(h), ring_soup(around, 3.0 * r, 2.0 * (h + r), n), 0.0, h},
      {"prism in ball", Sphere({.radius = std::hypot(r, h)}), regular_prism(n, r, h), polygon, 0.0},
  };
}

// Coaxial but for `off`, in the order of the pair that the dice choose.
TEST(FittingMeshes, HaveTheVolumeOfTheClosedForm) {
  std::mt19937_64 random(7);
  const auto uniform = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  constexpr int kSides[] = {3, 4, 5, 6, 8, 10, 12, 16, 24, 32};
  constexpr double kOff[] = {0.0, 0.0, 1e-15, 1e-12, 1e-10, 1e-8, 1e-6};
  for (int i = 0; i < test::cases(6, 2, 1); ++i) {
    const int n = kSides[random() % std::size(kSides)];
    const double r = uniform(0.05, 0.3), h = uniform(0.02, 0.3);
    for (const Fit& fit : fits(n, r, h, r * uniform(0.2, 0.8), uniform(0.2, 0.9))) {
      const double off = kOff[random() % std::size(kOff)];
      const double turns[] = {0.0, 2.0 * kPi / n * static_cast<double>(random() % 32),
                              kPi / 5.0 * static_cast<double>(random() % 10), uniform(0.0, 6.0)};
      const Vec3 leaning = Vec3(uniform(-1.0, 1.0), uniform(-1.0, 1.0), 1e-3).normalized();
      Pose X;
      X.rotation = test::turn(Vec3::UnitZ(), turns[random() % 4]) * test::turn(leaning, off);
      X.translation =
          Vec3(uniform(-r, r) * off, uniform(-r, r) * off, uniform(-0.99, 0.99) * fit.play);
      const Shape mesh = mesh_of(fit.mesh);
      const VolumeMetrics m = (random() % 2 == 0 ? test::evaluated(fit.round, mesh, X)
                                                 : test::evaluated(mesh, fit.round, X.inverse()))
                                  .total;
      const double size = kPi * r * r * 2.0 * h;
      EXPECT_NEAR(m.volume, fit.volume, m.volume_error + 30.0 * off * size + 1e-9 * size)
          << fit.name << ", " << n << " sides, r " << r << ", h " << h << ", off " << off
          << ", case " << i;
      EXPECT_LE(m.volume_error, 1e-2 * std::max(fit.volume, 1e-3 * size)) << fit.name;
    }
  }
}

}  // namespace
}  // namespace volcontact::fitting_meshes_test
