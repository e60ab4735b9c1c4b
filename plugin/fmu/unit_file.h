// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace volcontact::fmu {

/// What a group of values of a unit is.
enum class Role {
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
};

/// Values in a row with one meaning. The value reference of the group is `first`; in FMI 2, which
/// has scalars only, that of value i is first + i.
struct Group {
  Role role;
  int index = 0;  ///< of the body, slot or model that it is of
  int first = 0;
  int count = 1;
  std::string name = {};  ///< of a parameter or of a state of a law
  bool is_tunable = false;
  bool is_input() const { return role <= Role::kVelocity; }
  bool is_state() const { return role == Role::kDissipated || role == Role::kState; }
  bool is_parameter() const { return role >= Role::kParameter; }
  bool is_integer() const {
    return role == Role::kSites || role == Role::kForgotten || role == Role::kExtrapolation;
  }
  bool is_boolean() const { return role == Role::kTouching || role == Role::kSiteActive; }
};

/// What resources/unit.txt says of a contact model unit.
struct UnitFile {
  struct Model {
    int body_a, body_b;
    std::string text;  ///< of the container
  };
  std::string token;          ///< the modelDescription.xml that it belongs to
  int slots = 0;              ///< sites of each model that have values and states of their own
  bool is_in_body = false;    ///< whether twists and wrenches are in the frame of the body
  std::vector<char> is_free;  ///< of each body, whether it has a pose and a twist among the inputs
  std::vector<Model> models;
  std::vector<Group> groups;
  std::vector<double> starts;  ///< of all values
};

/// Reads unit.txt and model_<i>.txt of a folder. Throws std::invalid_argument naming the file.
UnitFile read_unit(const std::string& folder);

}  // namespace volcontact::fmu
