// SPDX-License-Identifier: Apache-2.0
#include "volcontact/shape/csg/csg.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "core/support/csg_solids.h"
#include "core/support/sanitized.h"
#include "volcontact/shape/csg/csg_metrics.h"

namespace volcontact::csg_test {
namespace {

using namespace testing;  // the solids

// The tree of the solid, read point by point: what pieces and carved pieces must agree with.
double distance(const Csg& solid, const Vec3& p) { return solid.signed_distance(p); }

bool holds(const CarvedPiece& piece, const Vec3& p) {
  const Vec3 p_B = piece.X_SB.inverse() * p;
  const bool in_body =
      std::visit([&](const auto& body) { return body.signed_distance(p_B) <= 0.0; }, piece.body);
  return in_body && std::all_of(piece.carved.begin(), piece.carved.end(),
                                [&p](const Quadric& round) { return round(p) >= 0.0; });
}

TEST(Csg, EveryPointOfTheSolidIsInOnePieceAndNoOtherPointInAny) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-0.4, 0.4);
  for (const NamedSolid& named : kinds_of_solids()) {
    PieceList list;
    named.solid.pieces(list);
    ASSERT_GT(list.size(), 0) << named.name;
    for (int k = 0; k < 4000; ++k) {
      const Vec3 p(number(random), number(random), number(random));
      if (std::abs(distance(named.solid, p)) < 1e-9) continue;
      int pieces = 0;
      for (int i = 0; i < list.size(); ++i) {
        pieces += std::all_of(list.begin(i), list.end(i),
                              [&p](const Quadric& face) { return face(p) <= 0.0; });
      }
      EXPECT_EQ(pieces, distance(named.solid, p) < 0.0) << named.name << ": " << p;
    }
  }
}

TEST(Csg, FacesOfPiecesAreSurfaceOrSeamAllOver) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> number(-0.4, 0.4);
  for (const NamedSolid& named : kinds_of_solids()) {
    PieceList list;
    named.solid.pieces(list);
    int checked = 0;
    for (int k = 0; k < 2000; ++k) {
      const Vec3 p(number(random), number(random), number(random));
      const Vec3 d = Vec3(number(random), number(random), number(random)).normalized();
      for (int i = 0; i < list.size(); ++i) {
        for (const Quadric* face = list.begin(i); face != list.end(i); ++face) {
          for (const double t : crossings(*face, p, d)) {
            const Vec3 x = p + t * d;
            const bool on_piece = std::all_of(
                list.begin(i), list.end(i),
                [&](const Quadric& other) { return &other == face || other(x) < -1e-7; });
            if (!on_piece) continue;
            const Vec3 outward = (face->linear + face->hessian * x).normalized();
            const double beyond = distance(named.solid, x + 1e-6 * outward);
            if (std::abs(beyond) < 1e-8) continue;
            EXPECT_EQ(face->seam, beyond < 0.0) << named.name << ": " << x;
            ++checked;
          }
        }
      }
    }
    EXPECT_GT(checked, 100) << named.name;
  }
}

TEST(Csg, CarvedPiecesHoldTheSolidAndTheirSeamsLieBetweenThem) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-0.4, 0.4);
  for (const NamedSolid& named : kinds_of_solids()) {
    const std::vector<CarvedPiece>& pieces = named.solid.carved_pieces();
    EXPECT_EQ(pieces.size(), static_cast<std::size_t>(named.carved_pieces)) << named.name;
    if (pieces.empty()) continue;
    for (int k = 0; k < 4000; ++k) {
      const Vec3 p(number(random), number(random), number(random));
      if (std::abs(distance(named.solid, p)) < 1e-9) continue;
      int holding = 0;
      for (const CarvedPiece& piece : pieces) holding += holds(piece, p);
      EXPECT_EQ(holding, distance(named.solid, p) < 0.0) << named.name << ": " << p;
      const Vec3 d = Vec3(number(random), number(random), number(random)).normalized();
      for (const CarvedPiece& piece : pieces) {
        for (const Seam& seam : piece.seams) {
          const Vec3 x = p + (seam.offset - seam.normal.dot(p)) / seam.normal.dot(d) * d;
          if (!holds(piece, x - 1e-9 * seam.normal)) continue;
          const double beyond = distance(named.solid, x + 1e-6 * seam.normal);
          if (std::abs(beyond) < 1e-8) continue;
          EXPECT_EQ(seam.is_surface(x), beyond > 0.0) << named.name << ": " << x;
        }
      }
    }
  }
}

