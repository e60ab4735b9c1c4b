// SPDX-License-Identifier: Apache-2.0
#include "adaptor/run/scene_run.h"

#include <algorithm>
#include <mutex>
#include <stdexcept>

#include "adaptor/mujoco/mujoco_compat.h"
#include "adaptor/passive_callback.h"
#include "adaptor/run/mujoco_messages.h"
#include "adaptor/run/run_state.h"
#include "volcontact/base/check.h"
#include "volcontact/base/sizes.h"

namespace volcontact::adaptor {
namespace {

template <typename Function>
void in_mujoco(Function&& function) {
  if (!MujocoMessages::run(function)) {
    throw std::runtime_error(std::string("MuJoCo: ") + MujocoMessages::error());
  }
}

// Attaching and detaching are not at once: who leaves last takes the callback away.
std::mutex attaching;

constexpr int kBad[] = {mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC};

int bad_states(const mjData* d) {
  int count = 0;
  for (const int warning : kBad) count += d->warning[warning].number;
  return count;
}

}  // namespace

SceneRun::SceneRun(const char* path, const SceneRunKey* keys, int count) {
  MujocoMessages::install();
  try {
    in_mujoco([&] { model_ = mj_loadModel(path, nullptr); });
    require(model_ != nullptr,
            std::string("MuJoCo ") + mj_versionString() + " cannot read " + path);
    std::vector<volcontact_key> given;
    for (int i = 0; i < count; ++i) given.push_back({keys[i].name, keys[i].numbers, keys[i].count});
    char message[SceneRunFunctions::kMessageSize];
    const std::lock_guard lock(attaching);
    const int code = volcontact_attach_with(model_, given.data(), count, message,
                                            static_cast<int>(sizeof message));
    require(code == 0, message);
    is_attached_ = true;
    in_mujoco([&] {
      data_ = mj_makeData(model_);
      seen_ = mj_makeData(model_);
    });
    require(data_ && seen_, "there is no memory for the data of the scene");
    pairs_.resize(1);  // all contact
    reset();
  } catch (...) {
    free();
    throw;
  }
}

SceneRun::~SceneRun() { free(); }

void SceneRun::free() noexcept {
  MujocoMessages::run([this] {
    if (seen_) mj_deleteData(seen_);
    if (data_) mj_deleteData(data_);
  });
  if (is_attached_) {
    const std::lock_guard lock(attaching);
    volcontact_detach(model_, nullptr, 0);
  }
  if (model_) mj_deleteModel(model_);
}

int SceneRun::add_pair(std::vector<int> a, std::vector<int> b) {
  Sides sides;
  for (const auto& [geoms, side] : {std::pair{&a, &sides.a}, std::pair{&b, &sides.b}}) {
    side->assign(size(model_->ngeom), 0);
    for (const int geom : *geoms) {
      require(geom >= 0 && geom < model_->ngeom, "the scene has no geom " + std::to_string(geom));
      (*side)[size(geom)] = 1;
    }
  }
  pairs_.push_back(std::move(sides));
  return static_cast<int>(pairs_.size()) - 1;
}

void SceneRun::reset() {
  in_mujoco([this] {
    const int key = mj_name2id(model_, mjOBJ_KEY, "start");
    if (key >= 0) {
      mj_resetDataKeyframe(model_, data_, key);
    } else {
      mj_resetData(model_, data_);
    }
  });
  is_seen_ = false;
}

void SceneRun::set_time(double time) {
  data_->time = time;
  is_seen_ = false;
}

int SceneRun::step() {
  const int before = bad_states(data_);
  EvaluationScratch& scratch = thread_scratch();
  scratch.cull.near.clear();  // nothing acts where the passive forces are off
  const double time = data_->time;
  in_mujoco([this] { mj_step(model_, data_); });
  is_seen_ = false;
  if (bad_states(data_) != before) {
    throw std::runtime_error("the scene diverged in the step from " + std::to_string(time) +
                             " [s]: take a smaller timestep");
  }
  std::size_t sites = 0;
  for (std::size_t k = 0; k < scratch.cull.near.size(); ++k) {
    sites += scratch.reports[k].sites.size();
  }
  return static_cast<int>(sites);
}

// MuJoCo's evaluation changes what its solver starts from, so it is done on a copy.
void SceneRun::see() {
  if (is_seen_) return;
  in_mujoco([this] {
    mj_copyData(seen_, model_, data_);
    mj_forward(model_, seen_);
  });
  volcontact_update_touch(model_, seen_);
  int there = volcontact_sites(model_, seen_, sites_.data(), static_cast<int>(sites_.size()));
  if (there > static_cast<int>(sites_.size())) {
    sites_.resize(size(there));
    there = volcontact_sites(model_, seen_, sites_.data(), there);
  }
  sites_.resize(size(std::max(0, there)));
  volcontact_get_energy(model_, seen_, &energy_);
  is_seen_ = true;
}

int SceneRun::state_size() const { return run_state_size(model_); }
void SceneRun::get_state(double* numbers) const { get_run_state(model_, data_, numbers); }
void SceneRun::set_state(const double* numbers) {
  in_mujoco([&] { set_run_state(model_, data_, numbers); });
  is_seen_ = false;
}

}  // namespace volcontact::adaptor
