// SPDX-License-Identifier: Apache-2.0
#include "fmu/unit_file.h"

#include <fstream>
#include <sstream>

namespace volcontact::fmu {
namespace {

constexpr int kMost = 1000000;

Role role_from(std::string_view word, const TextReader& reader) {
  for (int i = 0; i < kRoleCount; ++i) {
    if (word == kRoles[i].word) return static_cast<Role>(i);
  }
  require(false, reader.where() + "'" + std::string(word) + "' is no role of a value");
  return Role::kPosition;
}

// "group ROLE INDEX FIRST COUNT TUNABLE NAME START..."
void read_group(TextReader& reader, ValueFile& unit) {
  Group group{role_from(reader.word("a role"), reader)};
  group.index = reader.count("an index", kMost);
  group.first = reader.count("a value reference", kMost);
  group.count = reader.count("a count of values", kMost);
  group.is_tunable = reader.count("0 or 1", 1) == 1;
  group.name = std::string(reader.word("a name"));
  require(group.first == static_cast<int>(unit.starts.size()),
          reader.where() + "the values are not in a row");
  require(info(group.role).count == 0 || group.count == info(group.role).count,
          reader.where() + "the group has another count than its role");
  for (int i = 0; i < group.count; ++i) unit.starts.push_back(reader.number("a start value"));
  unit.groups.push_back(group);
}

void check(const UnitFile& unit) {
  const int bodies = static_cast<int>(unit.is_free.size());
  const int models = static_cast<int>(unit.models.size());
  for (const UnitFile::Model& model : unit.models) {
    require(model.body_a < bodies && model.body_b < bodies, "a model is of a body that is none");
  }
  for (const Group& group : unit.groups) {
    require(group.role <= Role::kInternalStep, "a group of values is not of a contact model");
    const bool of_body = group.role <= Role::kTorque;
    const bool of_slot = group.role == Role::kState || group.role == Role::kStateRate ||
                         (group.role >= Role::kSiteActive && group.role <= Role::kSiteArea);
    const int most = of_body                          ? bodies
                     : of_slot                        ? models * unit.slots
                     : group.role == Role::kParameter ? models
                                                      : 1;
    require(group.index < most, "a group of values is of something that is not there");
    require(group.role != Role::kIndicator || group.count == 2 * models,
            "there are two event indicators a model");
  }
}

}  // namespace

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  require(file.good(), "cannot read " + path + "; the FMU must be unpacked with its resources");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

bool read_value_line(TextReader& reader, std::string_view word, ValueFile& file) {
  if (word == "token") {
    file.token = std::string(reader.word("the token"));
  } else if (word == "scalars") {
    file.is_scalar = reader.count("0 or 1", 1) == 1;
  } else if (word == "group") {
    read_group(reader, file);
  } else {
    return false;
  }
  return true;
}

UnitFile read_unit(const std::string& folder) {
  const std::string path = folder + "/unit.txt", text = content_of(path);
  UnitFile unit;
  try {
    TextReader reader(text);
    require(reader.word("volcontact_unit") == "volcontact_unit" && reader.count("1", kMost) == 1,
            "this is no unit of version 1; export the FMU again with this volcontact");
    while (!reader.at_end()) {
      const std::string word(reader.word("a key"));
      if (read_value_line(reader, word, unit)) continue;
      if (word == "slots") {
        unit.slots = reader.count("the count of slots", 1000);
      } else if (word == "frame") {
        unit.is_in_body = reader.word("world or body") == "body";
      } else if (word == "body") {
        unit.is_free.push_back(reader.word("fixed or free") == "free");
      } else if (word == "model") {
        const int a = reader.count("body A", kMost), b = reader.count("body B", kMost);
        const std::string name = "/model_" + std::to_string(unit.models.size()) + ".txt";
        unit.models.push_back({a, b, content_of(folder + name)});
      } else {
        require(false, reader.where() + "'" + word + "' is no key");
      }
    }
    check(unit);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(path + ": " + error.what());
  }
  return unit;
}

}  // namespace volcontact::fmu