TEST(Csg, HolesAreCarvedOnce) {
  const auto carved = [](const Csg& solid) {
    std::size_t count = 0;
    for (const CarvedPiece& piece : solid.carved_pieces()) count += piece.carved.size();
    return count;
  };
  EXPECT_EQ(carved(box(.3, .2, .1) - tube(.05, .5)), 1u);
  // Of narrow and wide bore only the wide one counts where both are; below, the narrow one.
  EXPECT_EQ(carved(counterbored()), 2u);
  EXPECT_EQ(carved(box(.3, .2, .1) - tube(.05, .5) - tube(.04, .5)), 1u);
  // A chamfer that begins within the bore: each is carved where it is the wider one.
  const Csg chamfer(Frustum({.bottom_radius = .04, .top_radius = .08, .half_length = .02}),
                    at(0, 0, .09));
  const Csg chamfered = box(.3, .2, .1) - tube(.05, .5) - chamfer;
  for (const CarvedPiece& piece : chamfered.carved_pieces()) {
    EXPECT_EQ(piece.carved.size(), 1u);
    EXPECT_EQ(piece.bores.size(), 1u);
  }
  EXPECT_EQ(carved(box(.3, .2, .1) - tube(.05, .05, at(0, 0, 5))), 0u);
}

// Two bores about one axis, a tube and a cone, each in a block of its own: what the blocks have in
// common is bored by the wider one at every height, which are the pieces. Frusta and tubes.
TEST(Csg, WhatBoredBlocksHaveInCommonKeepsAllItsPieces) {
  const auto frustum = [](double r, double s, double h) {
    return kPi * h * (r * r + r * s + s * s) / 3.0;
  };
  for (const double radius : {.01, .02, .03, .04}) {
    const Csg both =
        (box(.1, .1, .05) - tube(radius, .2)) & (box(.1, .1, .05) - cone(.005, .045, .05));
    // The cone is as wide as the tube at this height over the bottom.
    const double height = .1 * (radius - .005) / .04;
    const double bored = kPi * radius * radius * height + frustum(radius, .045, .1 - height);
    EXPECT_NEAR(both.own_metrics().volume, .004 - bored, 1e-14);
    EXPECT_EQ(both.carved_pieces().size(), 2u);
  }
}

TEST(Csg, MostVolumeAndMostPartsAreBounds) {
  const std::vector<NamedSolid> kinds = kinds_of_solids();
  for (std::size_t i = 0; i < kinds.size(); i += test::cases(1, 4)) {
    const NamedSolid& named = kinds[i];
    EXPECT_LE(named.solid.own_metrics().volume, (1.0 + 1e-9) * named.solid.most_volume());
    EXPECT_LE(named.solid.most_volume(), 8.0 * named.solid.bounds().half_sizes().prod());
    EXPECT_EQ(named.solid.most_parts(), static_cast<int>(named.solid.members().size()));
  }
  const Csg torus(Torus({.major_radius = .2, .minor_radius = .05}));
  EXPECT_EQ((torus + box(.1, .1, .1)).most_parts(), 3);
}

TEST(Csg, SignedDistanceIsBoundedByTheDistanceAndGrowsAlongTheGradient) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> number(-0.4, 0.4);
  for (const NamedSolid& named : kinds_of_solids()) {
    for (int k = 0; k < 300; ++k) {
      const Vec3 p(number(random), number(random), number(random));
      const double d = distance(named.solid, p);
      const Vec3 e = Vec3(number(random), number(random), number(random)).normalized();
      // A ball of that radius holds no surface: the sign is the same all over it.
      const double there = distance(named.solid, p + 0.999 * std::abs(d) * e);
      EXPECT_GE(there * d, 0.0) << named.name;
      const Vec3 g = named.solid.gradient(p);
      EXPECT_NEAR(g.norm(), 1.0, 1e-12);
      EXPECT_GE(distance(named.solid, p + 1e-7 * g) - d, -1e-12) << named.name;
      if (d < 0.0) {
        const Aabb bounds = named.solid.bounds();
        EXPECT_TRUE((p - bounds.min).minCoeff() >= 0.0 && (bounds.max - p).minCoeff() >= 0.0);
        EXPECT_LE(e.dot(p), named.solid.support_height(e));
      }
    }
  }
}

