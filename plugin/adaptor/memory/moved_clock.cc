// SPDX-License-Identifier: Apache-2.0
#include "adaptor/memory/moved_clock.h"

#include <algorithm>
#include <cmath>

namespace volcontact::adaptor {
namespace {

constexpr double kPlaceRounding = 1e-12;  // of positions
constexpr double kMethodError = 1e-6;  // of a step's way: what methods of higher order make of it

// Whether the evaluations are of this time: the next step, or one that is redone.
bool is_in_time(const mjModel* m, double time, const UserdataBlock& block) {
  for (int age = 0; age < block.count(); ++age) {
    const Slot slot = block.slot(age);
    const double ahead = time - slot.time();
    if (ahead >= 0.0) return ahead <= kLongestGap * std::max(m->opt.timestep, slot.step());
  }
  return false;
}

// Whether the positions are those of the last evaluation, `elapsed` seconds later [s]: a step, or
// none. The velocities over the step are between those at its ends; the last stage of a Runge-Kutta
// step is off by as much.
bool goes_on(const mjModel* m, const mjData* d, const UserdataBlock& block, double elapsed,
             std::vector<double>& way) {
  const double* qpos = block.motion();
  const double* qvel = qpos + m->nq;
  const double step = block.slot(0).step();
  mj_differentiatePos(m, way.data(), 1.0, qpos, d->qpos);
  double largest = 1.0;
  for (int i = 0; i < m->nq; ++i) largest = std::max(largest, std::abs(d->qpos[i]));
  for (int i = 0; i < m->nv; ++i) {
    const double change = std::abs(d->qvel[i] - qvel[i]);
    const double slack =
        step * (change + kMethodError * std::abs(d->qvel[i])) + kPlaceRounding * largest;
    // Not a number: another state.
    if (!(std::abs(way[static_cast<std::size_t>(i)] - elapsed * d->qvel[i]) <= slack)) return false;
  }
  return true;
}

}  // namespace

void follow_clock(const mjModel* m, const mjData* d, const UserdataBlock& block,
                  std::vector<double>& difference) {
  if (block.count() == 0 || is_in_time(m, d->time, block)) return;
  difference.resize(static_cast<std::size_t>(m->nv));
  for (const double elapsed : {block.slot(0).step(), 0.0}) {
    if (!goes_on(m, d, block, elapsed, difference)) continue;
    const double newest = d->time - elapsed, shift = newest - block.slot(0).time();
    for (int age = 1; age < block.count(); ++age) block.slot(age).time() += shift;
    block.slot(0).time() = newest;  // to the bit: a time that is met again is one that is redone
    return;
  }
}

void keep_motion(const mjModel* m, const mjData* d, const UserdataBlock& block) {
  const auto number = [](mjtNum x) { return std::isfinite(x) ? x : 0.0; };
  double* const velocities = std::transform(d->qpos, d->qpos + m->nq, block.motion(), number);
  std::transform(d->qvel, d->qvel + m->nv, velocities, number);
}

}  // namespace volcontact::adaptor
