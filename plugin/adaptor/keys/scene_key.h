// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "volcontact/base/fields.h"

namespace volcontact::adaptor {

/// The first word of the names of our numerics and tuples.
inline constexpr std::string_view kRoot = "volcontact/";

/// "c1_volcontact/material/rubber/stiffness" split: prefix "c1_", parts {material, rubber,
/// stiffness}.
struct SceneKey {
  std::string text;
  std::string prefix;
  std::vector<std::string> parts;

  /// "c1_volcontact/" and the first `count` parts, or all where there are fewer.
  std::string stem(std::size_t count) const;
};

/// Null when the name is not one of ours. Throws std::invalid_argument where its first word is
/// nearly `volcontact`: the key would be ignored in silence.
std::optional<SceneKey> parse_key(const std::string& name);

/// As short as it goes: 1, 0.5, 1e-09.
std::string number_text(double number);

/// "a, b, c".
std::string joined(const std::vector<std::string>& words);

/// Throws std::invalid_argument: the key has none of `words` as its part number `part`. Names the
/// nearest valid spelling. The key may end before that part.
[[noreturn]] void unknown_part(SceneKey key, std::size_t part,
                               const std::vector<std::string>& words);

/// Throws std::invalid_argument where the key has not as many numbers as wanted.
void check_count(const SceneKey& key, std::size_t wanted, const std::vector<double>& numbers);

/// Puts the word of a choice into `choices`. A choice is spelled in the key, whose part number
/// `part` is one of `words`: .../friction_law/regularized_coulomb with data 1, or 0 for "not this
/// one", so that a program can switch it in a compiled model. Throws std::invalid_argument.
void read_choice(const SceneKey& key, std::size_t part, const std::vector<std::string>& words,
                 const std::vector<double>& numbers, ChoiceValues& choices);

}  // namespace volcontact::adaptor
