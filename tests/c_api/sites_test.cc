// SPDX-License-Identifier: Apache-2.0
// Sites as forces at points, for hosts of flexible bodies: together they are the wrenches.
#include <array>
#include <string>

#include "c_api/support.h"

namespace volcontact::c_api::testing::sites_test {
namespace {

using Vec = std::array<long double, 3>;

constexpr const char* kUnit = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 ";
// A cylinder along z with the radius 20 mm inside a bore of 20.5 mm, tilted by 0.03 rad: it touches
// the wall above on one side and below on the other.
const std::string kPegInBore =
    std::string("pair at 1 0 0 0 0 0.99955003 -0.0299955 0 0 0.0299955 0.99955003 0 0 0 0 1 ") +
    "solid cylinder 0.02 0.04 at " + kUnit + "solid csg 3 member " + kUnit +
    "box 0.06 0.06 0.03 member " + kUnit + "cylinder 0.0205 0.05 difference ";

std::string pair(const std::string& a, const std::string& b, const std::string& at = kUnit) {
  return "pair at " + at + "solid " + a + " at " + kUnit + "solid " + b + " ";
}

Vec crossed(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct Sum {
  Vec force{}, torque{};
  long double force_scale = 0.0L, torque_scale = 0.0L;
};

// Forces at points as a host would add them, about an origin.
Sum sum_of(const std::vector<vc_site>& sites, const double* pose, double sign) {
  Sum sum;
  for (const vc_site& site : sites) {
    Vec arm, force;
    for (std::size_t i = 0; i < 3; ++i) {
      arm[i] = static_cast<long double>(site.metrics.centroid[i]) - pose[4 * i + 3];
      force[i] = sign * static_cast<long double>(site.force[i]);
    }
    const Vec moment = crossed(arm, force);
    for (std::size_t i = 0; i < 3; ++i) {
      sum.force[i] += force[i];
      sum.torque[i] += moment[i] + sign * static_cast<long double>(site.torque[i]);
      sum.force_scale += std::abs(force[i]);
      sum.torque_scale += std::abs(moment[i]) + std::abs(static_cast<long double>(site.torque[i]));
    }
  }
  return sum;
}

void expect_same(const Sum& sum, const double* force, const double* torque) {
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(static_cast<double>(sum.force[i] - force[i]), 0.0,
                1e-12 * static_cast<double>(sum.force_scale));
    EXPECT_NEAR(static_cast<double>(sum.torque[i] - torque[i]), 0.0,
                1e-12 * static_cast<double>(sum.torque_scale));
  }
}

struct Scene {
  const char* name;
  std::string pairs;
  double x, y, z;  // of A's origin [m]
  std::size_t sites;
};

const std::vector<Scene>& scenes() {
  static const std::vector<Scene> all = {
      {"ball on plane", pair("sphere 0.05", "half_space"), 0.03, -0.02, 0.049, 1},
      {"box on box", pair("box 0.1 0.08 0.05", "box 0.5 0.5 0.05"), 0.03, -0.02, 0.099, 1},
      {"cylinder on box", pair("cylinder 0.04 0.05", "box 0.5 0.5 0.05"), 0.03, -0.02, 0.099, 1},
      {"torus on plane", pair("torus 0.1 0.02", "half_space"), 0.03, -0.02, 0.019, 1},
      {"two balls on plane",
       pair("sphere 0.05", "half_space", "1 0 0 0.2 0 1 0 0 0 0 1 0 0 0 0 1 ") +
           pair("sphere 0.06", "half_space", "1 0 0 -0.2 0 1 0 0 0 0 1 0 0 0 0 1 "),
       0.03, -0.02, 0.049, 2},
      {"peg jammed in a bore", kPegInBore, 0.0, 0.0, 0.0, 2},
  };
  return all;
}

const std::vector<std::string>& laws() {
  static const std::vector<std::string> all = {
      "set damping 1 0.5 choose friction_law regularized_coulomb choose coupling quadrature ",
      "set damping 1 0.5 choose friction_law bristle choose coupling ellipsoid ",
      "set damping 1 0.5 choose friction_law elastic_coulomb choose coupling none ",
      "set damping 1 0.5 choose friction_law none ",
      "choose formulation potential choose friction_law regularized_coulomb ",
  };
  return all;
}

TEST(CSites, ForcesAtPointsSumToTheWrenches) {
  double largest_torque = 0.0;
  for (const Scene& scene : scenes()) {
    for (const std::string& law : laws()) {
      SCOPED_TRACE(std::string(scene.name) + ": " + law);
      vc_model* made = nullptr;
      ASSERT_EQ(vc_model_create_text((law + scene.pairs).c_str(), &made), 0) << vc_error();
      const Model model(made);
      const Workspace scratch = workspace();
      const int size = vc_model_state_size(model.get(), 8);
      std::vector<double> state(static_cast<std::size_t>(size));
      vc_result result;
      for (int step = 0; step < 3; ++step) {  // bristles bend by and by
        vc_motion motion = at(scene.x + 1e-5 * step, scene.y, scene.z, 2e-4 * step);
        motion.X_WB[3] = 1e-4;
        const double twist[] = {0.3, -0.2, 2.0, 0.1, 0.05, -0.02};
        std::copy_n(twist, 6, motion.V_WA);
        motion.V_WB[4] = 0.01;
        ASSERT_EQ(vc_evaluate(model.get(), scratch.get(), &motion, state.data(), state.data(), size,
                              1e-4, &result),
                  0)
            << vc_error();
        ASSERT_EQ(result.forgotten, 0);
        std::vector<vc_site> sites(static_cast<std::size_t>(result.sites));
        ASSERT_EQ(vc_sites(scratch.get(), sites.data(), result.sites), result.sites);
        ASSERT_EQ(sites.size(), scene.sites);
        expect_same(sum_of(sites, motion.X_WA, 1.0), result.force_on_a, result.torque_on_a);
        expect_same(sum_of(sites, motion.X_WB, -1.0), result.force_on_b, result.torque_on_b);
        for (const vc_site& site : sites) {
          EXPECT_GT(site.normal_force, 0.0);
          for (const double torque : site.torque) {
            largest_torque = std::max(largest_torque, std::abs(torque));
          }
        }
      }
    }
  }
  EXPECT_GT(largest_torque, 1e-3);  // rolling and spin torques are among them [N m]
}

TEST(CSites, SecondMomentOfAFlatPatchIsThatOfItsArea) {
  const double a = 0.1, b = 0.08, h = 1e-3;
  const Model model = model_of(solid("box", "half_sizes", {a, b, 0.05}), solid("half_space"));
  const Workspace scratch = workspace();
  const vc_motion motion = at(0.3, -0.1, 0.05 - h);
  vc_result result;
  vc_site site;
  ASSERT_EQ(vc_evaluate(model.get(), scratch.get(), &motion, nullptr, nullptr, 0, 0.0, &result), 0);
  ASSERT_EQ(vc_sites(scratch.get(), &site, 1), 1);
  const double volume = 4.0 * a * b * h;
  const double expected[] = {volume * a * a / 3.0, 0.0, 0.0, 0.0,
                             volume * b * b / 3.0, 0.0, 0.0, 0.0,
                             volume * h * h / 12.0};
  for (int i = 0; i < 9; ++i) {
    EXPECT_NEAR(site.second_moment[i], expected[i], 1e-12 * expected[0]) << i;
  }
}

TEST(CSites, ForceSpreadOverThePatchHasTheSameWrench) {
  // docs/hosts.md, "Flexible bodies": four nodes with the patch's own second moments.
  const double a = 0.1, b = 0.08, h = 1e-3;
  const Model model = model_of(solid("box", "half_sizes", {a, b, 0.05}), solid("half_space"));
  ASSERT_EQ(vc_model_choose(model.get(), "friction_law", "regularized_coulomb"), 0);
  ASSERT_EQ(set(model, "damping", 1.0), 0);
  const Workspace scratch = workspace();
  vc_motion motion = at(0.0, 0.0, 0.05 - h);
  motion.V_WA[1] = 0.4;
  motion.V_WA[2] = 3.0;
  motion.V_WA[3] = 0.1;
  vc_result result;
  vc_site site;
  ASSERT_EQ(vc_evaluate(model.get(), scratch.get(), &motion, nullptr, nullptr, 0, 0.0, &result), 0);
  ASSERT_EQ(vc_sites(scratch.get(), &site, 1), 1);
  const double xx = site.second_moment[0] / site.metrics.volume;
  const double yy = site.second_moment[4] / site.metrics.volume;
  // J = sum w (|r|^2 1 - r r^T) of nodes at (+-sqrt(xx), +-sqrt(yy), 0), each of weight 1/4.
  const Vec turn = {site.torque[0] / yy, site.torque[1] / xx, site.torque[2] / (xx + yy)};
  Vec force{}, torque{};
  for (const double x : {-std::sqrt(xx), std::sqrt(xx)}) {
    for (const double y : {-std::sqrt(yy), std::sqrt(yy)}) {
      const Vec r = {x, y, 0.0};
      Vec one = crossed(turn, r);
      for (std::size_t i = 0; i < 3; ++i) one[i] = 0.25L * (one[i] + site.force[i]);
      const Vec moment = crossed(r, one);
      for (std::size_t i = 0; i < 3; ++i) force[i] += one[i], torque[i] += moment[i];
    }
  }
  double scale = 0.0;
  for (const double t : site.torque) scale = std::max(scale, std::abs(t));
  EXPECT_GT(scale, 1e-2);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(static_cast<double>(force[i]), site.force[i], 1e-12 * site.normal_force);
    EXPECT_NEAR(static_cast<double>(torque[i]), site.torque[i], 1e-12 * scale);
  }
}

}  // namespace
}  // namespace volcontact::c_api::testing::sites_test
