// SPDX-License-Identifier: Apache-2.0
// What ImplicitStep lets pairs do of work: docs/theory.md, "No energy from nothing".
#include <algorithm>

#include "volcontact/base/sizes.h"
#include "volcontact/step/implicit_step.h"

namespace volcontact {

void ImplicitStep::set_shares() {
  for (std::size_t i = 0; i < island_.size(); ++i) {
    Site& site = this->site(i);
    const double share = limits_[site.pair].share;
    for (Point& point : site.points) point.constant = share * point.full;
  }
}

// The work that the contacts do over the step, by pair.
void ImplicitStep::add_up_work(double step, double resting) {
  constexpr double kRounding = 1e-9;
  for_each_pair([](WorkLimit& limit) {
    limit.normal_work = limit.friction_work = limit.slack = limit.exit = limit.from_free = 0.0;
    limit.pushes = false;
  });
  double from_free = 0.0, allowed = 0.0;
  for (std::size_t i = 0; i < island_.size(); ++i) {
    using Block = ContactSpace::Block;
    const Block impulse = step * Block::from(&force_[i * size(kRows)]);
    const Block end = Block::from(&velocity_[i * size(kRows)]);
    const Block begin = space_.velocity(i), free = space_.free_velocity(i);
    const Block mean = 0.5 * (begin + end), mean_of_free = 0.5 * (free + end);
    WorkLimit& limit = limits_[site(i).pair];
    limit.normal_work += impulse.head<3>().dot(mean.head<3>());
    limit.friction_work += impulse.tail<3>().dot(mean.tail<3>());
    limit.from_free += impulse.head<3>().dot(mean_of_free.head<3>());
    limit.lend(impulse[0], mass_, resting, end[0]);
    limit.slack += kRounding * impulse.cwiseAbs().dot(begin.cwiseAbs() + end.cwiseAbs());
    limit.pushes = limit.pushes || impulse[0] > 0.0;
    if (impulse[0] > 0.0) limit.exit = std::max(limit.exit, end[0]);
    from_free += impulse.dot(mean_of_free);
  }
  // Where other forces turn velocities round, the energy is that of the free motion and what the
  // contacts of the island add to it; at rest they take it all.
  for_each_pair([&](const WorkLimit& limit) { allowed += limit.allowed() + limit.rubbed; });
  if (from_free <= allowed) return;
  for_each_pair(
      [](WorkLimit& limit) { limit.normal_work = std::max(limit.normal_work, limit.from_free); });
}

// Elastic forces that would do more work on the bodies than these put in act with a share of
// theirs. With none the contacts damp, whatever the poses: docs/theory.md, "No energy from
// nothing". What damps at the end of a step in which other forces turned the motion round does work
// all the same, and waits for the next.
void ImplicitStep::limit_work(double step, double resting) {
  constexpr int kSearches = 8;
  enum { kSearch, kLowest, kNone, kAllNone } last = kSearch;
  for_each_pair([](WorkLimit& limit) { limit.start(); });
  for (int round = 0; last != kAllNone; ++round) {
    add_up_work(step, resting);
    bool changed = false, kept = true;
    for_each_pair([&](const WorkLimit& limit) { kept = kept && limit.is_kept(); });
    if (round < kSearches) {
      for_each_pair([&](WorkLimit& limit) { changed = limit.search() || changed; });
      if (!changed) return;
    } else {
      if (kept) return;
      last = last == kSearch ? kLowest : last == kLowest ? kNone : kAllNone;
      for_each_pair([&](WorkLimit& limit) {
        if (last == kAllNone || (last == kNone && !limit.is_kept())) limit.share = 0.0;
        if (last == kLowest && !limit.is_kept())
          limit.share = limit.low.share < limit.share ? limit.low.share : 0.0;
      });
    }
    set_shares();
    solve_contacts(FrictionBound::kDamped, step);
  }
  add_up_work(step, resting);
  for (bool waits = true; waits;) {
    waits = false;
    for_each_pair([&waits](WorkLimit& limit) {
      if (!limit.acts || limit.is_kept_nearly()) return;
      limit.acts = false;
      waits = true;
    });
    if (!waits) break;
    solve_contacts(FrictionBound::kDamped, step);
    add_up_work(step, resting);
  }
  share_deficit();
}

// Where pairs did more than they hold, their friction or other pairs of the island have paid for
// it: these have put in the less.
void ImplicitStep::share_deficit() {
  for_each_pair([](WorkLimit& limit) { limit.pay_with_friction(); });
  double deficit = 0.0, put_in = 0.0;
  for_each_pair([&](const WorkLimit& limit) {
    deficit += std::max(0.0, limit.work() - limit.allowed());
    put_in += std::max(0.0, -limit.work());
  });
  if (!(deficit > 0.0 && put_in > 0.0)) return;
  const double left = std::max(0.0, 1.0 - deficit / put_in);
  for_each_pair([left](WorkLimit& limit) {
    if (limit.work() < 0.0) limit.normal_work *= left;
  });
}

}  // namespace volcontact
