// SPDX-License-Identifier: Apache-2.0
#include "fmu/scene/scene_unit.h"

#include <algorithm>
#include <cmath>

#include "fmu/scene/scene_file.h"
#include "fmu/scene/scene_library.h"

namespace volcontact::fmu {
namespace {

SceneValue value_of(Role role) {
  static_assert(static_cast<int>(Role::kMaterial) - static_cast<int>(Role::kCtrl) ==
                static_cast<int>(SceneValue::kMaterial));
  return static_cast<SceneValue>(static_cast<int>(role) - static_cast<int>(Role::kCtrl));
}

class SceneUnit final : public Unit {
 public:
  explicit SceneUnit(const std::string& resources)
      : file_(read_scene(resources)),
        run_(load_scene_library(file_.adaptor, file_.mujoco)),
        scene_(nullptr, run_.destroy),
        values_(file_.starts) {
    index_groups();
    std::vector<SceneRunKey> keys;
    for (const auto& key : file_.keys) {
      keys.push_back({key.name.c_str(), key.numbers.data(), static_cast<int>(key.numbers.size())});
    }
    message_[0] = '\0';
    scene_.reset(run_.create((resources + "/scene.mjb").c_str(), keys.data(),
                             static_cast<int>(keys.size()), message_));
    require(scene_ != nullptr, message_);
    for (const auto& pair : file_.pairs) {
      check(run_.add_pair(scene_.get(), pair.a.data(), static_cast<int>(pair.a.size()),
                          pair.b.data(), static_cast<int>(pair.b.size()), message_));
    }
    for (const Group& group : file_.groups) {
      if (group.role == Role::kTime) continue;
      require(run_.count(scene_.get(), value_of(group.role), group.index) == group.count,
              "scene.txt: the scene has no such values as group " + std::to_string(group.first));
    }
    start();
  }

  const ValueFile& file() const override { return file_; }
  double time() const override { return run_.time(scene_.get()); }
  void set_time(double time) override {
    run_.set_time(scene_.get(), time);
    out_of_date_ = true;
  }
  void reset() override { start(); }

  double get(unsigned reference) override {
    const Group& group = *group_around(reference);
    if (group.role == Role::kTime) return time();
    if (group.is_input() || group.is_parameter()) return values_[reference];
    if (out_of_date_) {
      apply_pending();
      std::fill(is_known_.begin(), is_known_.end(), 0);
      out_of_date_ = false;
    }
    const auto first = static_cast<std::size_t>(group.first);
    if (!is_known_[first]) {
      check(run_.get(scene_.get(), value_of(group.role), group.index, &values_[first], message_));
      is_known_[first] = 1;
    }
    return values_[reference];
  }
  double last(unsigned reference) const override {
    return group_around(reference)->role == Role::kTime ? time() : values_[reference];
  }

  void set(const Group& group, int offset, const double* numbers, int count) override {
    require_finite(group, offset, numbers, count);
    const auto first = values_.begin() + group.first;
    const std::vector<double> before(first, first + group.count);
    std::copy_n(numbers, count, first + offset);
    out_of_date_ = true;
    if (group
            .is_input()) {  // FMI 2 sets a quaternion number by number: only the whole can be wrong
      pending_[index_of(group)] = 1;
      return;
    }
    try {
      apply(group);
    } catch (const Discarded&) {
      std::copy(before.begin(), before.end(), first);
      throw;
    }
  }

  std::vector<double> memory() const override {
    std::vector<double> out{touching_ ? 1.0 : 0.0};
    out.insert(out.end(), pending_.begin(), pending_.end());
    for_settable([&](const Group& group) {
      const auto first = values_.begin() + group.first;
      out.insert(out.end(), first, first + group.count);
    });
    const std::size_t head = out.size();
    out.resize(head + static_cast<std::size_t>(run_.state_size(scene_.get())));
    run_.get_state(scene_.get(), &out[head]);
    return out;
  }

  void restore(const std::vector<double>& memory) override {
    require(memory.size() == this->memory().size(), "the state is of another unit");
    const double* from = memory.data();
    touching_ = *from++ != 0.0;
    for (char& flag : pending_) flag = *from++ != 0.0;
    for_settable([&](const Group& group) {
      std::copy_n(from, group.count, values_.begin() + group.first);
      from += group.count;
      if (group.is_parameter()) apply(group);
    });
    check(run_.set_state(scene_.get(), from, message_));
    out_of_date_ = true;
  }

  void begin() override {}

  int step_parts(double step) const override {
    const double each = timestep();
    const double parts = std::round(step / each);
    constexpr double kRounding = 1e-6, kMost = 1e9;
    if (!(parts >= 1.0 && parts <= kMost && std::abs(step - parts * each) <= kRounding * each)) {
      throw Discarded("the communication step of " + std::to_string(step) +
                      " [s] is no multiple of the timestep of " + std::to_string(each) + " [s]");
    }
    return static_cast<int>(parts);
  }

  void step(double /*start*/, double /*from*/, double /*to*/) override {
    apply_pending();
    int sites = 0;
    check(run_.step(scene_.get(), &sites, message_));
    touching_ = sites > 0;
    out_of_date_ = true;
  }
  void end_step(double /*step*/) override {}
  bool touching() const override { return touching_; }

  std::string take_warnings() override {
    return run_.warnings(message_) > 0 ? std::string(message_) : std::string();
  }

 private:
  void check(int code) {
    if (code >= 0) return;
    if (code == SceneRunFunctions::kDiscarded) throw Discarded(message_);
    throw std::runtime_error(message_);
  }

  double timestep() const {
    for (const Group& group : file_.groups) {
      if (group.role == Role::kTimestep) return values_[static_cast<std::size_t>(group.first)];
    }
    return file_.timestep;
  }

  void start() {
    values_ = file_.starts;
    is_known_.assign(values_.size(), 0);
    pending_.assign(file_.groups.size(), 0);
    check(run_.reset(scene_.get(), message_));
    for_settable([this](const Group& group) {
      if (group.is_input()) {
        pending_[index_of(group)] = 1;
      } else {
        apply(group);
      }
    });
    touching_ = false;
    out_of_date_ = true;
  }

  template <typename Visit>
  void for_settable(Visit&& visit) const {
    for (const Group& group : file_.groups) {
      if (group.is_input() || group.is_parameter()) visit(group);
    }
  }

  std::size_t index_of(const Group& group) const {
    return static_cast<std::size_t>(&group - file_.groups.data());
  }

  void apply_pending() {
    for (const Group& group : file_.groups) {
      if (pending_[index_of(group)]) apply(group);
    }
  }

  void apply(const Group& group) {
    check(run_.set(scene_.get(), value_of(group.role), group.index,
                   &values_[static_cast<std::size_t>(group.first)], message_));
    pending_[index_of(group)] = 0;
    out_of_date_ = true;
  }

  SceneFile file_;
  const SceneRunFunctions& run_;
  std::unique_ptr<void, void (*)(void*)> scene_;
  std::vector<double> values_;
  std::vector<char>
      pending_;  ///< of each group, whether it was set since the scene has heard of it
  std::vector<char> is_known_;  ///< of each first value of an output, whether it is of now
  char message_[SceneRunFunctions::kMessageSize];
  bool touching_ = false;
  bool out_of_date_ = true;
};

}  // namespace

std::unique_ptr<Unit> make_scene_unit(const std::string& resources) {
  return std::make_unique<SceneUnit>(resources);
}

}  // namespace volcontact::fmu
