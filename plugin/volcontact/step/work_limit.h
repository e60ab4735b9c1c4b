// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "volcontact/model/contact_report.h"

namespace volcontact {

/// What a pair of geoms holds of the energy of the bodies, from evaluation to evaluation while they
/// touch: docs/theory.md, "No energy from nothing". Kept in eight numbers.
struct PairEnergy {
  static constexpr int kNumbers = 8;
  /// What a pair may give back above what it got, of the most it ever held, or less: of the energy
  /// there is. An explicit step errs by more, by up to h^2 k/m of it, as often too little as too
  /// much; what would be too much is held back.
  static constexpr double kOverdraft = 5e-4;
  /// What an explicit step gave too much all the same it owes, up to this of the most.
  static constexpr double kMostOwed = 0.05;
  /// Motion within a step may have put in this many times what it seems to at its ends.
  static constexpr double kRoom = 1.5;

  double stored = 0.0;  ///< put in by motion and not given back [J]
  double found = 0.0;   ///< elastic energy that was there when the simulation began [J]
  double most = 0.0;    ///< largest `stored` of this touch [J]
  double rubbed = 0.0;  ///< put into bristles by sliding, and not given back [J]
  // Of an explicit step, whose work is known at its end: force, and its power at the begin.
  double force = 0.0;   ///< f_n of all sites [N]
  double power = 0.0;   ///< sum of f_n v_n, > 0 while approaching [W]
  double slow = 0.0;    ///< what it may release in the step [J]
  double unpaid = 0.0;  ///< what the law held at the begin and no motion had put in [J]

  bool is_solved = false;  ///< by an implicit step, whose work is in already; not kept
  double released = 0.0;   ///< to bodies that part slowly, of what was dissipated [J]; not kept
  double releases = 0.0;   ///< what it may have released more in the step that ended [J]; not kept
  /// Of the bristles at the begin of the step, as far as sliding put it in [J]; not kept.
  double bristle = HUGE_VAL;
  /// Of what is held, as much as may be there although no motion put it in [J]; not kept.
  double doubtful = HUGE_VAL;
  /// Of what is held, as much as was there before the step that follows was solved [J]; not kept.
  double at_hand = HUGE_VAL;

  /// The sites of a pair at the present evaluation, together.
  struct Now {
    double elastic = 0.0;  ///< of the volumes [J]
    double bristle = 0.0;  ///< of the bristles [J]
    double force = 0.0;    ///< [N]
    double power = 0.0;    ///< [W]
    double volume = 0.0, swept = 0.0;
    bool is_within = false;  ///< one body lies in the other: no law holds what went in

    Now() = default;
    explicit Now(const ContactReport& report) noexcept {
      for (const SiteReport& site : report.sites) add(site);
    }
    void add(const SiteReport& site) noexcept {
      bristle += site.bristle_energy.sum();
      elastic += site.elastic_energy - site.bristle_energy.sum();
      force += site.normal_force;
      power += site.normal_force * site.approach_speed;
      volume += site.metrics.volume;
      swept += site.metrics.volume * site.approach_speed;
      is_within = is_within || site.normal.isZero(0.0);
    }
    double approach() const noexcept {  // [m/s]
      return force > 0.0 ? power / force : volume > 0.0 ? swept / volume : 0.0;
    }
    /// Kinetic energy of bodies of that inverse mass along the contact [J].
    double moving(double inverse_mass) const noexcept {
      return 0.5 * approach() * approach() / inverse_mass;
    }
  };

  /// Whether the step before was solved, and `rubbed` is what sliding did.
  bool was_solved() const noexcept { return force == 0.0; }

  /// What motion put in by an explicit step, as the speeds at its ends tell it [J].
  double put_in(double elapsed, const Now& now) const noexcept {
    return 0.5 * elapsed * (power + force * now.approach());
  }

