// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adaptor/evaluation/scratch.h"
#include "adaptor/scene/scene_contact.h"

namespace volcontact::adaptor {

/// Puts volcontact_passive into mjcb_passive; what was there before is called first from then on.
void install_callback();

/// Puts back what was there before, unless somebody has replaced ours.
void uninstall_callback();

bool callback_is_installed();

/// Scratch memory of the calling thread.
EvaluationScratch& thread_scratch();

}  // namespace volcontact::adaptor
