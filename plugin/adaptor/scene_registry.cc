// SPDX-License-Identifier: Apache-2.0
#include "adaptor/scene_registry.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <new>
#include <stdexcept>
#include <vector>

#include "adaptor/collision_claims.h"
#include "volcontact/base/check.h"

namespace volcontact::adaptor {
namespace {

// One set of numbers a model had, and the contact made of it. Where the numbers were not valid the
// contact is that of the last valid ones.
struct Variant {
  ModelContent content;
  std::shared_ptr<const SceneContact> contact;
  std::string error;
  mutable std::atomic<bool> reported{false};

  Variant(const mjModel* m, std::shared_ptr<const SceneContact> made, std::string why)
      : content(m, made->keys(), made->flush().groups()),
        contact(std::move(made)),
        error(std::move(why)) {}
};
using VariantPointer = std::shared_ptr<const Variant>;

// Simulations of a batch may have numbers of their own, in turn: keep a good many.
constexpr std::size_t kVariantsKept = 64;

struct AttachedScene {
  const mjModel* model;
  Attacher attacher;
  bool contact_was_disabled;
  bool claims_pairs;                     // one by one, and leaves MuJoCo's own contact on
  std::vector<VariantPointer> variants;  // the latest last
  std::shared_ptr<const SceneContact> last_valid;
};

std::mutex registry_mutex;
std::vector<AttachedScene>& registry() {
  static std::vector<AttachedScene> scenes;
  return scenes;
}
// Grows with every attach and detach, so that threads notice.
std::atomic<std::uint64_t> generation{1};

std::shared_ptr<const SceneContact> make_contact(const mjModel* m,
                                                 const std::vector<GivenKey>& given,
                                                 const SceneContact* before = nullptr) {
  auto contact = std::make_shared<SceneContact>(m, given, before);
  contact->find_room(m, before);
  return contact;
}

std::vector<AttachedScene>::iterator find_scene(const mjModel* m) {
  return std::find_if(registry().begin(), registry().end(),
                      [m](const AttachedScene& scene) { return scene.model == m; });
}

void forget(std::vector<AttachedScene>::iterator scene) {
  if (scene->claims_pairs) unclaim_pairs();
  registry().erase(scene);
}

void restore_flags(const AttachedScene& scene, mjModel* m) {
  m->opt.disableflags &= ~kAttachedMark;
  if (!scene.contact_was_disabled) m->opt.disableflags &= ~mjDSBL_CONTACT;
}

// What may not change in an attached model.
void require_same_structure(const SceneContact& before, const SceneContact& now) {
  require(before.options().target == now.options().target,
          "volcontact/option/target cannot change while the model is attached");
  require(before.options().pairs == now.options().pairs,
          "volcontact/option/pairs cannot change while the model is attached");
}

// The contact for the present numbers of `m`, made when they are new.
VariantPointer variant_for(AttachedScene& scene, const mjModel* m) {
  for (const VariantPointer& variant : scene.variants) {
    if (variant->content.has_same_values(m)) return variant;
  }
  std::string error;
  try {
    const SceneContact& before = *scene.last_valid;
    auto contact = make_contact(m, before.keys().given, &before);
    require_same_structure(before, *contact);
    scene.last_valid = std::move(contact);
  } catch (const std::bad_alloc&) {
    throw;  // the numbers may be valid all the same
  } catch (const std::exception& invalid) {
    error = invalid.what();
  }
  if (scene.variants.size() == kVariantsKept) scene.variants.erase(scene.variants.begin());
  scene.variants.push_back(std::make_shared<const Variant>(m, scene.last_valid, error));
  return scene.variants.back();
}

bool is_copy_of(const AttachedScene& scene, const mjModel* m) {
  return (m->opt.disableflags & kAttachedMark) != 0 &&
         scene.variants.back()->content.is_same_model(m);
}

VariantPointer look_up(const mjModel* m) {
  const std::lock_guard lock(registry_mutex);
  const auto own = find_scene(m);
  if (own != registry().end() && own->variants.back()->content.is_same_model(m)) {
    return variant_for(*own, m);
  }
  for (AttachedScene& scene : registry()) {
    if (is_copy_of(scene, m)) return variant_for(scene, m);
  }
  return nullptr;
}

// What a thread found last for a model. The address is a hint only: content decides.
struct Found {
  const mjModel* model = nullptr;
  std::uint64_t generation = 0;
  VariantPointer variant;
};

// Valid until this thread asks for another model: the cache keeps it alive.
const Variant* find_variant(const mjModel* m) {
  thread_local std::array<Found, 4> cache;
  thread_local std::size_t next = 0;
  const std::uint64_t now = generation.load(std::memory_order_acquire);
  for (const Found& found : cache) {
    if (found.model == m && found.generation == now && found.variant &&
        found.variant->content.is_same_model(m) && found.variant->content.has_same_values(m)) {
      return found.variant.get();
    }
  }
  VariantPointer variant = look_up(m);
  if (!variant) return nullptr;
  const auto same = std::find_if(cache.begin(), cache.end(),
                                 [m](const Found& found) { return found.model == m; });
  Found& place = same != cache.end() ? *same : cache[next++ % cache.size()];
  place = {m, now, std::move(variant)};
  return place.variant.get();
}

}  // namespace

std::vector<std::string> attach_scene(mjModel* m, const std::vector<GivenKey>& given,
                                      Attacher attacher) {
  require(can_wake() || !sleep_enabled(m),
          "the model has <flag sleep=\"enable\"/>: under MuJoCo " + version_text(mjVERSION_HEADER) +
              " volumetric contact never wakes a sleeping body; disable it, or use 4.0.0 or later");
  const auto contact = make_contact(m, given);
  const auto first = std::make_shared<const Variant>(m, contact, "");
  const std::lock_guard lock(registry_mutex);
  const auto present = find_scene(m);
  if (present != registry().end()) {
    const bool is_same = present->variants.back()->content.is_same_model(m);
    if (is_same && present->attacher == Attacher::kAuthor) {
      throw std::logic_error("the model is attached already");
    }
    if (is_same) restore_flags(*present, m);
    forget(present);  // else deleted without a detach; this is another model at its address
  }
  // In a copy of an attached model the flag is ours.
  const bool was_disabled =
      (m->opt.disableflags & mjDSBL_CONTACT) != 0 && (m->opt.disableflags & kAttachedMark) == 0;
  const bool claims_pairs = contact->options().pairs == PairRule::kListed || has_flexes(m);
  registry().push_back({m, attacher, was_disabled, claims_pairs, {first}, contact});
  m->opt.disableflags |= kAttachedMark;
  if (claims_pairs) {
    claim_pairs();
  } else {
    m->opt.disableflags |= mjDSBL_CONTACT;
  }
  generation.fetch_add(1, std::memory_order_release);
  return contact->alerts();
}

bool detach_scene(mjModel* m) {
  bool goes_on = false;
  {
    const std::lock_guard lock(registry_mutex);
    const auto scene = find_scene(m);
    if (scene == registry().end()) return false;
    goes_on = scene->last_valid->is_in_plugin();
    restore_flags(*scene, m);
    forget(scene);
    generation.fetch_add(1, std::memory_order_release);
  }
  // The scene itself asks for its contact; now, so that no evaluation is native.
  if (goes_on) attach_scene(m, {}, Attacher::kItself);
  return true;
}

bool is_attached(const mjModel* m) {
  const std::lock_guard lock(registry_mutex);
  return find_scene(m) != registry().end();
}

int scenes_of_the_callback() {
  const std::lock_guard lock(registry_mutex);
  return static_cast<int>(
      std::count_if(registry().begin(), registry().end(),
                    [](const AttachedScene& scene) { return !scene.last_valid->is_in_plugin(); }));
}

const SceneContact* contact_of(const mjModel* m) {
  const Variant* variant = find_variant(m);
  if (!variant) return nullptr;
  if (!variant->error.empty() && !variant->reported.exchange(true)) {
    write_warning("volcontact goes on with the last valid numbers: " + variant->error);
  }
  return variant->contact.get();
}

std::string live_error(const mjModel* m) {
  const Variant* variant = find_variant(m);
  return variant ? variant->error : "";
}

}  // namespace volcontact::adaptor