  /// The end of a step of `elapsed` seconds. Stages of Runge-Kutta at which a pair waited for the
  /// next step had no force: at the worst the first alone, which counts a sixth.
  void take_in(double elapsed, const Now& now, bool may_have_waited = false) noexcept {
    // Explicit steps know velocities half a step before positions: on the way out the law holds
    // less by the work of half a step.
    const double ahead = force > 0.0 ? 0.5 * elapsed * std::max(0.0, -now.power) : 0.0;
    const double work = put_in(elapsed, now);
    // What sliding put in and bristles do not hold is dissipated: it pays what is owed.
    if (was_solved() && stored < 0.0) {
      stored = std::min(0.0, stored + std::max(0.0, rubbed - now.bristle));
    }
    bristle = was_solved() ? std::min(rubbed, now.bristle) : now.bristle;
    if (!was_solved())
      put(may_have_waited && work > 0.0 ? work / 6.0 : work, 0.0, kMostOwed * most);
    releases = slow - released;
    force = power = slow = 0.0;
    rubbed = std::min(rubbed, now.bristle);
    if (!now.is_within) keep_within(now.elastic + ahead);
    most = std::max(most, stored);
  }

  /// Whether motion can have put in what the law holds `now`, but for what was unpaid before, in a
  /// step of `elapsed` seconds. A potential takes in work by turns, too, which power does not know:
  /// `by_turns`, at most, of what it holds.
  bool explains(double elapsed, const Now& now, double by_turns = 0.0) const noexcept {
    const double before = force > 0.0 ? power / force : 0.0;
    const double power_at_most =
        std::max(force, now.force) * std::max({0.0, before, now.approach()});
    const double overdraft = kOverdraft + by_turns;
    return now.elastic <= stored + found + unpaid + overdraft * std::max(most, now.elastic) +
                              kRoom * elapsed * power_at_most;
  }

  /// The end of a step whose method is exact enough: what the law holds more, or less, was put in
  /// by motion, or given back.
  void follow(double elapsed, const Now& now) noexcept {
    const double put_in = 0.5 * elapsed * (power + now.power);
    const double explained = stored + found + std::max(kRoom * put_in, put_in / kRoom);
    found = std::min(found, now.elastic);
    stored = std::max(0.0, now.elastic - found - unpaid);
    doubtful = std::max(0.0, stored + found - explained);
    most = std::max(most, stored);
    bristle = now.bristle;
    act(now);
  }

  /// What follows is a step by the law. Its force is never 0, even where that of the law is.
  void act(const Now& now) noexcept {
    rubbed = now.bristle;
    force = std::max(now.force, std::numeric_limits<double>::min());
    power = now.power;
    unpaid = std::max(0.0, now.elastic - stored - found);
  }

  double held() const noexcept { return std::max(0.0, stored) + found; }
  /// What was lent, and is not repaid [J].
  double owed() const noexcept { return std::max(0.0, -stored); }
  /// The most that can be taken off what is held, for what the contacts have made [J].
  double payable() const noexcept { return std::min({held(), doubtful, at_hand}); }
  /// Lets off a share of what is owed.
  void forgive(double share) noexcept { stored += share * owed(); }
  void pay(double share) noexcept {
    const double left = held() > 0.0 ? 1.0 - share * payable() / held() : 1.0;
    unpaid += (1.0 - left) * held();
    if (stored > 0.0) stored *= left;
    found *= left;
  }

  /// An implicit step that does `work` on the bodies, of which friction does `friction_work`, and
  /// may release that much. `lent`: what it may do more, and owes.
  void solve(double work, double friction_work = 0.0, double may_release = 0.0,
             double lent = 0.0) noexcept {
    is_solved = true;
    at_hand = held();
    force = power = unpaid = 0.0;
    slow = may_release;
    rubbed = std::max(0.0, rubbed - friction_work);
    put(-work, lent, lent);  // once, and not in every step anew
    slow = 0.0;
  }

  void write(double* row) const noexcept {
    const double numbers[kNumbers] = {stored, found, most, rubbed, force, power, slow, unpaid};
    std::copy(std::begin(numbers), std::end(numbers), row);
  }
  static PairEnergy from(const double* row) noexcept {
    return {row[0], row[1], row[2], row[3], row[4], row[5], row[6], row[7]};
  }
  /// Takes over what another pair has kept: the solids of both have become one.
  PairEnergy& operator+=(const PairEnergy& other) noexcept {
    stored += other.stored;
    found += other.found;
    most += other.most;
    rubbed += other.rubbed;
    force += other.force;
    power += other.power;
    slow += other.slow;
    unpaid += other.unpaid;
    return *this;
  }

  /// Work done on the contact. What it gives back at a slow exit was found; the rest of that,
  /// beyond what is lent, had been dissipated, and is so no more. Steps may owe what they err by;
  /// what is owed stays.
  void put(double work, double lent, double owed) noexcept {
    const double least = std::min(-owed, stored);
    stored += work;
    const double given = std::clamp(-stored, 0.0, found);
    stored += given;
    found -= given;
    const double freed = std::clamp(std::min(-lent - stored, -work - given), 0.0, slow);
    stored += freed;
    released += freed;
    stored = std::max(stored, least);
  }

