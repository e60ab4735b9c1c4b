// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace volcontact::fmu {

/// What a group of values of a unit is.
enum class Role {
  // Of a contact model unit.
  kPosition,         ///< of a body [m]
  kQuaternion,       ///< w x y z, of a body
  kRotation,         ///< row by row, of a body
  kAngularVelocity,  ///< of a body [rad/s]
  kVelocity,         ///< of a body's origin [m/s]
  kForce,            ///< on a body [N]
  kTorque,           ///< on a body about its origin [N m]
  kVolume,           ///< [m^3]
  kDepth,            ///< [m]
  kSites,
  kForgotten,  ///< sites for which there was no slot
  kTouching,
  kElasticEnergy,  ///< [J]
  kPower,          ///< dissipated, by channel [W]
  kDissipated,     ///< energy, by channel [J]: continuous states
  kState,          ///< of the laws of a slot: continuous states
  kStateRate,      ///< derivative of kState
  kSiteActive,     ///< of a slot
  kSiteCentroid,   ///< [m]
  kSiteNormal,
  kSiteForce,         ///< on its model's body A [N]
  kSiteTorque,        ///< about the centroid [N m]
  kSiteSecondMoment,  ///< of the volume about the centroid [m^5], xx yy zz xy xz yz
  kSiteArea,          ///< |dV/dx| [m^2]
  kIndicator,         ///< event indicators: of each model touch, then slip
  kTime,              ///< [s]
  kParameter,         ///< of a model
  kExtrapolation,     ///< order in which bodies go on within a communication step
  kInternalStep,      ///< longest step within a communication step [s], 0: none
  // Of a scene unit, in the order of SceneValue.
  kCtrl,                 ///< of an actuator
  kAppliedForce,         ///< on a body at its centre of mass [N]
  kAppliedTorque,        ///< on a body [N m]
  kMocapPosition,        ///< of a mocap body [m]
  kMocapQuaternion,      ///< of a mocap body
  kSensor,               ///< all numbers of a sensor
  kJointPosition,        ///< its numbers of qpos
  kJointVelocity,        ///< its numbers of qvel
  kBodyPosition,         ///< of a body's frame [m]
  kBodyQuaternion,       ///< of a body's frame
  kBodyAngularVelocity,  ///< in the world [rad/s]
  kBodyVelocity,         ///< of the frame's origin, in the world [m/s]
  kPairVolume,           ///< of a pair of bodies or, index 0, of all [m^3]
  kPairDepth,            ///< [m]
  kPairSites,
  kPairTouching,
  kPairForce,          ///< on the first of the two [N]
  kPairNormalForce,    ///< sum over the sites [N]
  kPairElasticEnergy,  ///< [J]
  kContactPower,       ///< dissipated by all contact, by channel [W]
  kContactDissipated,  ///< since the start, by channel [J]
  kTimestep,           ///< [s]
  kGravity,            ///< [m/s^2]
  kMaterial,           ///< a number of a material's key
};

enum class Causality { kInput, kOutput, kState, kParameter };
enum class ValueType { kReal, kInteger, kBoolean };

/// What is known of a role. `count`: how many numbers, 0: any.
struct RoleInfo {
  std::string_view word;
  Causality causality = Causality::kOutput;
  int count = 1;
  ValueType type = ValueType::kReal;
};

inline constexpr RoleInfo kRoles[] = {
    {"position", Causality::kInput, 3},
    {"quaternion", Causality::kInput, 4},
    {"rotation", Causality::kInput, 9},
    {"angular_velocity", Causality::kInput, 3},
    {"velocity", Causality::kInput, 3},
    {"force", Causality::kOutput, 3},
    {"torque", Causality::kOutput, 3},
    {"volume"},
    {"depth"},
    {"sites", Causality::kOutput, 1, ValueType::kInteger},
    {"forgotten", Causality::kOutput, 1, ValueType::kInteger},
    {"touching", Causality::kOutput, 1, ValueType::kBoolean},
    {"elastic_energy"},
    {"power", Causality::kOutput, 4},
    {"dissipated", Causality::kState, 4},
    {"state", Causality::kState, 0},
    {"state_rate", Causality::kOutput, 0},
    {"site_active", Causality::kOutput, 1, ValueType::kBoolean},
    {"site_centroid", Causality::kOutput, 3},
    {"site_normal", Causality::kOutput, 3},
    {"site_force", Causality::kOutput, 3},
    {"site_torque", Causality::kOutput, 3},
    {"site_second_moment", Causality::kOutput, 6},
    {"site_area"},
    {"indicator", Causality::kOutput, 0},
    {"time"},
    {"parameter", Causality::kParameter, 0},
    {"extrapolation", Causality::kParameter, 1, ValueType::kInteger},
    {"internal_step", Causality::kParameter},
    {"ctrl", Causality::kInput},
    {"applied_force", Causality::kInput, 3},
    {"applied_torque", Causality::kInput, 3},
    {"mocap_position", Causality::kInput, 3},
    {"mocap_quaternion", Causality::kInput, 4},
    {"sensor", Causality::kOutput, 0},
    {"joint_position", Causality::kOutput, 0},
    {"joint_velocity", Causality::kOutput, 0},
    {"body_position", Causality::kOutput, 3},
    {"body_quaternion", Causality::kOutput, 4},
    {"body_angular_velocity", Causality::kOutput, 3},
    {"body_velocity", Causality::kOutput, 3},
    {"pair_volume"},
    {"pair_depth"},
    {"pair_sites", Causality::kOutput, 1, ValueType::kInteger},
    {"pair_touching", Causality::kOutput, 1, ValueType::kBoolean},
    {"pair_force", Causality::kOutput, 3},
    {"pair_normal_force"},
    {"pair_elastic_energy"},
    {"contact_power", Causality::kOutput, 4},
    {"contact_dissipated", Causality::kOutput, 4},
    {"timestep", Causality::kParameter},
    {"gravity", Causality::kParameter, 3},
    {"material", Causality::kParameter, 0},
};
inline constexpr int kRoleCount = static_cast<int>(std::size(kRoles));
static_assert(kRoleCount == static_cast<int>(Role::kMaterial) + 1);

inline constexpr const RoleInfo& info(Role role) { return kRoles[static_cast<int>(role)]; }

}  // namespace volcontact::fmu
