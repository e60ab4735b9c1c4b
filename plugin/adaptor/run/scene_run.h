// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "adaptor/volcontact_mujoco.h"
#include "volcontact/base/scene_run.h"

namespace volcontact::adaptor {

/// The value cannot be used, and nothing has changed.
struct RefusedValue : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// A scene with its model, its data and volumetric contact, run for a program that knows no MuJoCo.
/// Values that follow from the state (sensors, poses, contact) are worked out on a copy of the
/// data, when they are asked for: the run has the bits of one by mj_step alone.
///
/// Functions throw std::invalid_argument, and std::runtime_error where MuJoCo found an error.
class SceneRun {
 public:
  /// `path`: of a binary model with room for contact in userdata.
  SceneRun(const char* path, const SceneRunKey* keys, int count);
  SceneRun(const SceneRun&) = delete;
  SceneRun& operator=(const SceneRun&) = delete;
  ~SceneRun();

  int add_pair(std::vector<int> a, std::vector<int> b);
  int count(SceneValue value, int index) const;
  /// To the keyframe `start` or, where there is none, to that of the model.
  void reset();
  double time() const { return data_->time; }
  void set_time(double time);
  void set(SceneValue value, int index, const double* numbers);
  void get(SceneValue value, int index, double* numbers);
  /// One time step; returns the number of contact sites that it began with.
  int step();
  int state_size() const;
  void get_state(double* numbers) const;
  void set_state(const double* numbers);

 private:
  struct Sides {
    std::vector<char> a, b;  ///< of each geom
  };

  void free() noexcept;
  void require_index(SceneValue value, int index) const;
  void set_material(int numeric, const double* numbers);
  void see();
  /// 1 where the site is of the pair, -1 where its sides are exchanged, else 0.
  int side_of(const Sides& pair, const volcontact_site& site) const;
  void get_contact(SceneValue value, int index, double* numbers) const;

  mjModel* model_ = nullptr;
  mjData* data_ = nullptr;
  mjData* seen_ = nullptr;  ///< the state evaluated
  bool is_attached_ = false;
  bool is_seen_ = false;
  std::vector<Sides> pairs_;
  std::vector<volcontact_site> sites_;
  volcontact_energy energy_{};
};

}  // namespace volcontact::adaptor