  /// No more can be stored than the law holds at the present pose.
  void keep_within(double elastic) noexcept {
    found = std::min(found, elastic);
    const double lost = stored + found - elastic;
    if (lost > 0.0) stored -= lost;
  }
};

/// What the contacts of one pair may do on the bodies in one step, and what they do.
struct WorkLimit {
  double stored = 0.0;      ///< at any speed [J]
  double overdraft = 0.0;   ///< that much above it: what a step errs by [J]
  double slow = 0.0;        ///< besides, while the bodies part slower than `exit_speed` [J]
  double exit_speed = 0.0;  ///< [m/s]
  double rubbed = 0.0;      ///< by friction, from its bristles [J]

  double share = 1.0;          ///< of the elastic force that acts
  bool acts = true;            ///< or whether the pair waits for the next step
  bool is_solved = false;      ///< by an implicit step
  double normal_work = 0.0;    ///< of the normal forces on the bodies over the step [J]
  double friction_work = 0.0;  ///< of friction [J]
  double from_free = 0.0;      ///< of the normal forces, from the motion without contact [J]
  double slack = 0.0;  ///< what other forces do meanwhile, which a finite step cannot tell [J]
  double exit = 0.0;   ///< fastest parting at the end of the step [m/s]

  bool pushes = false;  ///< whether a normal force of the pair acts

  // Shares between which the one sought lies, with the work and the parting under them.
  struct Tried {
    double share = 0.0, work = 0.0, exit = 0.0;
  };
  Tried low, high;
  bool is_high_known = false;

  /// `dissipated`: by all contacts of the scene so far [J]; `moving`: kinetic energy that the
  /// bodies will have along the contact when they part, of which with what is stored a part may be
  /// overdrawn [J].
  static WorkLimit of(const PairEnergy& energy, double dissipated, double exit_speed,
                      double moving = HUGE_VAL) noexcept {
    WorkLimit limit;
    const double there = std::max(0.0, energy.stored) + energy.found + moving;
    limit.stored = energy.stored;
    limit.overdraft = PairEnergy::kOverdraft * std::min(energy.most, std::max(0.0, there));
    limit.slow = energy.found + std::max(0.0, dissipated);
    limit.exit_speed = exit_speed;
    limit.rubbed = energy.rubbed;
    return limit;
  }

  /// Lends, to an `impulse`, what gravity does meanwhile where it changes the speed along it by
  /// `fall`: no more than to the weight of what may rest on the contact, and nothing to what parts
  /// faster.
  void lend(double impulse, double mass, double fall, double parting) noexcept {
    if (parting <= fall) slack += 0.5 * std::clamp(impulse, 0.0, mass * fall) * fall;
  }

  /// No more a step than bodies of that inverse mass need to get as fast as that, and to be lifted
  /// where free motion changes speeds by `fall`.
  WorkLimit& for_bodies(double mobility, double fall) noexcept {
    slow = std::min(slow, exit_speed * (0.5 * exit_speed + fall) / mobility);
    return *this;
  }

  double released_at_most() const noexcept { return exit <= exit_speed ? slow : 0.0; }
  double lent() const noexcept { return std::max(overdraft, slack); }
  double at_any_speed() const noexcept { return stored + lent(); }
  double allowed() const noexcept { return at_any_speed() + released_at_most(); }
  /// What friction gives beyond what its bristles hold; what it dissipates pays for nothing.
  double drawn_by_friction() const noexcept { return std::max(0.0, friction_work - rubbed); }
  /// What is drawn from the pair.
  double work() const noexcept { return normal_work + drawn_by_friction(); }
  bool is_kept() const noexcept { return work() <= allowed(); }
  /// The same but for little of what it takes from the motion without contact: at rest against a
  /// servo both ends of a step are slow, and the work hangs on rounding.
  bool is_kept_nearly() const noexcept {
    constexpr double kLittle = 0.01;
    return is_kept() || work() - allowed() <= kLittle * std::abs(from_free);
  }

  /// What the normal forces did beyond what is allowed comes off what friction took.
  void pay_with_friction() noexcept {
    const double paid = std::clamp(work() - allowed(), 0.0, std::max(0.0, -friction_work));
    normal_work -= paid;
    friction_work += paid;
  }

