// SPDX-License-Identifier: Apache-2.0
#include "adaptor/collision_claims.h"

#include <algorithm>

#include "adaptor/mujoco/mujoco_compat.h"
#include "adaptor/out_of_memory.h"
#include "adaptor/scene_registry.h"

namespace volcontact::adaptor {
namespace {

mjfCollision originals[mjNGEOMTYPES][mjNGEOMTYPES];
int holders = 0;

bool is_claimed(const mjModel* m, int a, int b) {
  const SceneContact* contact = contact_of(m);
  if (!contact) return false;
  if (contact->options().pairs != PairRule::kListed) return true;  // flexes alone are MuJoCo's
  const SceneKeys& keys = contact->keys();
  // MuJoCo knows the geoms of a composed solid only one by one, holes as if they were bodies.
  if (keys.composed(a) || keys.composed(b)) return true;
  return keys.pair_of_geoms.count(std::minmax(a, b)) > 0;
}

// The arguments differ between releases: const or not, mjContact or mjPreContact.
template <typename Function>
struct Wrapper;
template <typename Model, typename Data, typename Contact>
struct Wrapper<int (*)(Model, Data, Contact, int, int, mjtNum)> {
  static int collide(Model m, Data d, Contact found, int a, int b, mjtNum margin) {
    bool claimed = false;
    if (!has_memory_for([&] { claimed = is_claimed(m, a, b); })) stop_step();
    if (claimed) return 0;
    const auto [first, second] = std::minmax(m->geom_type[a], m->geom_type[b]);
    return originals[first][second](m, d, found, a, b, margin);
  }
};
constexpr mjfCollision kWrapper = Wrapper<mjfCollision>::collide;

}  // namespace

void claim_pairs() {
  if (holders++ > 0) return;
  for (int i = 0; i < mjNGEOMTYPES; ++i) {
    for (int j = 0; j < mjNGEOMTYPES; ++j) {
      originals[i][j] = mjCOLLISIONFUNC[i][j];
      if (originals[i][j]) mjCOLLISIONFUNC[i][j] = kWrapper;
    }
  }
}

void unclaim_pairs() {
  if (--holders > 0) return;
  for (int i = 0; i < mjNGEOMTYPES; ++i) {
    for (int j = 0; j < mjNGEOMTYPES; ++j) {
      if (mjCOLLISIONFUNC[i][j] == kWrapper) mjCOLLISIONFUNC[i][j] = originals[i][j];
    }
  }
}

}  // namespace volcontact::adaptor
