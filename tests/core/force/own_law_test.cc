// SPDX-License-Identifier: Apache-2.0
#include "volcontact/force/own_law.h"

#include <gtest/gtest.h>

#include "volcontact/force/laws.h"

namespace volcontact::own_law_test {
namespace {

// Drag that grows with the way: a law as a user writes it.
struct WayDrag final : OwnFrictionLaw<WayDrag> {
  static constexpr const char* kName = "way_drag";
  struct Params {
    double drag = 2.0;
  };
  static constexpr std::array kFields{
      Field<Params>{"drag", "N s/m^2", &Params::drag, kNonNegative, "force per speed and way"}};
  static constexpr std::array kStates{StateField{"way", "m", Keeping::kValue, "slid so far"}};

  explicit WayDrag(const Params& params) : p(validated<WayDrag>(params)) {}
  FrictionOutput evaluate(const FrictionInput& in, const LawState& state) const noexcept override {
    const double way = state.pending[0] = state.committed[0] + in.travel.norm();
    FrictionOutput out;
    out.force = -p.drag * way * in.slip;
    out.slide_power = -out.force.dot(in.slip);
    return out;
  }
  Params p;
};

[[maybe_unused]] const bool is_added = add_law<WayDrag>();

TEST(OwnLaw, IsMadeByNameWithItsParametersAndStates) {
  const auto law = make_friction("way_drag", {{"drag", {3.0}}});
  EXPECT_STREQ(law->name(), "way_drag");
  ASSERT_EQ(law->state_size(), 1);
  const double committed = 0.5;
  double pending = 0.0;
  FrictionInput in;
  in.slip = in.travel = Vec3(0.1, 0.0, 0.0);
  const FrictionOutput out = law->evaluate(in, {&committed, &pending, 1.0});
  EXPECT_DOUBLE_EQ(pending, 0.6);
  EXPECT_DOUBLE_EQ(out.force.x(), -3.0 * 0.6 * 0.1);
}

TEST(OwnLaw, IsCheckedLikeTheOthers) {
  EXPECT_THROW(make_friction("way_drag", {{"drag", {-1.0}}}), std::invalid_argument);
  EXPECT_THROW(make_friction("way_drag", {{"drga", {1.0}}}), std::invalid_argument);
}

TEST(OwnLaw, ComesAfterTheLawsOfTheLibrary) {
  const auto& entries = friction_law_entries();
  EXPECT_EQ(entries.front().row.name, ElasticCoulomb::kName);
  EXPECT_EQ(entries.back().row.name, "way_drag");
  EXPECT_EQ(entries.back().row.field("drag")->defaults, std::vector<double>{2.0});
}

TEST(OwnLaw, NameThatIsTakenIsRefused) {
  EXPECT_THROW(add_law<WayDrag>(), std::invalid_argument);
  EXPECT_THROW(add_law<Bristle>(), std::invalid_argument);
}

}  // namespace
}  // namespace volcontact::own_law_test