  void start() noexcept {
    low = {};
    is_high_known = false;
  }

  /// Chooses the next share to try; false when the present one will do. The shares of other pairs
  /// change with it, so that what was kept may be kept no more.
  bool search() noexcept {
    constexpr double kEnough = 0.8, kNarrow = 0.05, kNothing = 1e-3, kAside = 0.1;
    if (is_kept()) {
      low = {share, work(), exit};
      if (is_high_known && high.share <= share) is_high_known = false;
      const bool is_near = (is_high_known ? high.share : 1.0) - share < kNarrow;
      if (share >= 1.0 || !pushes || is_near || work() >= kEnough * allowed()) return false;
      if (slow > 0.0 && exit >= kEnough * exit_speed && exit <= exit_speed) return false;
    } else {
      high = {share, work(), exit};
      is_high_known = true;
      if (low.share >= share) low = {};
      if (allowed() < kNothing * work()) {
        share = 0.0;
        return true;
      }
    }
    const double top = is_high_known ? high.share : 1.0;
    const double at = is_high_known ? likely_share() : 0.5;
    share = low.share + std::clamp(at, kAside, 1.0 - kAside) * (top - low.share);
    return true;
  }

  /// Where between the two the share may lie under which as much is done as is allowed, at any
  /// speed or while the bodies part slowly.
  double likely_share() const noexcept {
    constexpr double kAim = 0.9;
    if (!(high.work > low.work)) return 0.5;
    const auto of_work = [&](double most) {
      return std::clamp((most - low.work) / (high.work - low.work), 0.0, 1.0);
    };
    const double fast = of_work(kAim * at_any_speed());
    const double slowly = of_work(kAim * (at_any_speed() + slow));
    if (high.exit <= exit_speed) return slowly;
    if (low.exit >= exit_speed) return fast;
    const double parting = (kAim * exit_speed - low.exit) / (high.exit - low.exit);
    return std::max(fast, std::min(parting, slowly));
  }
};

/// What the stages of a Runge-Kutta step do too much where a touch ends within it: the first has
/// the force of the begin and a sixth of the step, whatever is stored [J]. Of elastic forces that
/// hold `energy` and grow by `stiffness`, as a power of the depth, at the parting speed `parting`;
/// with damping a `share` of them acts.
inline double end_excess(double energy, double force, double stiffness, double share,
                         double parting, double step) noexcept {
  if (!(force > 0.0 && parting > 0.0)) return 0.0;
  constexpr double kLeast = 0.5, kMost = 0.9;  // of an edge-on face, and nearly a jump
  const double ratio = std::clamp(stiffness * energy / (force * force), kLeast, kMost);
  const double power = ratio / (1.0 - ratio);
  const double steps = (power + 1.0) * energy / (force * parting * step);  // to the end
  if (steps >= 1.0) return 0.0;
  const double middle = std::pow(std::max(0.0, 1.0 - 0.5 / steps), power);
  const double work = step * share * force * parting * (1.0 + 4.0 * middle) / 6.0;
  return std::max(0.0, work - energy);
}

/// The part of the explicit normal force of a pair that keeps the limit, when `force` acts for
/// `step` at the parting speed `parting` and `mobility` is the inverse mass.
inline double explicit_share(const WorkLimit& limit, double force, double parting, double mobility,
                             double step) noexcept {
  const double impulse = step * force;
  if (!(impulse > 0.0)) return 1.0;
  const double stored = limit.at_any_speed();
  // Work of a share s: a s^2 + b s.
  const double a = 0.5 * impulse * impulse * mobility, b = impulse * parting;
  const auto share_for = [&](double allowed) {
    if (a + b <= allowed) return 1.0;
    if (!(allowed > 0.0)) return b < 0.0 && a > 0.0 ? std::min(1.0, -b / a) : 0.0;
    return std::min(1.0, 2.0 * allowed / (b + std::sqrt(b * b + 4.0 * a * allowed)));
  };
  const double fast = share_for(stored);
  if (fast >= 1.0 || !(limit.slow > 0.0)) return fast;
  const double room = limit.exit_speed - parting;
  const double slow = mobility > 0.0 ? std::max(0.0, room) / (impulse * mobility) : 1.0;
  return std::max(fast, std::min({slow, share_for(stored + limit.slow), 1.0}));
}

}  // namespace volcontact