// Elementary solids; the metrics of a shape in csg.h are its own only where it stands alone.
TEST(Csg, OwnMetricsOfBoredAndHollowSolidsAreClosedForms) {
  const double bore = kPi * .05 * .05;
  EXPECT_NEAR((box(.3, .2, .1) - tube(.05, .5)).own_metrics().volume, .048 - bore * .2, 1e-15);
  EXPECT_NEAR((box(.3, .2, .1) - tube(.05, .1, at(.1, 0, .1))).own_metrics().volume,
              .048 - bore * .1, 1e-15);
  const VolumeMetrics pipe = (tube(.2, .3) - tube(.1, .4)).own_metrics();
  const double volume = kPi * (.04 - .01) * .6;
  EXPECT_NEAR(pipe.volume, volume, 1e-15);
  EXPECT_NEAR(pipe.inertia(2, 2), volume * (.04 + .01) / 2.0, 1e-15);
  EXPECT_NEAR(pipe.inertia(0, 0), volume * ((.04 + .01) / 4.0 + .36 / 12.0), 1e-15);
  // Counterbore: wide to z = 0.03, narrow below.
  EXPECT_NEAR(counterbored().own_metrics().volume, .048 - bore * .13 - kPi * .01 * .07, 1e-15);
  // A ball socket: the half ball below the face.
  EXPECT_NEAR((box(.2, .2, .1) - ball(.15, at(0, 0, .1))).own_metrics().volume,
              .032 - 2.0 / 3.0 * kPi * std::pow(.15, 3), 1e-10 * .032);
  // Two bores that cross at right angles: 2 tubes less Steinmetz's solid 16 r^3/3.
  EXPECT_NEAR((box(.2, .2, .2) - tube(.05, .5) -
               tube(.05, .5, turned(Vec3::UnitX(), kPi / 2, Vec3::Zero())))
                  .own_metrics()
                  .volume,
              .064 - 2.0 * bore * .4 + 16.0 / 3.0 * std::pow(.05, 3), 1e-9 * .064);
}

TEST(Csg, OwnMetricsAndTheQuadratureAgree) {
  const std::size_t kEvery = test::cases(1, 4);
  const std::vector<NamedSolid> kinds = kinds_of_solids();
  for (std::size_t i = 0; i < kinds.size(); i += kEvery) {
    const NamedSolid& named = kinds[i];
    const VolumeMetrics m = named.solid.own_metrics();
    const VolumeMetrics lines = csg_metrics_by_lines(named.solid);
    EXPECT_NEAR(m.volume, lines.volume, 1e-9 * m.volume) << named.name;
    EXPECT_NEAR((m.centroid - lines.centroid).norm(), 0.0, 1e-9) << named.name;
    EXPECT_NEAR((m.inertia - lines.inertia).norm(), 0.0, 1e-8 * m.inertia.norm()) << named.name;
  }
}

TEST(Csg, VolumesOfUnionAndIntersectionAddUp) {
  constexpr double kQuadrature = 1e-8;  // of the volume
  constexpr double kWork = 1e5;         // under sanitizers, with an error then
  const auto metrics = [](const Csg& solid) {
    VolumeMetrics m = test::kSanitized ? csg_metrics_by_lines(solid, kWork) : solid.own_metrics();
    if (!test::kSanitized) m.volume_error = 0.0;
    return m;
  };
  const Csg a = ball(.2), b = tube(.1, .3, turned({1, 2, 3}, 0.7, {.05, .02, -.03}));
  const double of_a = a.own_metrics().volume, of_b = b.own_metrics().volume;
  const VolumeMetrics both = metrics(a & b), all = metrics(a + b), rest = metrics(a - b);
  EXPECT_NEAR(all.volume + both.volume, of_a + of_b,
              kQuadrature * all.volume + all.volume_error + both.volume_error);
  EXPECT_NEAR(rest.volume + both.volume, of_a,
              kQuadrature * of_a + rest.volume_error + both.volume_error);
  const Torus ring({.major_radius = .2, .minor_radius = .05});
  const VolumeMetrics halved = metrics(Csg(ring) - box(.3, .3, .3, at(.3, 0, 0)));
  const double of_ring = ring.own_metrics().volume;
  EXPECT_NEAR(halved.volume, 0.5 * of_ring, kQuadrature * of_ring + halved.volume_error);
}

