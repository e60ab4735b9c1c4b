// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "fmu/roles.h"
#include "volcontact/base/text_reader.h"

namespace volcontact::fmu {

/// Values in a row with one meaning. The value reference of the group is `first`; in FMI 2, which
/// has scalars only, that of value i is first + i.
struct Group {
  Role role;
  int index = 0;  ///< of the body, slot or model that it is of
  int first = 0;
  int count = 1;
  std::string name = {};  ///< of a parameter or of a state of a law
  bool is_tunable = false;
  bool is_input() const { return info(role).causality == Causality::kInput; }
  bool is_state() const { return info(role).causality == Causality::kState; }
  bool is_parameter() const { return info(role).causality == Causality::kParameter; }
  ValueType type() const { return info(role).type; }
};

/// What the files of all units have.
struct ValueFile {
  std::string token;       ///< the modelDescription.xml that it belongs to
  bool is_scalar = false;  ///< of FMI 3: whether each number has a value reference of its own
  std::vector<Group> groups;
  std::vector<double> starts;  ///< of all values
};

/// What resources/unit.txt says of a contact model unit.
struct UnitFile : ValueFile {
  struct Model {
    int body_a, body_b;
    std::string text;  ///< of the container
  };
  int slots = 0;              ///< sites of each model that have values and states of their own
  bool is_in_body = false;    ///< whether twists and wrenches are in the frame of the body
  std::vector<char> is_free;  ///< of each body, whether it has a pose and a twist among the inputs
  std::vector<Model> models;
};

/// The content of a file. Throws std::invalid_argument where it cannot be read.
std::string content_of(const std::string& path);

/// Reads what follows the word "token", "scalars" or "group"; false where the word is another.
bool read_value_line(TextReader& reader, std::string_view word, ValueFile& file);

/// Reads unit.txt and model_<i>.txt of a folder. Throws std::invalid_argument naming the file.
UnitFile read_unit(const std::string& folder);

}  // namespace volcontact::fmu
