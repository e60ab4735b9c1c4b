// SPDX-License-Identifier: Apache-2.0
#include "fmu/unit_file.h"

#include <fstream>
#include <sstream>

#include "volcontact/base/text_reader.h"

namespace volcontact::fmu {
namespace {

constexpr const char* kRoles[] = {"position",
                                  "quaternion",
                                  "rotation",
                                  "angular_velocity",
                                  "velocity",
                                  "force",
                                  "torque",
                                  "volume",
                                  "depth",
                                  "sites",
                                  "forgotten",
                                  "touching",
                                  "elastic_energy",
                                  "power",
                                  "dissipated",
                                  "state",
                                  "state_rate",
                                  "site_active",
                                  "site_centroid",
                                  "site_normal",
                                  "site_force",
                                  "site_torque",
                                  "site_second_moment",
                                  "site_area",
                                  "indicator",
                                  "time",
                                  "parameter",
                                  "extrapolation",
                                  "internal_step"};
static_assert(std::size(kRoles) == static_cast<std::size_t>(Role::kInternalStep) + 1);
constexpr int kMost = 1000000;

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  require(file.good(), "cannot read " + path + "; the FMU must be unpacked with its resources");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

Role role_from(std::string_view word, const TextReader& reader) {
  for (int i = 0; i < static_cast<int>(std::size(kRoles)); ++i) {
    if (word == kRoles[i]) return static_cast<Role>(i);
  }
  require(false, reader.where() + "'" + std::string(word) + "' is no role of a value");
  return Role::kPosition;
}

// "group ROLE INDEX FIRST COUNT TUNABLE NAME START..."
void read_group(TextReader& reader, UnitFile& unit) {
  Group group{role_from(reader.word("a role"), reader)};
  group.index = reader.count("an index", kMost);
  group.first = reader.count("a value reference", kMost);
  group.count = reader.count("a count of values", kMost);
  group.is_tunable = reader.count("0 or 1", 1) == 1;
  group.name = std::string(reader.word("a name"));
  require(group.first == static_cast<int>(unit.starts.size()),
          reader.where() + "the values are not in a row");
  for (int i = 0; i < group.count; ++i) unit.starts.push_back(reader.number("a start value"));
  unit.groups.push_back(group);
}

// How many values a role has; 0: any number.
int count_of(Role role, int models) {
  switch (role) {
    case Role::kState:
    case Role::kStateRate:
    case Role::kParameter:
      return 0;
    case Role::kQuaternion:
    case Role::kPower:
    case Role::kDissipated:
      return 4;
    case Role::kRotation:
      return 9;
    case Role::kSiteSecondMoment:
      return 6;
    case Role::kIndicator:
      return 2 * models;
    case Role::kPosition:
    case Role::kAngularVelocity:
    case Role::kVelocity:
    case Role::kForce:
    case Role::kTorque:
    case Role::kSiteCentroid:
    case Role::kSiteNormal:
    case Role::kSiteForce:
    case Role::kSiteTorque:
      return 3;
    default:
      return 1;
  }
}

void check(const UnitFile& unit) {
  const int bodies = static_cast<int>(unit.is_free.size());
  const int models = static_cast<int>(unit.models.size());
  for (const UnitFile::Model& model : unit.models) {
    require(model.body_a < bodies && model.body_b < bodies, "a model is of a body that is none");
  }
  for (const Group& group : unit.groups) {
    const bool of_body = group.role <= Role::kTorque;
    const bool of_slot = group.role == Role::kState || group.role == Role::kStateRate ||
                         (group.role >= Role::kSiteActive && group.role <= Role::kSiteArea);
    const int most = of_body                          ? bodies
                     : of_slot                        ? models * unit.slots
                     : group.role == Role::kParameter ? models
                                                      : 1;
    require(group.index < most, "a group of values is of something that is not there");
    const int count = count_of(group.role, models);
    require(count == 0 || group.count == count,
            "a group of values has another count than its role");
  }
}

}  // namespace

UnitFile read_unit(const std::string& folder) {
  const std::string path = folder + "/unit.txt", text = content(path);
  UnitFile unit;
  try {
    TextReader reader(text);
    require(reader.word("volcontact_unit") == "volcontact_unit" && reader.count("1", kMost) == 1,
            "this is no unit of version 1; export the FMU again with this volcontact");
    while (!reader.at_end()) {
      const std::string word(reader.word("a key"));
      if (word == "token") {
        unit.token = std::string(reader.word("the token"));
      } else if (word == "slots") {
        unit.slots = reader.count("the count of slots", 1000);
      } else if (word == "frame") {
        unit.is_in_body = reader.word("world or body") == "body";
      } else if (word == "body") {
        unit.is_free.push_back(reader.word("fixed or free") == "free");
      } else if (word == "model") {
        const int a = reader.count("body A", kMost), b = reader.count("body B", kMost);
        const std::string name = "/model_" + std::to_string(unit.models.size()) + ".txt";
        unit.models.push_back({a, b, content(folder + name)});
      } else {
        require(word == "group", reader.where() + "'" + word + "' is no key");
        read_group(reader, unit);
      }
    }
    check(unit);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(path + ": " + error.what());
  }
  return unit;
}

}  // namespace volcontact::fmu
