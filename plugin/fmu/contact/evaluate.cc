// SPDX-License-Identifier: Apache-2.0
// Evaluation, continuous states, events and steps of a unit.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "fmu/contact/contact_unit.h"
#include "volcontact/base/check.h"
#include "volcontact/model/site_memory.h"

namespace volcontact::fmu {
namespace {

constexpr int kRowsHead = 2;  // of the array of rows: their count and size

// A state beyond what friction can hold comes back with this rate; the force knows its bound at
// once [1/s].
constexpr double kReturnRate = 1e4;

SiteHead head_of(const std::vector<double>& rows, int row, int i) {
  SiteHead head;
  std::memcpy(static_cast<void*>(&head), &rows[static_cast<std::size_t>(kRowsHead + i * row)],
              sizeof head);
  return head;
}

double distance(const SiteHead& a, const SiteHead& b) {
  if (a.pair != b.pair) return HUGE_VAL;
  return (Vec3::from(a.point_A) - Vec3::from(b.point_A)).norm();
}

}  // namespace

void ContactUnit::update() {
  if (!out_of_date_ || memory_.is_stepping != 0.0) return;
  read_bodies();
  for (std::size_t m = 0; m < models_.size(); ++m) evaluate(m);
  publish();
  if (double* indicators = values(Role::kIndicator, 0)) find_indicators(indicators);
  out_of_date_ = false;
}

void ContactUnit::put_states(std::size_t m, std::vector<double>& rows) const {
  const Model& model = models_[m];
  for (int k = 0; k < file_.slots && model.last > model.first; ++k) {
    const double* x = values(Role::kState, static_cast<int>(m) * file_.slots + k);
    if (!x || k >= rows[0]) continue;
    std::copy_n(x, model.last - model.first,
                &rows[static_cast<std::size_t>(kRowsHead + k * model.row + model.first)]);
  }
}

void ContactUnit::evaluate(std::size_t m) {
  Model& model = models_[m];
  const vc_motion motion = motion_of(m, 0.0);
  if (model.row == 0) {
    check(vc_evaluate(model.model.get(), model.workspace.get(), &motion, nullptr, nullptr, 0, 0.0,
                      &model.result));
    return;
  }
  model.rows = memory_.rows[m];
  put_states(m, model.rows);
  check(vc_evaluate_rates(model.model.get(), model.workspace.get(), &motion, model.rows.data(),
                          model.next.data(), model.rates.data(),
                          static_cast<int>(model.rows.size()), &model.result));
  match(model);
}

// Which committed row each row of now goes on from: the nearest, each once.
void ContactUnit::match(Model& model) const {
  const int now = static_cast<int>(model.next[0]), before = static_cast<int>(model.rows[0]);
  model.slot_of.assign(static_cast<std::size_t>(now), -1);
  std::vector<char> taken(static_cast<std::size_t>(before), 0);
  for (int i = 0; i < now; ++i) {
    double least = HUGE_VAL;
    int nearest = -1;
    for (int k = 0; k < before; ++k) {
      const double gap =
          distance(head_of(model.next, model.row, i), head_of(model.rows, model.row, k));
      if (!taken[static_cast<std::size_t>(k)] && gap < least) least = gap, nearest = k;
    }
    model.slot_of[static_cast<std::size_t>(i)] = nearest;
    if (nearest >= 0) taken[static_cast<std::size_t>(nearest)] = 1;
  }
}

void ContactUnit::publish_rates(std::size_t m) {
  Model& model = models_[m];
  const int count = model.last - model.first;
  for (int k = 0; k < file_.slots && count > 0; ++k) {
    double* rates = values(Role::kStateRate, static_cast<int>(m) * file_.slots + k);
    if (!rates) return;
    std::fill_n(rates, count, 0.0);
    for (std::size_t i = 0; i < model.slot_of.size(); ++i) {
      if (model.slot_of[i] != k || model.next[0] != model.rows[0]) continue;
      const int mine = kRowsHead + static_cast<int>(i) * model.row + model.first;
      const int committed = kRowsHead + k * model.row + model.first;
      for (int j = 0; j < count; ++j) {
        const double beyond = model.rows[static_cast<std::size_t>(committed + j)] -
                              model.next[static_cast<std::size_t>(mine + j)];
        rates[j] = model.rates[static_cast<std::size_t>(mine + j)] - kReturnRate * beyond;
      }
      book_bristles(model, mine, committed, rates);
    }
  }
}

// Energy of the bristles as the solver has them, so that what it integrates closes the account to
// its own tolerance: the container counts what friction holds of them.
void ContactUnit::book_bristles(Model& model, int mine, int committed, const double* rates) {
  constexpr int kSpring = 4;                                  // the deflection, then the twist
  const bool follows_patch = model.bristle_stiffness == 0.0;  // its stiffness is the next state
  if (model.last - model.first < (follows_patch ? kSpring + 1 : kSpring)) return;
  const auto held_stiffness = static_cast<std::size_t>(mine + kSpring);
  const double stiffness = follows_patch ? model.next[held_stiffness] : model.bristle_stiffness;
  const double stiffening = follows_patch ? model.rates[held_stiffness] : 0.0;
  double* power = values(Role::kPower, 0);
  double* elastic = values(Role::kElasticEnergy, 0);
  for (int j = 0; j < kSpring; ++j) {
    const double solved = model.rows[static_cast<std::size_t>(committed + j)];
    const double held = model.next[static_cast<std::size_t>(mine + j)];
    const double stored =
        held * model.rates[static_cast<std::size_t>(mine + j)] - solved * rates[j];
    const double more = solved * solved - held * held;
    if (power) power[j < 3 ? 2 : 3] += stiffness * stored - 0.5 * stiffening * more;
    if (elastic) *elastic += 0.5 * stiffness * more;
  }
}

void ContactUnit::get_states(double* x) const {
  for (std::size_t i = 0; i < states_.size(); ++i) {
    x[i] = memory_.values[static_cast<std::size_t>(states_[i])];
  }
}

void ContactUnit::set_states(const double* x) {
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if (x[i] - x[i] != 0.0) {
      throw Discarded("continuous state " + std::to_string(i) + " is no finite number");
    }
  }
  for (std::size_t i = 0; i < states_.size(); ++i) {
    memory_.values[static_cast<std::size_t>(states_[i])] = x[i];
  }
  out_of_date_ = true;
}

