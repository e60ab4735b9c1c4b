// SPDX-License-Identifier: Apache-2.0
// The functions by which a unit of plugin/fmu runs a scene. No exception leaves this file.
#include <cstdio>
#include <stdexcept>

#include "adaptor/mujoco/mujoco_compat.h"
#include "adaptor/run/mujoco_messages.h"
#include "adaptor/run/scene_run.h"

namespace volcontact::adaptor {
namespace {

constexpr std::size_t kRoom = SceneRunFunctions::kMessageSize;

template <typename Function>
int guarded(char* message, Function&& function) noexcept {
  try {
    return function();
  } catch (const RefusedValue& error) {
    std::snprintf(message, kRoom, "%s", error.what());
    return SceneRunFunctions::kDiscarded;
  } catch (const std::exception& error) {
    std::snprintf(message, kRoom, "%s", error.what());
    return SceneRunFunctions::kFailed;
  }
}

SceneRun& run_of(void* scene) { return *static_cast<SceneRun*>(scene); }
const SceneRun& run_of(const void* scene) { return *static_cast<const SceneRun*>(scene); }

void* create(const char* path, const SceneRunKey* keys, int count, char* message) {
  SceneRun* run = nullptr;
  guarded(message, [&] {
    if (mj_version() != mjVERSION_HEADER) {
      throw std::runtime_error("the library is of MuJoCo " + version_text(mjVERSION_HEADER) +
                               " and MuJoCo " + version_text(mj_version()) + " is there");
    }
    run = new SceneRun(path, keys, count);
    return 0;
  });
  return run;
}

constexpr SceneRunFunctions kFunctions = {
    .version = SceneRunFunctions::kVersion,
    .create = &create,
    .destroy = [](void* scene) { delete static_cast<SceneRun*>(scene); },
    .add_pair =
        [](void* scene, const int* a, int a_count, const int* b, int b_count, char* message) {
          return guarded(
              message, [&] { return run_of(scene).add_pair({a, a + a_count}, {b, b + b_count}); });
        },
    .count = [](const void* scene, SceneValue value,
                int index) { return run_of(scene).count(value, index); },
    .reset =
        [](void* scene, char* message) {
          return guarded(message, [&] {
            run_of(scene).reset();
            return 0;
          });
        },
    .set_time = [](void* scene, double time) { run_of(scene).set_time(time); },
    .time = [](const void* scene) { return run_of(scene).time(); },
    .set =
        [](void* scene, SceneValue value, int index, const double* numbers, char* message) {
          return guarded(message, [&] {
            run_of(scene).set(value, index, numbers);
            return 0;
          });
        },
    .get =
        [](void* scene, SceneValue value, int index, double* numbers, char* message) {
          return guarded(message, [&] {
            run_of(scene).get(value, index, numbers);
            return 0;
          });
        },
    .step =
        [](void* scene, int* touching, char* message) {
          return guarded(message, [&] {
            *touching = run_of(scene).step();
            return 0;
          });
        },
    .warnings =
        [](char* message) {
          return std::snprintf(message, kRoom, "%s", MujocoMessages::take_warnings().c_str());
        },
    .state_size = [](const void* scene) { return run_of(scene).state_size(); },
    .get_state = [](const void* scene, double* numbers) { run_of(scene).get_state(numbers); },
    .set_state =
        [](void* scene, const double* numbers, char* message) {
          return guarded(message, [&] {
            run_of(scene).set_state(numbers);
            return 0;
          });
        },
};

}  // namespace
}  // namespace volcontact::adaptor

extern "C" VOLCONTACT_API const volcontact::SceneRunFunctions* volcontact_scene_run_functions(
    int version) {
  return version == volcontact::SceneRunFunctions::kVersion ? &volcontact::adaptor::kFunctions
                                                            : nullptr;
}
