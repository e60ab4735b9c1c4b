// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

namespace volcontact::adaptor {

/// Writes JSON: begin, name and value calls in the order of the text; commas come by themselves.
class JsonText {
 public:
  JsonText& begin_object() { return open('{'); }
  JsonText& end_object() { return close('}'); }
  JsonText& begin_array() { return open('['); }
  JsonText& end_array() { return close(']'); }

  JsonText& name(std::string_view text) {
    separate();
    quote(text);
    out_ += ':';
    after_name_ = true;
    return *this;
  }
  JsonText& value(std::string_view text) {
    separate();
    quote(text);
    return *this;
  }
  JsonText& value(const char* text) { return value(std::string_view(text)); }
  JsonText& value(bool flag) { return raw(flag ? "true" : "false"); }
  JsonText& value(int number) { return raw(std::to_string(number)); }
  JsonText& value(std::int64_t number) { return raw(std::to_string(number)); }
  /// Numbers that are not finite are not JSON: null.
  JsonText& value(double number) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.17g", number);
    return raw(std::isfinite(number) ? digits : "null");
  }
  /// One number as a number, several as an array.
  JsonText& value(const std::vector<double>& numbers) {
    if (numbers.size() == 1) return value(numbers[0]);
    begin_array();
    for (const double number : numbers) value(number);
    return end_array();
  }
  template <typename T>
  JsonText& member(std::string_view key, const T& content) {
    return name(key).value(content);
  }

  const std::string& text() const { return out_; }

 private:
  JsonText& open(char bracket) {
    separate();
    out_ += bracket;
    first_ = true;
    return *this;
  }
  JsonText& close(char bracket) {
    out_ += bracket;
    first_ = false;
    return *this;
  }
  JsonText& raw(std::string_view text) {
    separate();
    out_ += text;
    return *this;
  }
  void separate() {
    if (!first_ && !after_name_) out_ += ',';
    first_ = false;
    after_name_ = false;
  }
  void quote(std::string_view text) {
    out_ += '"';
    for (const char c : text) {
      if (c == '"' || c == '\\') {
        out_ += '\\';
        out_ += c;
      } else if (static_cast<unsigned char>(c) < 0x20) {
        char escaped[8];
        std::snprintf(escaped, sizeof escaped, "\\u%04x", static_cast<unsigned>(c));
        out_ += escaped;
      } else {
        out_ += c;
      }
    }
    out_ += '"';
  }

  std::string out_;
  bool first_ = true;
  bool after_name_ = false;
};

}  // namespace volcontact::adaptor