void ContactUnit::get_rates(double* rates) {
  update();
  for (std::size_t i = 0; i < rates_.size(); ++i) {
    rates[i] = memory_.values[static_cast<std::size_t>(rates_[i])];
  }
}

void ContactUnit::get_nominals(double* nominals) const {
  constexpr double kEnergy = 1e-3, kDeflection = 1e-6;  // [J], [m]
  constexpr double kDwell = 1.0, kStiffness = 1e5;      // [-], [N/m]
  std::size_t i = 0;
  for (const Group& group : file_.groups) {
    if (!group.is_state()) continue;
    const double nominal = group.role == Role::kDissipated ? kEnergy
                           : group.name == "dwell"         ? kDwell
                           : group.name == "stiffness"     ? kStiffness
                                                           : kDeflection;
    for (int k = 0; k < group.count; ++k) nominals[i++] = nominal;
  }
}

void ContactUnit::get_indicators(double* indicators) {
  update();
  find_indicators(indicators);
}

void ContactUnit::find_indicators(double* indicators) const {
  for (std::size_t m = 0; m < models_.size(); ++m) {
    const Model& model = models_[m];
    const int count = std::min(model.result.sites, file_.slots);
    indicators[2 * m] = model.result.sites > 0 ? 1.0 : -1.0;
    double fastest = -1.0;
    for (int i = 0; i < count && model.slip_speed > 0.0; ++i) {
      const double* slip = model.sites[static_cast<std::size_t>(i)].slip;
      fastest = std::max(fastest, Vec3(slip[0], slip[1], slip[2]).norm() / model.slip_speed - 1.0);
    }
    indicators[2 * m + 1] = fastest;
  }
}

