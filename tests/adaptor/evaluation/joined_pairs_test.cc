// SPDX-License-Identifier: Apache-2.0
// Flush solids touch as the one solid that they make: each scene beside the same of one box.
#include "adaptor/evaluation/joined_pairs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <set>
#include <string>
#include <vector>

#include "adaptor/support/count_allocations.h"
#include "adaptor/support/models.h"

namespace volcontact::adaptor::joined_pairs_test {
namespace {

std::string box(double x, double y, double half_x, double half_y, const std::string& more = "") {
  char text[200];
  std::snprintf(text, sizeof text,
                "<geom type=\"box\" size=\"%.17g %.17g .05\" pos=\"%.17g %.17g -.05\" ", half_x,
                half_y, x, y);
  return text + more + "/>";
}

// A floor of 0.8 m by 0.8 m with its surface at z = 0: 4 by 4 tiles, or one.
std::string floor_of_tiles() {
  std::string tiles;
  for (int i = 0; i < 16; ++i) tiles += box(-0.3 + 0.2 * (i % 4), -0.3 + 0.2 * (i / 4), 0.1, 0.1);
  return tiles;
}
std::string one_floor() { return box(0.0, 0.0, 0.4, 0.4); }

struct Fall {
  const char* name;
  std::string geoms, pose;
  std::vector<double> velocity;
  double step;
  const char* integrator;
  std::string keys;
  double tolerance = 1e-9;  // rounding, and what the motion makes of it
};

std::string keyed(const std::string& keys) {
  std::string text = "<custom>";
  std::size_t at = 0;
  while (at < keys.size()) {
    const std::size_t space = keys.find(' ', at), end = keys.find(';', at);
    text += "<numeric name=\"volcontact/" + keys.substr(at, space - at) + "\" data=\"" +
            keys.substr(space + 1, end - space - 1) + "\"/>";
    at = end + 1;
  }
  return text +
         "<tuple name=\"volcontact/material/m\"><element objtype=\"body\" objname=\"world\"/>"
         "<element objtype=\"body\" objname=\"b\"/></tuple></custom>";
}

std::string scene(const Fall& fall, const std::string& floor) {
  return "<mujoco><option timestep=\"" + std::to_string(fall.step) + "\" integrator=\"" +
         fall.integrator + "\"/><worldbody>" + floor + "<body name=\"b\" " + fall.pose +
         "><freejoint/>" + fall.geoms + "</body></worldbody>" + keyed(fall.keys) + "</mujoco>";
}

struct Motion {
  std::vector<double> q;
  std::size_t most_sites = 0;
};

Motion run(const std::string& mjcf, const Fall& fall, int steps) {
  const auto m = testing::load(mjcf);
  const auto d = testing::make_data(m);
  const testing::Attached attached(m);
  std::copy(fall.velocity.begin(), fall.velocity.end(), d->qvel);
  Motion motion;
  std::vector<volcontact_site> sites(64);
  for (int i = 0; i < steps; ++i) {
    mj_step(m.get(), d.get());
    motion.q.insert(motion.q.end(), d->qpos, d->qpos + m->nq);
    motion.q.insert(motion.q.end(), d->qvel, d->qvel + m->nv);
    const int count = volcontact_sites(m.get(), d.get(), sites.data(), 64);
    motion.most_sites = std::max(motion.most_sites, static_cast<std::size_t>(count));
  }
  return motion;
}

const std::string kSurface =
    "material/m/stiffness 1e7;material/m/damping 1;material/m/friction .3;";

const std::string kBall = "<geom type=\"sphere\" size=\".05\" mass=\"1\"/>";
const std::string kBox = "<geom type=\"box\" size=\".06 .05 .03\" mass=\"1\"/>";

class FlushSolids : public ::testing::TestWithParam<Fall> {};

TEST_P(FlushSolids, MoveWhatTouchesThemAsOneSolid) {
  const Fall& fall = GetParam();
  const Motion tiled = run(scene(fall, floor_of_tiles()), fall, 600);
  const Motion whole = run(scene(fall, one_floor()), fall, 600);
  ASSERT_EQ(tiled.q.size(), whole.q.size());
  double most = 0.0;
  for (std::size_t i = 0; i < tiled.q.size(); ++i) {
    most = std::max(most, std::abs(tiled.q[i] - whole.q[i]));
  }
  EXPECT_LT(most, fall.tolerance);
  EXPECT_EQ(tiled.most_sites, whole.most_sites);
  EXPECT_GE(tiled.most_sites, 1u);
}

INSTANTIATE_TEST_SUITE_P(
    , FlushSolids,
    ::testing::Values(Fall{"BallOnASeam",
                           kBall,
                           "pos=\"0 .05 .0501\"",
                           {0, 0, -1, 0, 0, 0},
                           1e-4,
                           "Euler",
                           kSurface},
                      Fall{"BallOnACorner",
                           kBall,
                           "pos=\".001 .002 .0501\"",
                           {.2, .1, -1, 0, 5, 50},
                           1e-4,
                           "RK4",
                           kSurface},
                      Fall{"BallOfARestitution",
                           kBall,
                           "pos=\"0 0 .0501\"",
                           {.2, .1, -1, 0, 5, 50},
                           1e-4,
                           "Euler",
                           "material/m/stiffness 1e8;material/m/restitution .8;"},
                      Fall{"BoxThatSlides",
                           kBox,
                           "pos=\"-.2 .01 .0299\"",
                           {1, .3, 0, 0, 0, 3},
                           1e-3,
                           "Euler",
                           kSurface},
                      Fall{"BoxOnBristles",
                           kBox,
                           "pos=\"-.2 .01 .0299\"",
                           {1, .3, 0, 0, 0, 3},
                           1e-3,
                           "RK4",
                           kSurface + "material/m/friction_law/bristle 1;"},
                      Fall{"BoxThatRests",
                           kBox,
                           "pos=\".01 .01 .0299\"",
                           {0, 0, 0, 0, 0, 0},
                           1e-3,
                           "Euler",
                           kSurface},
                      Fall{"BoxOfAPotential",
                           kBox,
                           "pos=\"-.1 .01 .0299\"",
                           {1, .3, 0, 0, 0, 3},
                           1e-3,
                           "Euler",
                           kSurface + "option/formulation/potential 1;"},
                      Fall{"DiscThatSpins",
                           "<geom type=\"cylinder\" size=\".05 .01\" mass=\"1\"/>",
                           "pos=\".001 .002 .00999\"",
                           {.3, .1, 0, 0, 0, 20},
                           1e-3,
                           "Euler",
                           kSurface,
                           1e-6}),
    [](const auto& test) { return test.param.name; });

// A body of two flush boxes, beside the same of one: thrown on one floor and on tiles.
TEST(JoinedPairs, BothSidesMayConsistOfSeveral) {
  const std::string two =
      "<geom type=\"box\" size=\".05 .05 .02\" pos=\"-.05 0 0\" mass=\".5\"/>"
      "<geom type=\"box\" size=\".05 .05 .02\" pos=\".05 0 0\" mass=\".5\"/>";
  const std::string one = "<geom type=\"box\" size=\".1 .05 .02\" mass=\"1\"/>";
  Fall fall{"",      two,     "pos=\"0 0 .06\" euler=\"10 20 5\"", {.3, .2, 0, 1, 0, 2}, 2e-4,
            "Euler", kSurface};
  Fall of_one = fall;
  of_one.geoms = one;
  const Motion parts = run(scene(fall, floor_of_tiles()), fall, 1000);
  const Motion whole = run(scene(of_one, one_floor()), of_one, 1000);
  for (std::size_t i = 0; i < parts.q.size(); ++i) ASSERT_NEAR(parts.q[i], whole.q[i], 1e-9) << i;
  EXPECT_EQ(parts.most_sites, 1u);
}

const Fall kSliding{"",      kBox,    "pos=\"-.2 .01 .0299\"", {1, .3, 0, 0, 0, 3}, 1e-3,
                    "Euler", kSurface};

std::vector<volcontact_site> sites_of(const testing::ModelPointer& m,
                                      const testing::DataPointer& d) {
  std::vector<volcontact_site> sites(64);
  sites.resize(static_cast<std::size_t>(volcontact_sites(m.get(), d.get(), sites.data(), 64)));
  return sites;
}

TEST(JoinedPairs, ASiteIsToldWithTheTileOfItsCentroid) {
  const auto m = testing::load(scene(kSliding, floor_of_tiles()));
  const auto d = testing::make_data(m);
  const testing::Attached attached(m);
  std::copy(kSliding.velocity.begin(), kSliding.velocity.end(), d->qvel);
  std::set<int> told;
  for (int i = 0; i < 300; ++i) {
    mj_step(m.get(), d.get());
    for (const volcontact_site& site : sites_of(m, d)) {
      ASSERT_LT(site.geom_a, site.geom_b);
      for (int k = 0; k < 2; ++k) {
        EXPECT_LE(std::abs(site.centroid[k] - m->geom_pos[3 * site.geom_a + k]), 0.1 + 1e-9);
      }
      // Its picture is that of all of it.
      std::vector<double> columns(6 * 3 * 81);
      std::vector<int> triangles(3 * 4 * 64), rim(2 * 2 * 81);
      volcontact_surface_size size{};
      EXPECT_EQ(volcontact_site_surface(m.get(), d.get(), 0, 8, columns.data(), triangles.data(),
                                        rim.data(), &size),
                0);
      EXPECT_GT(size.triangles, 0);
      told.insert(site.geom_a);
    }
  }
  EXPECT_GE(told.size(), 2u);
}

// What the sites say is what acts: at the end of a step the bodies have got their sum.
TEST(JoinedPairs, SitesSumToWhatActs) {
  const auto m = testing::load(scene(kSliding, floor_of_tiles()));
  const auto d = testing::make_data(m);
  const testing::Attached attached(m);
  std::copy(kSliding.velocity.begin(), kSliding.velocity.end(), d->qvel);
  for (int i = 0; i < 200; ++i) {
    mj_step(m.get(), d.get());
    Vec3 on_box = Vec3::Zero();
    for (const volcontact_site& site : sites_of(m, d)) on_box -= Vec3::from(site.force);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(d->qfrc_applied[k], on_box[k], 1e-9);
  }
}

// Two balls on two tiles. What one tile and one ball say of themselves in a <pair> leaves that ball
// without a family; it lies where it lay, on the tile under it.
TEST(JoinedPairs, ATileStandsWhereItIsForWhatHasNoFamily) {
  const std::string scene =
      "<mujoco><worldbody><geom name=\"near\" type=\"box\" size=\".5 .5 .1\"/>"
      "<geom name=\"far\" type=\"box\" size=\".5 .5 .1\" pos=\"1 0 0\"/>"
      "<body pos=\"-.3 0 .199\"><freejoint/><geom size=\".1\" mass=\"1\"/></body>"
      "<body pos=\"1.3 0 .199\"><freejoint/><geom name=\"ball\" size=\".1\" mass=\"1\"/></body>"
      "</worldbody><contact><pair geom1=\"far\" geom2=\"ball\" friction=\"1 1 .005 .0001 .0001\"/>"
      "</contact></mujoco>";
  const auto m = testing::load(scene);
  const auto d = testing::make_data(m);
  const testing::Attached attached(m);
  mj_step(m.get(), d.get());
  const std::vector<volcontact_site> sites = sites_of(m, d);
  ASSERT_EQ(sites.size(), 2u);
  EXPECT_NEAR(sites[0].centroid[0], -0.3, 1e-9);
  EXPECT_NEAR(sites[1].centroid[0], 1.3, 1e-9);
  EXPECT_NEAR(sites[0].volume, sites[1].volume, 1e-12);
}

TEST(JoinedPairs, CopiedDataGoOnAsTheOriginal) {
  const auto m = testing::load(scene(kSliding, floor_of_tiles()));
  const auto a = testing::make_data(m), b = testing::make_data(m);
  const testing::Attached attached(m);
  std::copy(kSliding.velocity.begin(), kSliding.velocity.end(), a->qvel);
  for (int i = 0; i < 137; ++i) mj_step(m.get(), a.get());
  mj_copyData(b.get(), m.get(), a.get());
  for (int i = 0; i < 100; ++i) mj_step(m.get(), a.get());
  for (int i = 0; i < 100; ++i) mj_step(m.get(), b.get());
  for (int i = 0; i < m->nq; ++i) EXPECT_EQ(a->qpos[i], b->qpos[i]);
}

TEST(JoinedPairs, AtRestOnTilesNothingCreeps) {
  Fall resting = kSliding;
  resting.pose = "pos=\".01 .01 .0299\" euler=\"0 0 20\"";
  std::string mjcf = scene(resting, floor_of_tiles());
  mjcf.replace(mjcf.find("<option "), 8, "<option gravity=\"2 0 -9.6\" ");
  const auto m = testing::load(mjcf);
  const auto d = testing::make_data(m);
  const testing::Attached attached(m);
  for (int i = 0; i < 5000; ++i) mj_step(m.get(), d.get());
  const std::vector<double> before(d->qpos, d->qpos + m->nq);
  for (int i = 0; i < 5000; ++i) mj_step(m.get(), d.get());
  for (int i = 0; i < m->nq; ++i) {
    EXPECT_NEAR(d->qpos[i], before[static_cast<std::size_t>(i)], 1e-15) << i;
  }
  EXPECT_EQ(sites_of(m, d).size(), 1u);
}

long allocations_inside = 0;
void watched_callback(const mjModel* m, mjData* d) {
  const long before = testing::AllocationCounter::total();
  {
    const testing::AllocationCounter counter;
    volcontact_passive(m, d);
  }
  allocations_inside += testing::AllocationCounter::total() - before;
}

TEST(JoinedPairs, WarmStepAllocatesNothing) {
  const auto m = testing::load(scene(kSliding, floor_of_tiles()));
  const auto d = testing::make_data(m);
  const testing::Attached attached(m);
  mjcb_passive = watched_callback;
  for (const bool is_warm : {false, true}) {
    mj_resetData(m.get(), d.get());
    std::copy(kSliding.velocity.begin(), kSliding.velocity.end(), d->qvel);
    allocations_inside = 0;
    for (int i = 0; i < 500; ++i) mj_step(m.get(), d.get());
    if (is_warm) {
      EXPECT_EQ(allocations_inside, 0);
    }
  }
  mjcb_passive = volcontact_passive;
}

// Three tiles of four: while the patch stays clear of the inner corner, they are one floor.
TEST(JoinedPairs, AnInnerCornerCountsOnlyWhereItIsTouched) {
  const std::string corner =
      box(-0.1, -0.1, 0.1, 0.1) + box(0.1, -0.1, 0.1, 0.1) + box(-0.1, 0.1, 0.1, 0.1);
  for (const double y : {-0.03, -0.005}) {
    Fall fall{"",
              kBall,
              "pos=\"-.02 " + std::to_string(y) + " .0499\"",
              {.2, 0, 0, 0, 4, 20},
              1e-3,
              "Euler",
              kSurface};
    const Motion parts = run(scene(fall, corner), fall, 150);
    const Motion whole = run(scene(fall, box(0.0, 0.0, 0.2, 0.2)), fall, 150);
    double most = 0.0;
    for (std::size_t i = 0; i < parts.q.size(); ++i) {
      most = std::max(most, std::abs(parts.q[i] - whole.q[i]));
    }
    if (y < -0.01) {
      EXPECT_LT(most, 1e-9);
      EXPECT_EQ(parts.most_sites, 1u);
    } else {
      EXPECT_GT(most, 1e-6);
    }
  }
}

// A tile before the ball in the file and one behind it: told in the order of the geoms all the
// same.
TEST(JoinedPairs, TheOrderOfGeomsChangesNothing) {
  const std::string ball = "<body name=\"b\" pos=\"0 .01 .0499\"><freejoint/>" + kBall + "</body>";
  const std::string between = "<mujoco><worldbody>" + box(-0.2, 0.0, 0.2, 0.2) + ball + "<body>" +
                              box(0.2, 0.0, 0.2, 0.2) + "</body></worldbody></mujoco>";
  const std::string one =
      "<mujoco><worldbody>" + box(0.0, 0.0, 0.4, 0.2) + ball + "</worldbody></mujoco>";
  const Fall fall{"", "", "", {.2, .1, 0, 0, 3, 20}, 2e-3, "", ""};
  const Motion parts = run(between, fall, 300), whole = run(one, fall, 300);
  for (std::size_t i = 0; i < parts.q.size(); ++i) ASSERT_NEAR(parts.q[i], whole.q[i], 1e-9) << i;

  const auto m = testing::load(between);
  const auto d = testing::make_data(m);
  const testing::Attached attached(m);
  for (const double x : {-0.1, 0.1}) {
    mj_resetData(m.get(), d.get());
    d->qpos[0] = x;
    mj_forward(m.get(), d.get());
    const std::vector<volcontact_site> sites = sites_of(m, d);
    ASSERT_EQ(sites.size(), 1u);
    EXPECT_LT(sites[0].geom_a, sites[0].geom_b);
    EXPECT_EQ(sites[0].geom_a, x < 0.0 ? 0 : 1);
    EXPECT_EQ(sites[0].force[2] < 0.0, x < 0.0) << "on the floor, or on the ball";
    volcontact_contact contact{};
    ASSERT_EQ(volcontact_contacts(m.get(), d.get(), &contact, 1), 1);
    EXPECT_EQ(contact.force[2], sites[0].force[2]);
  }
}

// A tile that is moved in the compiled model is a tile no more.
TEST(JoinedPairs, TilesThatAreMovedApartAreKnown) {
  const auto m = testing::load(scene(kSliding, floor_of_tiles()));
  const auto d = testing::make_data(m);
  const testing::Attached attached(m);
  d->qpos[0] = d->qpos[1] = 0.0;
  d->qpos[2] = 0.0299;
  mj_forward(m.get(), d.get());
  EXPECT_EQ(sites_of(m, d).size(), 1u);
  for (int geom = 0; geom < 16; ++geom) m->geom_pos[3 * geom] *= 1.01;
  mj_forward(m.get(), d.get());
  EXPECT_EQ(sites_of(m, d).size(), 2u);
}

}  // namespace
}  // namespace volcontact::adaptor::joined_pairs_test
