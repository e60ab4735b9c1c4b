// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace volcontact {

/// What a value of a running scene is: docs/fmu.md, "A whole scene". Vectors are in the world.
enum class SceneValue : int {
  kCtrl,             ///< of an actuator
  kAppliedForce,     ///< on a body at its centre of mass [N], 3
  kAppliedTorque,    ///< on a body [N m], 3
  kMocapPosition,    ///< of a body [m], 3
  kMocapQuaternion,  ///< of a body, 4
  kSensor,
  kJointPosition,
  kJointVelocity,
  kBodyPosition,         ///< of the frame [m], 3
  kBodyQuaternion,       ///< 4
  kBodyAngularVelocity,  ///< [rad/s], 3
  kBodyVelocity,         ///< of the frame's origin [m/s], 3
  kPairVolume,           ///< of a pair of add_pair, index 1 and on; index 0 is all contact [m^3]
  kPairDepth,            ///< [m]
  kPairSites,
  kPairTouching,
  kPairForce,          ///< on the first side [N], 3
  kPairNormalForce,    ///< [N]
  kPairElasticEnergy,  ///< [J]
  kContactPower,       ///< dissipated, by channel [W], 4
  kContactDissipated,  ///< since the start, by channel [J], 4
  kTimestep,           ///< [s]
  kGravity,            ///< [m/s^2], 3
  kMaterial,           ///< numeric of the model
};

/// A key of the program, as volcontact_key of the adaptor.
struct SceneRunKey {
  const char* name;
  const double* numbers;
  int count;
};

/// A library that runs scenes for a program that knows no MuJoCo: the adaptor, which is loaded
/// while the program runs. A scene is a handle. Functions that return an int return a negative
/// number where they fail, and write a text into `message`, which has kMessageSize characters.
struct SceneRunFunctions {
  static constexpr int kVersion = 1;
  static constexpr int kMessageSize = 2048;
  /// kDiscarded: the value cannot be used, and nothing changed. Anything else is fatal: reset.
  enum Code : int { kFine = 0, kDiscarded = -1, kFailed = -2 };

  int version;
  void* (*create)(const char* path, const SceneRunKey* keys, int count, char* message);
  void (*destroy)(void* scene);
  /// A pair of sides, each a list of geoms; returns its index.
  int (*add_pair)(void* scene, const int* a, int a_count, const int* b, int b_count, char* message);
  /// How many numbers a value has; negative where the model has no such value.
  int (*count)(const void* scene, SceneValue value, int index);
  int (*reset)(void* scene, char* message);
  void (*set_time)(void* scene, double time);
  double (*time)(const void* scene);
  int (*set)(void* scene, SceneValue value, int index, const double* numbers, char* message);
  int (*get)(void* scene, SceneValue value, int index, double* numbers, char* message);
  /// One time step. `touching`: how many contact sites there were.
  int (*step)(void* scene, int* touching, char* message);
  /// Warnings of MuJoCo on this thread since the last call, one a line; the length of the text.
  int (*warnings)(char* message);
  int (*state_size)(const void* scene);
  void (*get_state)(const void* scene, double* numbers);
  int (*set_state)(void* scene, const double* numbers, char* message);
};

/// The name of the function of the library that returns them, null for another version.
inline constexpr const char* kSceneRunSymbol = "volcontact_scene_run_functions";
using SceneRunEntry = const SceneRunFunctions* (*)(int version);

}  // namespace volcontact
