// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adaptor/evaluation/scratch.h"
#include "adaptor/scene/scene_contact.h"

// What pairs hold of the energy of the bodies, and the forces that would give back more.

namespace volcontact::adaptor {

/// What the pairs hold of the energy of the bodies, after the step that ends here, into
/// `scratch.energies`, with what their sites are `now`; what nobody paid, and what is owed, into
/// the account.
void read_energies(const SceneContact& contact, const double* committed, double elapsed,
                   bool is_rk4, EvaluationScratch& scratch, EnergyAccount& account);

/// Finds what the contacts of pairs may do on the bodies in the coming step, where all contacts
/// have `dissipated` that much so far [J].
void know_limits(const SceneContact& contact, const mjModel* m, double dissipated,
                 EvaluationScratch& scratch);
/// The same of the pair at place k of `near`.
WorkLimit limit_of(std::size_t k, const EvaluationScratch& scratch);

/// Lends to a pair of geoms what gravity does while the explicit force of a site acts that parts at
/// that speed.
void lend(const SceneContact& contact, const mjModel* m, const GeomPair& geoms,
          const SiteReport& site, double parting, WorkLimit& limit);

/// Whether the explicit forces of a pair may do more work than it holds: as if on a ball, which
/// gives way by turning, too.
bool may_overdraw(const SceneContact& contact, const mjModel* m, std::size_t k,
                  const EvaluationScratch& scratch);

/// Runge-Kutta's stages are exact enough, but for what no motion put in, and at the end of a touch:
/// pairs that would give back more than they got count as stiff. `begins`: whether a step begins
/// here. Returns whether there are some.
bool find_unpaid_pairs(const SceneContact& contact, const mjModel* m, bool begins,
                       EvaluationScratch& scratch);

/// The same bound for pairs whose forces are explicit. Returns whether some are less than their
/// laws say.
bool limit_explicit(const SceneContact& contact, const mjModel* m, EvaluationScratch& scratch);

/// Lets pairs off what they owe more than `before` an explicit step and did not do: `work`, of all
/// their normal forces [J], is exact, while each knows its own by its approach at the end, where
/// the normal has turned.
void forgive(double work, const EnergyAccount& before, EvaluationScratch& scratch,
             EnergyAccount& now);

/// Takes off what the pairs hold as much as the contacts have `made` in the step that ends here, as
/// far as they hold it, and returns what that is [J]: what a solved step could not foresee, and
/// what an explicit one errs by, is paid for.
double pay_for(const mjModel* m, mjData* d, double made, EvaluationScratch& scratch);

/// The share of the forces of Runge-Kutta's last stage, which have that `power`, with which the
/// stages make no more than the pairs can pay for, where they would have `made` more: less than
/// all of a force that pushes, or more of one that brakes.
double last_share(const mjModel* m, mjData* d, double made, double power,
                  EvaluationScratch& scratch);

/// What the contacts have `made` beyond all that is paid for, as far as bodies that part slowly may
/// get it of what was dissipated [J]: a normal that turns in the step tells it late.
double release_for(double made, const EvaluationScratch& scratch);

/// Writes the rows behind those of the sites; false when there was no room for all.
bool keep_energies(const SceneContact& contact, const double* committed, double* states,
                   EvaluationScratch& scratch);

}  // namespace volcontact::adaptor
