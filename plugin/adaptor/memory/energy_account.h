// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>

#include "adaptor/memory/userdata_layout.h"

// How work and dissipated energy are summed over a simulation: docs/theory.md, "Energy".

namespace volcontact::adaptor {

/// (1 - weight) a + weight b
inline ByChannel between(const ByChannel& a, const ByChannel& b, double weight) {
  const auto mix = [weight](double x, double y) { return (1.0 - weight) * x + weight * y; };
  return {mix(a.normal, b.normal), mix(a.roll, b.roll), mix(a.slide, b.slide), mix(a.spin, b.spin)};
}

/// The account at the evaluation `now` (whose `dissipated` is not looked at), when the power
/// `mean_taken` acted for `elapsed` seconds since `before`. What bristles stored meanwhile is not
/// dissipated; what they gave back, or lost with their site, is.
inline EnergyAccount accounted(const EnergyAccount& before, const ByChannel& mean_taken,
                               double elapsed, EnergyAccount now) {
  now.dissipated = before.dissipated;
  now.dissipated.normal += elapsed * mean_taken.normal;
  now.dissipated.roll += elapsed * mean_taken.roll;
  now.dissipated.slide += elapsed * mean_taken.slide - (now.slide_energy - before.slide_energy);
  now.dissipated.spin += elapsed * mean_taken.spin - (now.spin_energy - before.spin_energy);
  return now;
}

/// The same where one of the two is of an implicit step: the forces of `before` acted all the time,
/// and all that they took from the motion, `taken`, counts, less what is stored now more than then.
inline EnergyAccount accounted_whole(const EnergyAccount& before, ByChannel taken, double elapsed,
                                     const EnergyAccount& now) {
  taken.normal += before.stored;
  EnergyAccount out = accounted(before, taken, elapsed, now);
  const auto of_volumes = [](const EnergyAccount& e) {
    return e.elastic - e.owed - e.slide_energy - e.spin_energy;
  };
  out.dissipated.normal -= of_volumes(now) - of_volumes(before);
  return out;
}

/// The mean power that an explicit step has taken, between those at its ends. Friction is what its
/// forces at the begin really did: `friction_later` is their power at the velocities of the end
/// [W].
inline ByChannel mean_taken(const EnergyAccount& before, const EnergyAccount& now,
                            double friction_later) {
  ByChannel mean = between(before.taken, now.taken, 0.5);
  const double begin = before.taken.slide + before.taken.spin;
  const double friction = begin - 0.5 * (friction_later - before.friction_power);
  const double slides = mean.slide + mean.spin != 0.0 ? mean.slide / (mean.slide + mean.spin) : 1.0;
  mean.slide = slides * friction;
  mean.spin = (1.0 - slides) * friction;
  return mean;
}

/// What is dissipated since the start at least, `elapsed` seconds after `before`, when `elastic` is
/// stored now [J].
inline double least_dissipated(const EnergyAccount& before, double elapsed, double elastic) {
  const double since = elapsed * (before.taken.sum() + before.stored) - (elastic - before.elastic);
  return before.dissipated.sum() + std::min(0.0, since);
}

/// Completes `now`, whose `dissipated` is there, by the `work` done and what mocap bodies have
/// `driven` since `before` [J].
inline void add_work(const EnergyAccount& before, double work, double driven, EnergyAccount& now) {
  const double spent = now.dissipated.sum() - before.dissipated.sum();
  now.work = before.work + work;
  now.driven = before.driven + driven;
  const double taken = work + (now.elastic - before.elastic) - driven;
  now.numerical = before.numerical - taken - spent;
  now.made = taken - (now.owed - before.owed) - (now.released - before.released);
}

/// Opens the slot of an evaluation and says how the account goes on from its predecessors.
class AccountKeeper {
 public:
  AccountKeeper(const UserdataBlock& block, double time, double step, bool runge_kutta)
      : block_(block) {
    // Runge-Kutta evaluates the middle of a step twice, with errors that cancel in the mean.
    const bool redone = runge_kutta && block.count() > 0 && block.slot(0).time() == time;
    const bool again = redone && block.slot(0).stage() == Stage::kMiddle;
    if (again) first_middle_ = block.slot(0).energy();
    // The last stage, at the end of a step, is the first evaluation there.
    has_last_ = redone && block.count() > 1 && block.slot(1).stage() == Stage::kSecondMiddle;
    if (has_last_) last_ = block.slot(0).energy();
    elapsed_ = open_slot(block, time, step);
    const bool half = runge_kutta && continues() && std::abs(2.0 * elapsed_ / step - 1.0) < 1e-6;
    if (!half) return;
    if (block.slot(1).stage() == Stage::kWhole) {
      block.slot(0).set_stage(again ? Stage::kSecondMiddle : Stage::kMiddle);
      is_within_step_ = true;
    } else {
      completes_ = block.count() > 2;
      is_within_step_ = !redone;
    }
  }

