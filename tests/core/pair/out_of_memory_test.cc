// SPDX-License-Identifier: Apache-2.0
// An evaluation without memory is an exception, and the next one as if nothing had been.
#include <gtest/gtest.h>

#include <cstring>
#include <new>
#include <optional>

#include "core/support/fail_allocations.h"
#include "core/support/meshes.h"
#include "core/support/random_shapes.h"
#include "volcontact/force/laws.h"
#include "volcontact/model/contact_model.h"
#include "volcontact/pair/interference.h"

namespace volcontact::out_of_memory_test {
namespace {

using test::AllocationLimit;

const Shape kBox = Box({.half_sizes = Vec3(0.2, 0.16, 0.12)});
const Shape kBall = Sphere({.radius = 0.2});
const Shape kCan = Cylinder({.radius = 0.12, .half_length = 0.16});
const Shape kEgg = Ellipsoid({.semi_axes = Vec3(0.2, 0.16, 0.12)});
const Shape kRing = Torus({.major_radius = 0.2, .minor_radius = 0.06});
Shape some_polytope() {
  test::Random random(1);
  return test::random_polytope(14, random);
}
const Shape kGem = some_polytope();
const Shape kMesh = test::mesh_of(test::box_soup(Vec3(0.2, 0.16, 0.12), 3));
const Shape kFineMesh = test::mesh_of(test::box_soup(Vec3(0.2, 0.16, 0.12), 12));
const Shape kBored =
    Csg(Csg::Operation::kDifference, Csg(Box({.half_sizes = Vec3(0.2, 0.16, 0.12)})),
        Csg(Cylinder({.radius = 0.08, .half_length = 0.3})));

struct Pairing {
  const char* name;
  Shape a, b;
  Engine engine = Engine::kAuto;
  int threads = 1;
};
const std::vector<Pairing> kPairings{
    {"clip", kBox, kGem},
    {"box with box", kBox, kBox},
    {"lines", kCan, kBox},
    {"lines of two round ones", kCan, kEgg},
    {"torus with convex", kRing, kBox},
    {"torus with bored", kRing, kBored},
    {"two tori", kRing, kRing},
    {"bored with round", kBored, kCan},
    {"bored with bored", kBored, kBored},
    {"surface sweep", kBored, kEgg, Engine::kSurfaceSweep},
    {"mesh with mesh", kMesh, kMesh},
    {"mesh with mesh, threads", kFineMesh, kFineMesh, Engine::kAuto, 3},
    {"mesh with ball", kMesh, kBall},
    {"mesh with can", kMesh, kCan},
    {"mesh with torus", kMesh, kRing},
    {"mesh with bored", kMesh, kBored},
    {"octree", kCan, kBall, Engine::kOctree},
    {"octree, threads", kBored, kBall, Engine::kOctree, 3},
};

const Pose kPose{test::turn(Vec3(0.2, 0.5, 0.8).normalized(), 0.7), Vec3(0.13, 0.05, 0.09)};
constexpr long kMost = 100000;  // of allocations in one evaluation

bool same_bits(const VolumeMetrics& m, const VolumeMetrics& n) {
  return m.volume == n.volume && m.centroid == n.centroid && m.inertia == n.inertia &&
         m.area_vector == n.area_vector && m.depth_moment == n.depth_moment &&
         m.volume_error == n.volume_error && m.status == n.status;
}

class OutOfMemory : public ::testing::TestWithParam<Pairing> {};

TEST_P(OutOfMemory, EveryAllocationOfAColdEvaluationMayFail) {
  const Pairing& pairing = GetParam();
  InterferenceOptions options;
  options.engine = pairing.engine;
  options.threads = pairing.threads;
  options.most_cells = 3000;
  Interference expected;
  {
    InterferenceWorkspace workspace;
    interference(pairing.a, pairing.b, kPose, options, workspace, expected);
    ASSERT_TRUE(expected.total.touching());
  }
  long failed = 0;
  for (bool reached = true; reached; ++failed) {
    ASSERT_LT(failed, kMost);
    std::optional<InterferenceWorkspace> workspace;
    std::optional<Interference> out(std::in_place);
    bool thrown = false;
    {
      const AllocationLimit limit(failed);
      try {
        workspace.emplace();
        interference(pairing.a, pairing.b, kPose, options, *workspace, *out);
      } catch (const std::bad_alloc&) {
        thrown = true;
      }
      reached = limit.was_reached();
    }
    ASSERT_EQ(thrown, reached) << "after " << failed << " allocations";
    // The same workspace, half used, then another pose and the first one again.
    if (!workspace) workspace.emplace();
    interference(pairing.a, pairing.b, kPose, options, *workspace, *out);
    ASSERT_TRUE(same_bits(out->total, expected.total)) << "after " << failed << " allocations";
    ASSERT_EQ(out->sites.size(), expected.sites.size());
    if (failed > 40) failed += failed / 10;  // of hundreds, every tenth
  }
  EXPECT_GT(failed, 1);
}

INSTANTIATE_TEST_SUITE_P(Engines, OutOfMemory, ::testing::ValuesIn(kPairings),
                         [](const auto& info) {
                           std::string name = info.param.name;
                           std::erase_if(name, [](char c) { return !std::isalnum(c); });
                           return name;
                         });

// A contact model with bristles and the formulation with a pressure field.
TEST(OutOfMemoryModel, EveryAllocationOfAColdEvaluationMayFail) {
  ContactLaws laws;
  laws.normal = make_normal("hunt_crossley", {});
  laws.friction = make_friction("bristle", {});
  for (const Formulation formulation : {Formulation::kGonthier, Formulation::kPotential}) {
    laws.formulation = formulation;
    const ContactModel model({{kCan, kBox, Pose{}, Pose{}}}, laws, {});
    const BodyMotion motion{kPose, Pose{}, Twist{}, Twist{}};
    ContactReport expected;
    {
      ContactModel::Workspace workspace;
      model.evaluate(motion, {}, workspace, expected);
      ASSERT_FALSE(expected.sites.empty());
    }
    long failed = 0;
    for (bool reached = true; reached; ++failed) {
      ASSERT_LT(failed, kMost);
      std::optional<ContactModel::Workspace> workspace;
      ContactReport report;
      bool thrown = false;
      {
        const AllocationLimit limit(failed);
        try {
          workspace.emplace();
          model.evaluate(motion, {}, *workspace, report);
        } catch (const std::bad_alloc&) {
          thrown = true;
        }
        reached = limit.was_reached();
      }
      ASSERT_EQ(thrown, reached) << "after " << failed << " allocations";
      if (!workspace) workspace.emplace();
      model.evaluate(motion, {}, *workspace, report);
      ASSERT_EQ(report.sites.size(), expected.sites.size());
      ASSERT_EQ(report.sites[0].force_on_A, expected.sites[0].force_on_A);
      ASSERT_EQ(report.memory, expected.memory);
    }
    EXPECT_GT(failed, 1);
  }
}

}  // namespace
}  // namespace volcontact::out_of_memory_test
