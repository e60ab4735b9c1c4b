// SPDX-License-Identifier: Apache-2.0
#include "adaptor/watched_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "adaptor/mujoco/mjgeoms.h"
#include "adaptor/out_of_memory.h"
#include "adaptor/passive_callback.h"
#include "adaptor/readings/last_evaluation.h"
#include "adaptor/scene_registry.h"

namespace volcontact::adaptor {
namespace {

constexpr double kTimeRounding = 1e-12;  // [s]

double distance_to(const double* position, const double* place) {
  const double from[] = {position[0] - place[0], position[1] - place[1], position[2] - place[2]};
  return mju_norm3(from);
}

// The angle of the rotation between two orientations [degree].
double angle_to(const double* orientation, const double* place) {
  double back[4], rest[4];
  mju_negQuat(back, place);
  mju_mulQuat(rest, back, orientation);
  return 2.0 * std::atan2(mju_norm3(rest + 1), std::abs(rest[0])) * 180.0 / std::numbers::pi;
}

double speed_of(const mjModel* m, const mjData* d, int body, bool turning) {
  double velocity[6];  // rotation first
  mj_objectVelocity(m, d, mjOBJ_XBODY, body, velocity, 0);
  return mju_norm3(turning ? velocity : velocity + 3);
}

bool has_diverged(const mjData* d) {
  return d->warning[mjWARN_BADQPOS].number > 0 || d->warning[mjWARN_BADQVEL].number > 0 ||
         d->warning[mjWARN_BADQACC].number > 0;
}

double length_of(const mjModel* m, const mjData* d, const volcontact_number (&axes)[3],
                 const volcontact_watch& watch) {
  double numbers[3];
  for (int i = 0; i < 3; ++i) numbers[i] = read_number(m, d, axes[i], &watch);
  return mju_norm3(numbers);
}

bool holds(const mjModel* m, const mjData* d, const volcontact_range* ranges, int count,
           const volcontact_watch& watch) {
  return std::all_of(ranges, ranges + count, [&](const volcontact_range& range) {
    const double number = read_number(m, d, range.number, &watch);
    return number >= range.low && number <= range.high;
  });
}

// Sums what acts at the sites of one step.
class Feeling {
 public:
  Feeling(const mjModel* m, volcontact_watch& watch) : geoms_(m->ngeom), watch_(watch) {
    watch.sites = watch.force = watch.torque = watch.site_force = 0.0;
    watch.geom_a = watch.geom_b = -1;
    std::fill_n(watch.place_forces, watch.place_count, 0.0);
  }

  void add(int geom_a, int geom_b, double force, double torque) {
    watch_.sites += 1.0;
    watch_.force += force;
    watch_.torque += torque;
    if (force >= watch_.site_force) {
      watch_.site_force = force;
      watch_.geom_a = geom_a;
      watch_.geom_b = geom_b;
    }
    for (int place = 0; place < watch_.place_count; ++place) {
      const unsigned char* members = watch_.place_members + std::ptrdiff_t{place} * geoms_;
      if (is_of(members, geom_a) || is_of(members, geom_b)) watch_.place_forces[place] += force;
    }
  }

 private:
  // A flex is no geom.
  static bool is_of(const unsigned char* members, int geom) { return geom >= 0 && members[geom]; }

