// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adaptor/evaluation/scratch.h"
#include "adaptor/memory/energy_account.h"
#include "adaptor/scene/scene_contact.h"

namespace volcontact::adaptor {

/// Evaluates all pairs again at the state of the last evaluation, for reading, into
/// `scratch.reports`; nothing is written to `d`. Returns false when there was no evaluation.
bool revisit(const SceneContact& contact, const mjModel* m, const mjData* d,
             EvaluationScratch& scratch);

/// Energies of the last evaluation; zero when there was none.
EnergyAccount energy(const SceneContact& contact, const mjModel* m, const mjData* d);

/// Evaluations in which a force was no number and was left out.
double dropped(const SceneContact& contact, const mjModel* m, const mjData* d);

/// Evaluations in which there were more contact sites than userdata keeps: the friction and the
/// impact speed of the rest began anew.
double forgotten(const SceneContact& contact, const mjModel* m, const mjData* d);

}  // namespace volcontact::adaptor
