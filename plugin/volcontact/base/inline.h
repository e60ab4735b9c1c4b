// SPDX-License-Identifier: Apache-2.0
#pragma once

// For a function of a few instructions that inner loops call: part of its caller with few
// optimisations, too, and known to the compiler early.
#define VOLCONTACT_INLINE [[gnu::always_inline]] inline
