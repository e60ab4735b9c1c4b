// SPDX-License-Identifier: Apache-2.0
// Flush solids touch as the one solid that they make: each scene beside the same of one box.
#include "adaptor/evaluation/joined_pairs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "adaptor/support/count_allocations.h"
#include "adaptor/support/models.h"

namespace volcontact::adaptor::joined_pairs_test {
namespace {

std::string box(double x, double y, double half_x, double half_y, const std::string& more = "") {
  char text[200];
  std::snprintf(text, sizeof text, "<geom type=\"box\" size=\"%.17g %.17g .05\" pos=\"%.17g %.17g -.05\" ",
                half_x, half_y, x, y);
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
         fall.integrator + "\"/><worldbody>" + floor + "<body name=\"b\" " + fall.pose + "><freejoint/>" +
         fall.geoms + "</body></worldbody>" + keyed(fall.keys) + "</mujoco>";
}

struct Motion {
  std::vector<double> q;
  std::size_t most_sites = 0;
  double made = 0.0;
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
  EXPECT_LT(most, 1e-9);  // rounding, and what the motion makes of it
  EXPECT_EQ(tiled.most_sites, whole.most_sites);
  EXPECT_GE(tiled.most_sites, 1u);
}

INSTANTIATE_TEST_SUITE_P(
    , FlushSolids,
    ::testing::Values(
        Fall{"BallOnASeam", kBall, "pos=\"0 .05 .0501\"", {0, 0, -1, 0, 0, 0}, 1e-4, "Euler", kSurface},
        Fall{"BallOnACorner", kBall, "pos=\".001 .002 .0501\"", {.2, .1, -1, 0, 5, 50}, 1e-4, "RK4",
             kSurface},
        Fall{"BallOfARestitution", kBall, "pos=\"0 0 .0501\"", {.2, .1, -1, 0, 5, 50}, 1e-4, "Euler",
             "material/m/stiffness 1e8;material/m/restitution .8;"},
        Fall{"BoxThatSlides", kBox, "pos=\"-.2 .01 .0299\"", {1, .3, 0, 0, 0, 3}, 1e-3, "Euler",
             kSurface},
        Fall{"BoxOnBristles", kBox, "pos=\"-.2 .01 .0299\"", {1, .3, 0, 0, 0, 3}, 1e-3, "RK4",
             kSurface + "material/m/friction_law/bristle 1;"},
        Fall{"BoxThatRests", kBox, "pos=\".01 .01 .0299\"", {0, 0, 0, 0, 0, 0}, 1e-3, "Euler",
             kSurface},
        Fall{"BoxOfAPotential", kBox, "pos=\"-.1 .01 .0299\"", {1, .3, 0, 0, 0, 3}, 1e-3, "Euler",
             kSurface + "option/formulation/potential 1;"},
        Fall{"DiscThatSpins", "<geom type=\"cylinder\" size=\".05 .01\" mass=\"1\"/>",
             "pos=\".001 .002 .00999\"", {.3, .1, 0, 0, 0, 20}, 1e-3, "Euler", kSurface}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace volcontact::adaptor::joined_pairs_test