  int geoms_;
  volcontact_watch& watch_;
};

void feel_sites(const SceneContact& contact, const EvaluationScratch& scratch, Feeling& feeling) {
  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    for (std::size_t i = 0; i < scratch.reports[k].sites.size(); ++i) {
      const SiteReport& site = scratch.reports[k].sites[i];
      const GeomPair& geoms = scratch.geoms_of_site(contact, k, i);
      feeling.add(geoms.a, geoms.b, site.force_on_A.norm(), site.torque_on_A.norm());
    }
  }
}

// Inside its margin MuJoCo lists a contact that does not push yet: that is no contact.
void feel_native(const mjModel* m, const mjData* d, Feeling& feeling) {
  for (int i = 0; i < d->ncon; ++i) {
    const mjContact& contact = d->contact[i];
    double wrench[6] = {};
    mj_contactForce(m, d, i, wrench);
    const double force = mju_norm3(wrench), torque = mju_norm3(wrench + 3);
    if (contact.dist < 0.0 || force > 0.0) {
      feeling.add(contact.geom1, contact.geom2, force, torque);
    }
  }
}

void keep_peaks(const mjModel* m, const mjData* d, double began, volcontact_watch& watch) {
  if (watch.sites > 0.0 && std::isnan(watch.first_touch)) watch.first_touch = began;
  watch.most_sites = std::max(watch.most_sites, watch.sites);
  watch.peak_site_force = std::max(watch.peak_site_force, watch.site_force);
  for (int i = 0; i < watch.place_count; ++i) {
    watch.place_peaks[i] = std::max(watch.place_peaks[i], watch.place_forces[i]);
  }
  if (watch.has_force) watch.force = length_of(m, d, watch.force_axes, watch);
  if (watch.has_torque) watch.torque = length_of(m, d, watch.torque_axes, watch);
  watch.peak_force = std::max(watch.peak_force, watch.force);
  watch.peak_torque = std::max(watch.peak_torque, watch.torque);
  for (int i = 0; i < watch.peak_count; ++i) {
    watch.peaks[i] = std::max(watch.peaks[i], read_number(m, d, watch.peak_numbers[i], &watch));
  }
}

// How long something has held by now.
bool has_held(bool holds_now, double now, double long_enough, double& since) {
  since = holds_now ? std::min(since, now) : std::numeric_limits<double>::infinity();
  return holds_now && now - since >= long_enough - kTimeRounding;
}

int outcome_of(const mjModel* m, const mjData* d, volcontact_watch& watch) {
  if (watch.force > watch.force_limit) return VOLCONTACT_FORCE_LIMIT;
  if (watch.torque > watch.torque_limit) return VOLCONTACT_TORQUE_LIMIT;
  watch.is_good = holds(m, d, watch.success, watch.success_count, watch) ? 1 : 0;
  const bool has_a_say = watch.success_count > 0 && !watch.judged_outside;
  if (has_a_say && has_held(watch.is_good != 0, d->time, watch.hold, watch.good_since)) {
    return VOLCONTACT_SUCCESS;
  }
  const bool is_jammed =
      watch.jammed_count > 0 && holds(m, d, watch.jammed, watch.jammed_count, watch);
  return has_held(is_jammed, d->time, watch.jam_time, watch.jammed_since) ? VOLCONTACT_JAMMED
                                                                          : VOLCONTACT_GOES_ON;
}

}  // namespace

double read_number(const mjModel* m, const mjData* d, const volcontact_number& number,
                   const volcontact_watch* watch) noexcept {
  const int i = number.index;
  const double* place = number.place;
  switch (number.kind) {
    case VOLCONTACT_TIME:
      return d->time;
    case VOLCONTACT_QPOS:
      return d->qpos[i];
    case VOLCONTACT_QVEL:
      return d->qvel[i];
    case VOLCONTACT_ACT:
      return d->act[i];
    case VOLCONTACT_CTRL:
      return d->ctrl[i];
    case VOLCONTACT_SENSOR:
      return d->sensordata[i];
    case VOLCONTACT_POSITION:
      return d->xpos[i];
    case VOLCONTACT_DISTANCE:
      return distance_to(d->xpos + 3 * i, place);
    case VOLCONTACT_ANGLE:
      return angle_to(d->xquat + 4 * i, place);
    case VOLCONTACT_SPEED:
      return speed_of(m, d, i, false);
    case VOLCONTACT_SPIN:
      return speed_of(m, d, i, true);
    case VOLCONTACT_SITES:
      if (watch) return watch->sites;
      break;
    case VOLCONTACT_SITE_FORCE:
      if (watch) return watch->site_force;
      break;
    default:
      break;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

int step_watched(const mjModel* m, mjData* d, int most, volcontact_watch& watch) {
  const SceneContact* contact = contact_of(m);
  EvaluationScratch& scratch = thread_scratch();
  int steps = 0;
  while (steps < most && watch.outcome == VOLCONTACT_GOES_ON) {
    const double began = d->time;
    scratch.cull.near.clear();  // nothing acts where the passive forces are off
    step_or_throw(m, d);
    ++steps;
    if (has_diverged(d)) {
      watch.outcome = VOLCONTACT_DIVERGED;
      break;
    }
    // The last stage of Runge-Kutta does not have the forces that were solved at the first.
    if (contact && m->opt.integrator == mjINT_RK4) revisit(*contact, m, d, scratch);
    Feeling feeling(m, watch);
    if (contact) feel_sites(*contact, scratch, feeling);
    feel_native(m, d, feeling);
    keep_peaks(m, d, began, watch);
    watch.outcome = outcome_of(m, d, watch);
  }
  return steps;
}

}  // namespace volcontact::adaptor
