// SPDX-License-Identifier: Apache-2.0
// The values of a running scene, by what they are and the number of the thing in the model.
#include <algorithm>

#include "adaptor/run/scene_run.h"
#include "volcontact/base/check.h"
#include "volcontact/base/sizes.h"

namespace volcontact::adaptor {
namespace {

int position_count(const mjModel* m, int joint) {
  const int type = m->jnt_type[joint];
  return type == mjJNT_FREE ? 7 : type == mjJNT_BALL ? 4 : 1;
}
int velocity_count(const mjModel* m, int joint) {
  const int type = m->jnt_type[joint];
  return type == mjJNT_FREE ? 6 : type == mjJNT_BALL ? 3 : 1;
}

// How many things of the kind the model has.
int things(const mjModel* m, SceneValue value, int pairs) {
  switch (value) {
    case SceneValue::kCtrl:
      return m->nu;
    case SceneValue::kMocapPosition:
    case SceneValue::kMocapQuaternion:
    case SceneValue::kAppliedForce:
    case SceneValue::kAppliedTorque:
    case SceneValue::kBodyPosition:
    case SceneValue::kBodyQuaternion:
    case SceneValue::kBodyAngularVelocity:
    case SceneValue::kBodyVelocity:
      return m->nbody;
    case SceneValue::kSensor:
      return m->nsensor;
    case SceneValue::kJointPosition:
    case SceneValue::kJointVelocity:
      return m->njnt;
    case SceneValue::kMaterial:
      return m->nnumeric;
    case SceneValue::kContactPower:
    case SceneValue::kContactDissipated:
    case SceneValue::kTimestep:
    case SceneValue::kGravity:
      return 1;
    default:
      return pairs;
  }
}

}  // namespace

int SceneRun::count(SceneValue value, int index) const {
  if (index < 0 || index >= things(model_, value, static_cast<int>(pairs_.size()))) return -1;
  switch (value) {
    case SceneValue::kMocapPosition:
      return model_->body_mocapid[index] < 0 ? -1 : 3;
    case SceneValue::kMocapQuaternion:
      return model_->body_mocapid[index] < 0 ? -1 : 4;
    case SceneValue::kSensor:
      return model_->sensor_dim[index];
    case SceneValue::kJointPosition:
      return position_count(model_, index);
    case SceneValue::kJointVelocity:
      return velocity_count(model_, index);
    case SceneValue::kMaterial:
      return model_->numeric_size[index];
    case SceneValue::kBodyQuaternion:
    case SceneValue::kContactPower:
    case SceneValue::kContactDissipated:
      return 4;
    case SceneValue::kAppliedForce:
    case SceneValue::kAppliedTorque:
    case SceneValue::kBodyPosition:
    case SceneValue::kBodyAngularVelocity:
    case SceneValue::kBodyVelocity:
    case SceneValue::kPairForce:
    case SceneValue::kGravity:
      return 3;
    default:
      return 1;
  }
}

void SceneRun::require_index(SceneValue value, int index) const {
  require(count(value, index) > 0, "the scene has no value " +
                                       std::to_string(static_cast<int>(value)) + " of " +
                                       std::to_string(index));
}

void SceneRun::set(SceneValue value, int index, const double* numbers) {
  require_index(value, index);
  const int mocap = value == SceneValue::kMocapPosition || value == SceneValue::kMocapQuaternion
                        ? model_->body_mocapid[index]
                        : 0;
  switch (value) {
    case SceneValue::kCtrl:
      data_->ctrl[index] = *numbers;
      break;
    case SceneValue::kAppliedForce:
      std::copy_n(numbers, 3, data_->xfrc_applied + 6 * index);
      break;
    case SceneValue::kAppliedTorque:
      std::copy_n(numbers, 3, data_->xfrc_applied + 6 * index + 3);
      break;
    case SceneValue::kMocapPosition:
      std::copy_n(numbers, 3, data_->mocap_pos + 3 * mocap);
      break;
    case SceneValue::kMocapQuaternion: {
      double norm = 0.0;
      for (int i = 0; i < 4; ++i) norm += numbers[i] * numbers[i];
      if (!(norm > 1e-12)) throw RefusedValue("the quaternion has the norm 0; start with 1 0 0 0");
      std::copy_n(numbers, 4, data_->mocap_quat + 4 * mocap);
      break;
    }
    case SceneValue::kTimestep:
      if (!(*numbers > 0.0)) {
        throw RefusedValue("timestep = " + std::to_string(*numbers) + " [s] must be above 0");
      }
      model_->opt.timestep = *numbers;
      break;
    case SceneValue::kGravity:
      std::copy_n(numbers, 3, model_->opt.gravity);
      break;
    case SceneValue::kMaterial:
      set_material(index, numbers);
      break;
    default:
      require(false, "the value is an output");
  }
  is_seen_ = false;
}

void SceneRun::set_material(int numeric, const double* numbers) {
  const int count = model_->numeric_size[numeric];
  double* const to = model_->numeric_data + model_->numeric_adr[numeric];
  const std::vector<double> before(to, to + count);
  std::copy_n(numbers, count, to);
  char message[SceneRunFunctions::kMessageSize];
  if (volcontact_live_error(model_, message, static_cast<int>(sizeof message)) > 0) {
    std::copy(before.begin(), before.end(), to);
    throw RefusedValue(message);
  }
}

void SceneRun::get(SceneValue value, int index, double* numbers) {
  require_index(value, index);
  const mjModel* m = model_;
  switch (value) {
    case SceneValue::kCtrl:
      *numbers = data_->ctrl[index];
      return;
    case SceneValue::kJointPosition:
      std::copy_n(data_->qpos + m->jnt_qposadr[index], position_count(m, index), numbers);
      return;
    case SceneValue::kJointVelocity:
      std::copy_n(data_->qvel + m->jnt_dofadr[index], velocity_count(m, index), numbers);
      return;
    case SceneValue::kTimestep:
      *numbers = m->opt.timestep;
      return;
    case SceneValue::kGravity:
      std::copy_n(m->opt.gravity, 3, numbers);
      return;
    case SceneValue::kMaterial:
      std::copy_n(m->numeric_data + m->numeric_adr[index], m->numeric_size[index], numbers);
      return;
    default:
      break;
  }
  see();
  double velocity[6] = {};
  switch (value) {
    case SceneValue::kSensor:
      std::copy_n(seen_->sensordata + m->sensor_adr[index], m->sensor_dim[index], numbers);
      return;
    case SceneValue::kBodyPosition:
      std::copy_n(seen_->xpos + 3 * index, 3, numbers);
      return;
    case SceneValue::kBodyQuaternion:
      std::copy_n(seen_->xquat + 4 * index, 4, numbers);
      return;
    case SceneValue::kBodyAngularVelocity:
    case SceneValue::kBodyVelocity:
      mj_objectVelocity(m, seen_, mjOBJ_XBODY, index, velocity, 0);
      std::copy_n(velocity + (value == SceneValue::kBodyVelocity ? 3 : 0), 3, numbers);
      return;
    default:
      get_contact(value, index, numbers);
  }
}

int SceneRun::side_of(const Sides& pair, const volcontact_site& site) const {
  if (pair.a.empty()) return 1;
  const auto a = size(site.geom_a), b = size(site.geom_b);
  return pair.a[a] && pair.b[b] ? 1 : pair.a[b] && pair.b[a] ? -1 : 0;
}

void SceneRun::get_contact(SceneValue value, int index, double* numbers) const {
  if (value == SceneValue::kContactPower || value == SceneValue::kContactDissipated) {
    std::copy_n(value == SceneValue::kContactPower ? energy_.power : energy_.dissipated, 4,
                numbers);
    return;
  }
  std::fill_n(numbers, value == SceneValue::kPairForce ? 3 : 1, 0.0);
  if (index == 0 && value == SceneValue::kPairElasticEnergy) {
    *numbers = energy_.elastic;
    return;
  }
  for (const volcontact_site& site : sites_) {
    const int side = side_of(pairs_[size(index)], site);
    if (side == 0) continue;
    switch (value) {
      case SceneValue::kPairVolume:
        *numbers += site.volume;
        break;
      case SceneValue::kPairDepth:
        *numbers = std::max(*numbers, site.depth);
        break;
      case SceneValue::kPairSites:
        *numbers += 1.0;
        break;
      case SceneValue::kPairTouching:
        *numbers = 1.0;
        break;
      case SceneValue::kPairNormalForce:
        *numbers += site.normal_force;
        break;
      case SceneValue::kPairElasticEnergy:
        *numbers += site.elastic_energy;
        break;
      case SceneValue::kPairForce:
        for (int i = 0; i < 3; ++i) numbers[i] += side * site.force[i];
        break;
      default:
        break;
    }
  }
}

}  // namespace volcontact::adaptor
