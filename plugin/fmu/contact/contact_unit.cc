// SPDX-License-Identifier: Apache-2.0
#include "fmu/contact/contact_unit.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "volcontact/base/check.h"

namespace volcontact::fmu {
namespace {

// What the solver integrates of what the laws keep; the rest is set once, at a touch.
constexpr const char* kIntegrated[] = {"deflection", "twist", "dwell", "stiffness"};

// Finds the numbers of a row that are continuous states; the last law's come last.
void find_states(const vc_model* model, int& first, int& last) {
  std::string table(static_cast<std::size_t>(vc_model_states(model, nullptr, 0)) + 1, '\0');
  vc_model_states(model, table.data(), static_cast<int>(table.size()));
  for (std::size_t at = 0; table[at] != '\0'; at = table.find('\n', at) + 1) {
    const std::string line = table.substr(at, table.find('\n', at) - at);
    const std::string name = line.substr(0, line.find('\t'));
    const std::size_t number = line.find('\t', line.find('\t') + 1) + 1;
    const int start = std::stoi(line.substr(number));
    const int count = std::stoi(line.substr(line.find('\t', number) + 1));
    if (std::find(std::begin(kIntegrated), std::end(kIntegrated), name) == std::end(kIntegrated)) {
      continue;
    }
    if (first == last) first = start;
    last = start + count;
  }
}

constexpr std::ptrdiff_t kMemoryHead = 4;  // of Memory, packed: then the values

}  // namespace

void check(int code) {
  if (code >= 0) return;
  if (code == VC_ERROR_ARGUMENT || code == VC_ERROR_RESULT) throw Discarded(vc_error());
  throw std::runtime_error(vc_error());
}

std::vector<double> Memory::packed() const {
  std::vector<double> out{time, step_before, touching_before, is_stepping};
  for (const auto* list : {&values, &twists_before})
    out.insert(out.end(), list->begin(), list->end());
  for (const auto& list : rows) out.insert(out.end(), list.begin(), list.end());
  return out;
}

void Memory::unpack(const double* numbers, std::size_t count) {
  require(count == packed().size(), "the state is of another unit");
  time = numbers[0], step_before = numbers[1], touching_before = numbers[2];
  is_stepping = numbers[3];
  const double* from = numbers + kMemoryHead;
  const auto take = [&](std::vector<double>& list) {
    std::copy_n(from, list.size(), list.begin());
    from += list.size();
  };
  take(values);
  take(twists_before);
  for (auto& list : rows) take(list);
}

ContactUnit::ContactUnit(const std::string& resources) : file_(read_unit(resources)) {
  index_groups();
  places_.resize(kRoleCount);
  for (const Group& group : file_.groups) {
    auto& places = places_[static_cast<std::size_t>(group.role)];
    const auto index = static_cast<std::size_t>(group.index);
    if (places.size() <= index) places.resize(index + 1, -1);
    if (places[index] < 0) places[index] = group.first;  // the states of a slot lie in a row
    for (int i = 0; i < group.count; ++i) {
      if (group.is_state()) states_.push_back(group.first + i);
    }
  }
  models_.resize(file_.models.size());
  bodies_.resize(file_.is_free.size());
  reset();
  check_layout();
  for (const auto& [state, rate] :
       {std::pair{Role::kDissipated, Role::kPower}, std::pair{Role::kState, Role::kStateRate}}) {
    for (const Group& group : file_.groups) {
      if (group.role != state) continue;
      const double* to = values(rate, group.index);
      require(to != nullptr, "unit.txt: a state has no derivative");
      const auto shift = to - values(state, group.index);
      for (int i = 0; i < group.count; ++i) {
        rates_.push_back(group.first + static_cast<int>(shift) + i);
      }
    }
  }
}

// The values of unit.txt are those that the models and bodies have.
void ContactUnit::check_layout() const {
  for (std::size_t i = 0; i < file_.is_free.size(); ++i) {
    if (!file_.is_free[i]) continue;
    const int body = static_cast<int>(i);
    require(values(Role::kPosition, body) && values(Role::kAngularVelocity, body) &&
                values(Role::kVelocity, body) &&
                (values(Role::kQuaternion, body) || values(Role::kRotation, body)),
            "unit.txt: body " + std::to_string(i) + " has no pose or no twist");
  }
  std::vector<int> counts[2];
  for (auto& list : counts) list.assign(models_.size() * static_cast<std::size_t>(file_.slots), 0);
  for (const Group& group : file_.groups) {
    if (group.role != Role::kState && group.role != Role::kStateRate) continue;
    counts[group.role == Role::kStateRate][static_cast<std::size_t>(group.index)] += group.count;
  }
  for (std::size_t slot = 0; slot < counts[0].size(); ++slot) {
    const Model& model = models_[slot / static_cast<std::size_t>(file_.slots)];
    const int count = counts[0][slot];
    require(count == counts[1][slot] && (count == 0 || count == model.last - model.first),
            "unit.txt: the states of a slot are not those of its laws");
  }
}

void ContactUnit::reset() {
  memory_ = {};
  memory_.values = applied_ = file_.starts;
  memory_.twists_before.assign(6 * file_.is_free.size(), 0.0);
  memory_.rows.resize(models_.size());
  for (std::size_t m = 0; m < models_.size(); ++m) build_model(m);
  apply_parameters();
  inputs_at_.assign(file_.is_free.size(), 0.0);
  part_at_ = 0.0;
  touching_ = false;
  out_of_date_ = true;
}

void ContactUnit::build_model(std::size_t m) {
  Model& model = models_[m];
  vc_model* made = nullptr;
  if (vc_model_create_text(file_.models[m].text.c_str(), &made) != 0) {
    throw std::invalid_argument("model_" + std::to_string(m) + ".txt: " + vc_error());
  }
  model.model.reset(made);
  vc_workspace* workspace = nullptr;
  check(vc_workspace_create(&workspace));
  model.workspace.reset(workspace);
  const auto size = static_cast<std::size_t>(vc_model_state_size(made, file_.slots));
  model.row = file_.slots > 0 ? (static_cast<int>(size) - 2) / file_.slots : 0;
  model.first = model.last = 0;
  if (size > 0) find_states(made, model.first, model.last);
  memory_.rows[m].assign(size, 0.0);
  model.next.assign(size, 0.0);
  model.rates.assign(size, 0.0);
  model.sites.resize(static_cast<std::size_t>(file_.slots));
  read_numbers(model);
  for (const Group& group : file_.groups) {
    if (group.role != Role::kParameter || group.index != static_cast<int>(m)) continue;
    double* const present = &applied_[static_cast<std::size_t>(group.first)];
    std::fill_n(present, group.count, NAN);  // what is not there is set, and told
    vc_model_get(made, group.name.c_str(), present, group.count);
  }
}

void ContactUnit::read_numbers(Model& model) {
  model.slip_speed = model.bristle_stiffness = 0.0;
  for (const char* name : {"slip_speed", "stribeck_speed"}) {
    if (vc_model_get(model.model.get(), name, &model.slip_speed, 1) == 1) break;
  }
  vc_model_get(model.model.get(), "bristle_stiffness", &model.bristle_stiffness, 1);
}

// Some exclude each other, such as damping and restitution: what is refused is tried again once
// others are there.
void ContactUnit::apply_parameters() {
  std::vector<const Group*> left;
  for (const Group& group : file_.groups) {
    if (group.role == Role::kParameter) left.push_back(&group);
  }
  while (!left.empty()) {
    std::vector<const Group*> refused;
    std::string reason;
    for (const Group* group : left) {
      try {
        apply_parameter(*group);
      } catch (const Discarded& error) {
        refused.push_back(group);
        reason = error.what();
      }
    }
    if (refused.size() == left.size()) throw Discarded(reason);
    left.swap(refused);
  }
}

void ContactUnit::apply_parameter(const Group& group) {
  Model& model = models_[static_cast<std::size_t>(group.index)];
  const auto first = static_cast<std::size_t>(group.first);
  const double* const wanted = &memory_.values[first];
  double* const present = &applied_[first];
  if (std::equal(wanted, wanted + group.count, present)) return;  // else the laws are made anew
  check(vc_model_set(model.model.get(), group.name.c_str(), wanted, group.count));
  std::copy_n(wanted, group.count, present);
  const int size = vc_model_state_size(model.model.get(), file_.slots);
  auto& rows = memory_.rows[static_cast<std::size_t>(group.index)];
  if (size != static_cast<int>(rows.size())) {  // of fixed parameters only: before the start
    rows.assign(static_cast<std::size_t>(size), 0.0);
    model.next = model.rates = rows;
    model.row = file_.slots > 0 ? (size - 2) / file_.slots : 0;
    model.first = model.last = 0;
    if (size > 0) find_states(model.model.get(), model.first, model.last);
  }
  read_numbers(model);
}

double* ContactUnit::values(Role role, int index) {
  const auto& places = places_[static_cast<std::size_t>(role)];
  const auto i = static_cast<std::size_t>(index);
  return i < places.size() && places[i] >= 0 ? &memory_.values[static_cast<std::size_t>(places[i])]
                                             : nullptr;
}
const double* ContactUnit::values(Role role, int index) const {
  return const_cast<ContactUnit*>(this)->values(role, index);
}

void ContactUnit::set_time(double time) {
  memory_.time = time;
  out_of_date_ = true;
}

double ContactUnit::get(unsigned reference) {
  const Group& group = *group_around(reference);
  if (group.role == Role::kTime) return memory_.time;
  if (!group.is_input() && !group.is_parameter() && !group.is_state()) update();
  return memory_.values[reference];
}

void ContactUnit::set(const Group& group, int offset, const double* numbers, int count) {
  require_finite(group, offset, numbers, count);
  const auto first = memory_.values.begin() + group.first + offset;
  const std::vector<double> before(first, first + count);
  std::copy_n(numbers, count, first);
  try {
    if (group.role == Role::kParameter) apply_parameter(group);
    const double value = *numbers;
    if (group.role == Role::kExtrapolation && (value < 0.0 || value > 2.0)) {
      throw Discarded("extrapolation = " + std::to_string(value) + " must be 0, 1 or 2");
    }
    if (group.role == Role::kInternalStep && value < 0.0) {
      throw Discarded("internal_step = " + std::to_string(value) + " [s] must be >= 0");
    }
  } catch (const Discarded&) {
    std::copy(before.begin(), before.end(), first);
    throw;
  }
  if (group.is_input()) inputs_at_[static_cast<std::size_t>(group.index)] = part_at_;
  out_of_date_ = true;
}

void ContactUnit::restore(const std::vector<double>& memory) {
  const Memory before = memory_;
  const std::size_t head = kMemoryHead + memory_.values.size();
  require(memory.size() >= head, "the state is of another unit");
  try {
    // The parameters say how much the laws keep.
    std::copy_n(memory.begin() + kMemoryHead, memory_.values.size(), memory_.values.begin());
    apply_parameters();
    memory_.unpack(memory.data(), memory.size());
  } catch (...) {
    memory_ = before;
    apply_parameters();
    memory_ = before;
    throw;
  }
  for (std::size_t m = 0; m < models_.size(); ++m) {
    models_[m].next.assign(memory_.rows[m].size(), 0.0);
    models_[m].rates = models_[m].next;
  }
  inputs_at_.assign(file_.is_free.size(), 0.0);
  part_at_ = 0.0;
  touching_ = memory_.touching_before != 0.0;
  out_of_date_ = true;
}

}  // namespace volcontact::fmu
