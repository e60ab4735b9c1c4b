// SPDX-License-Identifier: Apache-2.0
#include "adaptor/auto_attach.h"

#include <atomic>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "adaptor/mujoco/mujoco_compat.h"
#include "adaptor/scene_registry.h"

namespace volcontact::adaptor {
namespace {

std::atomic<bool> is_on{false};

// The model that was refused last: it is not asked again at every step. The first warning may be
// lost, since MuJoCo evaluates once when it compiles and catches warnings there.
struct Refused {
  const mjModel* model = nullptr;
  long long names = 0;
  long long userdata = 0;
  int times = 0;
};
thread_local Refused refused;
constexpr int kMostRefusals = 2;

bool is_refused(const mjModel* m) noexcept {
  return refused.model == m && refused.names == m->nnames && refused.userdata == m->nuserdata &&
         refused.times >= kMostRefusals;
}

void refuse(const mjModel* m, const std::string& why) {
  if (refused.model != m || refused.names != m->nnames || refused.userdata != m->nuserdata) {
    refused = {m, m->nnames, m->nuserdata, 0};
  }
  ++refused.times;
  write_warning("volcontact: contact stays native: " + why);
}

void attach(mjModel* m, Wish wish) {
  std::string problem;
  try {
    for (const std::string& warning : attach_scene(m, {}, Attacher::kItself)) {
      write_warning("volcontact: " + warning);
    }
    if (wish == Wish::kByKeys) {  // the program has no word for it, so it is said here
      std::fprintf(stderr, "volcontact: the contact of model '%s' is volumetric\n", m->names);
    }
    return;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    problem = error.what();
  } catch (...) {
    problem = "an exception of unknown type";
  }
  refuse(m, problem);
}

}  // namespace

bool attaches_by_itself() noexcept { return is_on.load(std::memory_order_relaxed); }
void set_attaches_by_itself(bool on) noexcept { is_on = on; }

const SceneContact* contact_by_itself(const mjModel* m, Wish wish) {
  // The host's own model, which its program may write; it does not know that it asked for this.
  auto* model = const_cast<mjModel*>(m);
  const SceneContact* contact = contact_of(m);
  if (!contact) {
    if (is_refused(m) || (wish == Wish::kByKeys && !has_scene_keys(m))) return nullptr;
    attach(model, wish);
    return nullptr;
  }
  if (contact->options().pairs == PairRule::kListed) return contact;
  if (m->opt.disableflags & mjDSBL_CONTACT) return contact;
  // Attached while MuJoCo compiled it, which wrote the flags of the file again afterwards.
  model->opt.disableflags |= mjDSBL_CONTACT | kAttachedMark;
  return nullptr;
}

}  // namespace volcontact::adaptor