// Where the budget ends the volume is an estimate that says so, within its error of the full
// quadrature; the same bits each time. More work, less error.
TEST(Csg, OwnMetricsWithinABudgetAreAnEstimateThatSaysSo) {
  int approximate = 0;
  const std::vector<NamedSolid> kinds = kinds_of_solids();
  const int kEvery = test::cases(1, 8);
  for (std::size_t i = 0; i < kinds.size(); i += kEvery) {
    const NamedSolid& named = kinds[i];
    const VolumeMetrics exact = named.solid.own_metrics();
    for (const double work : {1e3, 1e4, 1e5}) {
      const VolumeMetrics m = csg_metrics_by_lines(named.solid, work);
      EXPECT_LE(std::abs(m.volume - exact.volume), m.volume_error + 1e-7 * exact.volume)
          << named.name << " " << work;
      const Aabb bounds = named.solid.bounds();
      EXPECT_LE((m.centroid - exact.centroid).norm(),
                bounds.half_sizes().norm() * (m.volume_error / exact.volume + 1e-7));
      EXPECT_LE(m.volume_error, 20.0 / std::sqrt(work) * exact.volume);
      if (m.status == Status::kOk) continue;
      EXPECT_EQ(m.status, Status::kApproximate);
      EXPECT_EQ(m.volume, csg_metrics_by_lines(named.solid, work).volume);
      ++approximate;
    }
  }
  EXPECT_GT(approximate, 60 / kEvery);
}

// Two tori about different axes, and more than a line can be cut with in any time.
TEST(Csg, OwnMetricsOfManyToriEnd) {
  const Csg torus(Torus({.major_radius = .2, .minor_radius = .05}));
  const double one = 2.0 * kPi * kPi * .2 * .05 * .05;
  Csg chain = torus;
  for (int i = 1; i < 6; ++i) {
    chain = chain + torus.posed(turned(Vec3::UnitX(), i % 2 * .5 * kPi, {.31 * i, 0, 0}));
  }
  const VolumeMetrics m = chain.own_metrics();
  EXPECT_EQ(m.status, Status::kApproximate);
  EXPECT_LE(std::abs(m.volume - 6.0 * one), m.volume_error);
  EXPECT_LE(m.volume_error, 0.05 * m.volume);
}

TEST(Csg, ATorusLeavesNoPieces) {
  const Csg solid = box(.3, .2, .1) - Csg(Torus({.major_radius = .2, .minor_radius = .05}));
  PieceList list;
  solid.pieces(list);
  EXPECT_EQ(list.size(), 0);
  EXPECT_FALSE(solid.is_carved());
}

TEST(Csg, UnboundedAndEmptySolidsAreValues) {
  const Csg ground = Csg(HalfSpace()) - tube(.1, .1);
  EXPECT_FALSE(ground.bounds().bounded());
  EXPECT_EQ(ground.own_metrics().status, Status::kUnbounded);
  EXPECT_TRUE((ground & box(.1, .1, .1)).bounds().bounded());
  const Csg nothing = box(.1, .1, .1) - box(.2, .2, .2);
  EXPECT_EQ(nothing.own_metrics().volume, 0.0);
  EXPECT_EQ((box(.1, .1, .1) & box(.1, .1, .1, at(1, 0, 0))).own_metrics().volume, 0.0);
}

TEST(Csg, TooManyMembersAreRefused) {
  Csg solid = ball(.1);
  for (int i = 1; i < 256; i *= 2) solid = solid + solid;
  try {
    (void)(solid + ball(.1));
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "csg: a solid of 257 members is too large: at most 256");
  }
}

}  // namespace
}  // namespace volcontact::csg_test
