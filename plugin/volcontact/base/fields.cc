// SPDX-License-Identifier: Apache-2.0
#include "volcontact/base/fields.h"

#include <sstream>

namespace volcontact {

std::string out_of_range_message(std::string_view component, std::string_view field,
                                 std::string_view unit, double value, const Range& range) {
  std::ostringstream message;
  message << component << ": " << field << " = " << value << " [" << unit
          << "] is out of range: must be " << range.text;
  return message.str();
}

std::string unknown_field_message(std::string_view component, std::string_view field,
                                  const std::vector<std::string>& fields) {
  std::ostringstream message;
  message << component << " has no field '" << field << "'" << did_you_mean(field, fields);
  return message.str();
}

std::string wrong_size_message(std::string_view component, std::string_view field, int wanted,
                               std::size_t got) {
  std::ostringstream message;
  message << component << ": " << field << " takes " << wanted
          << (wanted == 1 ? " number, got " : " numbers, got ") << got;
  return message.str();
}

std::string unknown_word_message(std::string_view what, std::string_view word,
                                 const std::vector<std::string>& words) {
  std::ostringstream message;
  message << "unknown " << what << " '" << word << "': one of ";
  for (std::size_t i = 0; i < words.size(); ++i) message << (i ? ", " : "") << words[i];
  message << did_you_mean(word, words);
  return message.str();
}

}  // namespace volcontact
