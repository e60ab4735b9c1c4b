// SPDX-License-Identifier: Apache-2.0
#include "adaptor/scene/pair_store.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "adaptor/scene_registry.h"
#include "adaptor/support/models.h"
#include "volcontact/force/laws.h"

namespace volcontact::adaptor::pair_store_test {
namespace {

PairContact ball_on_plane(int number) {
  const ContactLaws laws{make_normal("volume_spring", {}), nullptr};
  return {{number, number + 1, PairOrigin::kMasks},
          Engine::kClosedForm,
          ContactModel({{Sphere({.radius = 0.1}), HalfSpace(), Pose{}, Pose{}}}, laws, {}),
          1e7};
}

TEST(PairStore, MakesEachPairOnceWhateverManyThreadsAsk) {
  const PairStore store;
  std::atomic<int> made = 0;
  std::vector<std::vector<const PairContact*>> seen(4, std::vector<const PairContact*>(500));
  std::vector<std::thread> threads;
  for (auto& mine : seen) {
    threads.emplace_back([&] {
      for (std::size_t i = 0; i < 500; ++i) {
        mine[i] = &store.get(PairId(i * i * 1000003),
                             [&] { return ++made, ball_on_plane(static_cast<int>(i)); });
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(made, 500);
  EXPECT_EQ(store.made(), 500u);
  for (const auto& mine : seen) EXPECT_EQ(mine, seen[0]);
  EXPECT_EQ(seen[0][7]->geoms.a, 7);
}

// Fifty boxes side by side on a floor, and one that falls on the first of them.
std::string boxes() {
  std::string bodies;
  for (int i = 0; i < 50; ++i) {
    bodies += "<body pos=\"" + std::to_string(.25 * i) +
              " 0 .0999\"><freejoint/><geom type=\"box\" size=\".1 .1 .1\" mass=\"1\"/></body>";
  }
  return "<mujoco><worldbody><geom type=\"plane\" size=\"9 9 1\"/>" + bodies +
         "<body pos=\"0 0 .5\"><freejoint/><geom type=\"sphere\" size=\".05\" mass=\"1\"/></body>"
         "</worldbody></mujoco>";
}

TEST(PairStore, ASceneMakesThePairsThatComeNear) {
  const testing::ModelPointer m = testing::load(boxes());
  const testing::DataPointer d = testing::make_data(m);
  const testing::Attached attached(m);
  const SceneContact* contact = contact_of(m.get());
  ASSERT_NE(contact, nullptr);
  EXPECT_EQ(contact->rules().count(), 52u * 51u / 2u);
  EXPECT_EQ(contact->made_pairs(), 1u);  // of the one class of laws
  mj_step(m.get(), d.get());
  EXPECT_EQ(contact->made_pairs(), 50u);  // the floor with each box
  for (int i = 0; i < 500; ++i) mj_step(m.get(), d.get());
  EXPECT_EQ(contact->made_pairs(), 51u);
}

}  // namespace
}  // namespace volcontact::adaptor::pair_store_test
