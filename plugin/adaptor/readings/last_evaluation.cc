// SPDX-License-Identifier: Apache-2.0
#include "adaptor/readings/last_evaluation.h"

#include "adaptor/evaluation/evaluate_pairs.h"
#include "adaptor/evaluation/held_forces.h"

namespace volcontact::adaptor {
namespace {

// Whether the block has an evaluation of the present simulation. A block beside mjData is not reset
// with it, so there the time must tell.
bool has_evaluation(const UserdataBlock& block, const mjData* d, bool is_beside) {
  if (!block.is_ours() || block.count() == 0) return false;
  const double elapsed = d->time - block.slot(0).time();
  return !is_beside || (elapsed >= 0.0 && elapsed <= kLongestGap * block.slot(0).step());
}

}  // namespace

bool revisit(const SceneContact& contact, const mjModel* m, const mjData* d,
             EvaluationScratch& scratch) {
  if (!contact.has_room(m)) return false;
  const UserdataBlock our = contact.block(m, d);
  if (!has_evaluation(our, d, contact.is_beside())) return false;
  SitesBefore before;
  if (our.count() > 1) {
    before = {our.slot(1).states(), our.slot(0).time() - our.slot(1).time()};
  }
  scratch.mocaps = MocapMotion(our.slot(0).mocaps());
  try {
    evaluate_pairs(contact, m, d, before, scratch);
    recall_solved(our, scratch);
  } catch (...) {
    scratch = EvaluationScratch();
    throw;
  }
  return true;
}

EnergyAccount energy(const SceneContact& contact, const mjModel* m, const mjData* d) {
  if (!contact.has_room(m)) return {};
  const UserdataBlock our = contact.block(m, d);
  return has_evaluation(our, d, contact.is_beside()) ? our.slot(0).energy() : EnergyAccount{};
}

double dropped(const SceneContact& contact, const mjModel* m, const mjData* d) {
  if (!contact.has_room(m)) return 0.0;
  const UserdataBlock our = contact.block(m, d);
  return our.is_ours() ? our.dropped() : 0.0;
}

double forgotten(const SceneContact& contact, const mjModel* m, const mjData* d) {
  if (!contact.has_room(m)) return 0.0;
  const UserdataBlock our = contact.block(m, d);
  return our.is_ours() ? our.forgotten() : 0.0;
}

}  // namespace volcontact::adaptor
