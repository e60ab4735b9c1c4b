// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <vector>

namespace volcontact_cgal {

inline std::string json(bool value) { return value ? "true" : "false"; }
inline std::string json(std::size_t value) { return std::to_string(value); }

inline std::string json(double value) {
  if (!std::isfinite(value)) return "null";
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

template <std::size_t n>
std::string json(const std::array<double, n>& items);

template <typename Items>
std::string json_list(const Items& items) {
  std::string text;
  for (const auto& item : items) text += (text.empty() ? "" : ", ") + json(item);
  return "[" + text + "]";
}

template <std::size_t n>
std::string json(const std::array<double, n>& items) {
  return json_list(items);
}

/// An object, its members in the order in which they were added.
class JsonObject {
 public:
  template <typename Value>
  JsonObject& add(const char* name, const Value& value) {
    return add_text(name, json(value));
  }

  JsonObject& add_text(const char* name, const std::string& text) {
    text_ += (text_.empty() ? "" : ", ") + ('"' + std::string(name) + "\": ") + text;
    return *this;
  }

  std::string text() const { return "{" + text_ + "}"; }

 private:
  std::string text_;
};

/// The objects that `describe` makes of the items.
template <typename Item, typename Describe>
std::string json_objects(const std::vector<Item>& items, const Describe& describe) {
  std::string text;
  for (const Item& item : items) text += (text.empty() ? "" : ", ") + describe(item).text();
  return "[" + text + "]";
}

}  // namespace volcontact_cgal