bool ContactUnit::complete_step() {
  update();
  bool others = false;
  for (std::size_t m = 0; m < models_.size(); ++m) {
    Model& model = models_[m];
    if (model.row == 0) continue;
    bool same = model.next[0] == model.rows[0];
    for (std::size_t i = 0; i < model.slot_of.size(); ++i) {
      same = same && model.slot_of[i] == static_cast<int>(i);
    }
    others = others || !same;
    if (!same) continue;
    memory_.rows[m] = model.next;
    put_states(m, memory_.rows[m]);
  }
  out_of_date_ = true;
  return others;
}

bool ContactUnit::update_states() {
  update();
  bool changed = false;
  for (std::size_t m = 0; m < models_.size(); ++m) {
    Model& model = models_[m];
    if (model.row == 0) continue;
    memory_.rows[m] = model.next;
    for (int k = 0; k < file_.slots; ++k) {
      double* x = values(Role::kState, static_cast<int>(m) * file_.slots + k);
      for (int j = 0; x && j < model.last - model.first; ++j) {
        const auto at = static_cast<std::size_t>(kRowsHead + k * model.row + model.first + j);
        const double value = k < model.next[0] ? model.next[at] : 0.0;
        changed = changed || x[j] != value;
        x[j] = value;
      }
    }
  }
  memory_.touching_before = touching_;
  out_of_date_ = true;
  return changed;
}

void ContactUnit::begin() {
  update();
  update_states();
  update();
  memory_.is_stepping = 1.0;
}

int ContactUnit::step_parts(double step) const {
  constexpr double kMost = 1e4;
  const double* longest = values(Role::kInternalStep, 0);
  if (!longest || *longest == 0.0 || !(step > *longest)) return 1;
  const double parts = std::ceil(step / *longest * (1.0 - 1e-12));
  if (!(parts <= kMost)) {
    throw Discarded("internal_step = " + std::to_string(*longest) +
                    " [s] would cut the communication step of " + std::to_string(step) +
                    " [s] into more than 10000 parts; take a longer one");
  }
  return static_cast<int>(parts);
}

void ContactUnit::step(double start, double from, double to) {
  double before[4] = {}, *power = values(Role::kPower, 0);
  if (power) std::copy_n(power, 4, before);
  std::vector<Body> bodies(bodies_.size());
  for (std::size_t i = 0; i < bodies.size(); ++i)
    bodies[i] = body_at(static_cast<int>(i), to - inputs_at_[i]);
  bodies_.swap(bodies);
  for (std::size_t m = 0; m < models_.size(); ++m) {
    Model& model = models_[m];
    const vc_motion motion = motion_of(m, 0.0);
    const bool keeps = model.row > 0;
    check(vc_evaluate(model.model.get(), model.workspace.get(), &motion,
                      keeps ? memory_.rows[m].data() : nullptr, keeps ? model.next.data() : nullptr,
                      static_cast<int>(memory_.rows[m].size()), to - from, &model.result));
  }
  for (std::size_t m = 0; m < models_.size(); ++m) {
    if (models_[m].row > 0) memory_.rows[m] = models_[m].next;
  }
  publish();
  if (double* lost = values(Role::kDissipated, 0); lost && power) {
    for (int i = 0; i < 4; ++i) lost[i] += 0.5 * (to - from) * (before[i] + power[i]);
  }
  memory_.time = start + to;
  part_at_ = to;
}

void ContactUnit::end_step(double step) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Body now = body_at(static_cast<int>(i), 0.0);
    std::copy_n(now.V.angular.data(), 3, &memory_.twists_before[6 * i]);
    std::copy_n(now.V.linear.data(), 3, &memory_.twists_before[6 * i + 3]);
  }
  std::fill(inputs_at_.begin(), inputs_at_.end(), 0.0);
  part_at_ = 0.0;
  memory_.step_before = step;
  memory_.touching_before = touching_;
}

}  // namespace volcontact::fmu