  bool continues() const { return block_.count() > 1; }
  double elapsed() const { return elapsed_; }
  /// Whether a step of Runge-Kutta goes on here, rather than begins.
  bool is_within_step() const { return is_within_step_; }
  /// The slot of the evaluation with which the step began that goes on or ends here, and the time
  /// since then [s]; continues() only.
  Slot begin() const { return block_.slot(completes_ ? 2 : 1); }
  double since_begin() const { return completes_ ? 2.0 * elapsed_ : elapsed_; }

  /// What the contacts have made in the step that ends here: their work, and what they hold more
  /// than before, beyond what was lent, driven and released [J]. 0 within a step, and where it
  /// cannot be told. `now` knows what is held, owed and released; the others as in write().
  double made(const EnergyAccount& now, double later, double driven) const {
    if (!continues() || is_within_step_ || (completes_ && !has_last_)) return 0.0;
    const EnergyAccount before = begin().energy();
    const double work = completes_ ? work_of_stages(before, last_.last_power)
                                   : elapsed_ * std::midpoint(before.force_power, later);
    return work - driven + kept_since(before, now);
  }

  /// Whether this is the last stage of a step of Runge-Kutta, which still can change its work.
  bool is_last_stage() const { return completes_ && is_within_step_; }
  /// The same as `made` at the last stage, if its forces have that power [J].
  double made_by_stages(const EnergyAccount& now, double power) const {
    const EnergyAccount before = begin().energy();
    return work_of_stages(before, power) + kept_since(before, now);
  }

  /// Writes the account of this evaluation: a whole Runge-Kutta step by its own rule, which is
  /// Simpson's (work with the powers of its four stages), all else by the trapezoidal rule.
  /// `later`: power of the forces of the evaluation before at the velocities of this one [W]. They
  /// act over all of a step, so the mean of it and of their power then is the change of kinetic
  /// energy that they make.
  /// `friction_later`: the same of friction alone. `driven`: the work of mocap bodies since then
  /// [J].
  void write(EnergyAccount now, double later, double friction_later, double driven) const {
    const Slot slot = block_.slot(0);
    if (slot.stage() == Stage::kSecondMiddle) {
      now.taken = between(first_middle_.taken, now.taken, 0.5);
      now.force_power = std::midpoint(first_middle_.force_power, now.force_power);
    }
    if (!continues()) {
      now.dissipated = {};
    } else if (completes_) {
      const EnergyAccount start = begin().energy(), middle = block_.slot(1).energy();
      if (start.implicit) {
        now = accounted_whole(start, start.taken, 2.0 * elapsed_, now);
      } else {
        const ByChannel& end = now.implicit && has_last_ ? last_.taken : now.taken;
        const ByChannel ends = between(start.taken, end, 0.5);
        now = accounted(start, between(ends, middle.taken, 2.0 / 3.0), 2.0 * elapsed_, now);
      }
      now.last_power = has_last_ ? last_.last_power : now.force_power;
      add_work(start, work_of_stages(start, now.last_power), driven, now);
    } else {
      const EnergyAccount before = block_.slot(1).energy();
      const bool whole = before.implicit || now.implicit;
      // Of an implicit step `taken` is the mean of the step that follows, not of this one.
      const ByChannel mean = mean_taken(before, whole ? before : now, friction_later);
      now = whole ? accounted_whole(before, mean, elapsed_, now)
                  : accounted(before, mean, elapsed_, now);
      add_work(before, elapsed_ * std::midpoint(before.force_power, later), driven, now);
      // The law's damping over a step is what its forces took in it, not what it says at the ends.
      if (!before.implicit && mean.normal > 0.0) {
        now.dissipated.normal += now.numerical - before.numerical;
        now.numerical = before.numerical;
      }
    }
    slot.set_energy(now);
  }

 private:
  // What the contacts hold more than before, beyond what was lent and released.
  static double kept_since(const EnergyAccount& before, const EnergyAccount& now) {
    return (now.elastic - before.elastic) - (now.owed - before.owed) -
           (now.released - before.released);
  }

  double work_of_stages(const EnergyAccount& start, double last_power) const {
    const double middle = block_.slot(1).energy().force_power;
    return 2.0 * elapsed_ * (start.force_power + 4.0 * middle + last_power) / 6.0;
  }

  UserdataBlock block_;
  double elapsed_ = 0.0;
  bool completes_ = false;  // this evaluation ends a Runge-Kutta step
  bool is_within_step_ = false;
  EnergyAccount first_middle_;
  bool has_last_ = false;
  EnergyAccount last_;  // of the last stage
};

}  // namespace volcontact::adaptor
