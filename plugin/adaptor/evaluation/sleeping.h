// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adaptor/evaluation/scratch.h"
#include "adaptor/scene/scene_contact.h"

// Bodies that MuJoCo lets sleep. It lays trees to sleep one by one, knowing of no contact but its
// own; here what touches falls asleep together, and wakes what it touches: docs/plugin.md,
// "Sleeping bodies". Nothing happens with releases and models whose bodies do not sleep.

namespace volcontact::adaptor {

/// Wakes the trees that sleep and are touched by one that is awake, or by a mocap body that moves,
/// and those that they touch in turn. Returns whether there were some: then what MuJoCo made of the
/// step so far has to be made again.
bool wake_what_is_touched(const SceneContact& contact, const mjModel* m, mjData* d,
                          EvaluationScratch& scratch);

/// Makes again what MuJoCo has made of the step up to the passive forces, and these too.
void repeat_step_so_far(const mjModel* m, mjData* d);

/// Moves the pairs of which no side is awake from `scratch.cull.near` to `scratch.asleep`.
void set_aside_sleeping(const SceneContact& contact, const mjModel* m, const mjData* d,
                        EvaluationScratch& scratch);

/// Lets trees that touch at this evaluation fall asleep no sooner than the last of them may.
void hold_together(const SceneContact& contact, const mjModel* m, mjData* d,
                   EvaluationScratch& scratch);

/// What the pairs that sleep hold by what they kept [J].
struct SleepingEnergy {
  double elastic = 0.0;  ///< of the volumes
  double bristle = 0.0;
  double owed = 0.0;  ///< of what was lent to them
};
SleepingEnergy energy_asleep(const SceneContact& contact, const double* committed,
                             const EvaluationScratch& scratch);

}  // namespace volcontact::adaptor
