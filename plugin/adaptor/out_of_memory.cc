// SPDX-License-Identifier: Apache-2.0
#include "adaptor/out_of_memory.h"

#include <csetjmp>
#include <new>

namespace volcontact::adaptor {
namespace {

thread_local std::jmp_buf* way_out = nullptr;

// Nothing with a destructor lives here.
bool has_stepped(const mjModel* m, mjData* d, std::jmp_buf& place) {
  if (setjmp(place) != 0) return false;
  mj_step(m, d);
  return true;
}

}  // namespace

void stop_step() {
  if (way_out) std::longjmp(*way_out, 1);
  mju_error(
      "volcontact: out of memory in an evaluation of the contacts; the state is that before the "
      "step (free memory, then step again)");
}

void step_or_throw(const mjModel* m, mjData* d) {
  std::jmp_buf place;
  const auto stack = d->pstack;
  way_out = &place;
  const bool stepped = has_stepped(m, d, place);
  way_out = nullptr;
  if (stepped) return;
  d->pstack = stack;
  throw std::bad_alloc();
}

}  // namespace volcontact::adaptor
