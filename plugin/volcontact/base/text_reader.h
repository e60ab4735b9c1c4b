// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <charconv>
#include <cstdio>
#include <string>
#include <string_view>

#include "volcontact/base/check.h"

namespace volcontact {

/// Appends a number with a space before it, so that it is read back to the bit.
inline void append_number(double number, std::string& text) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, " %.17g", number);
  text += buffer;
}

/// Reads words and numbers that white space parts; a word that begins with # and the rest of its
/// line are a remark. Throws std::invalid_argument naming the line.
class TextReader {
 public:
  explicit TextReader(std::string_view text) : text_(text) {}

  bool at_end() {
    skip_space();
    return at_ == text_.size();
  }

  std::string_view word(const char* what) {
    require(!at_end(), where() + "the text ends where " + what + " is wanted");
    const std::size_t start = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    return text_.substr(start, at_ - start);
  }

  double number(const char* what) {
    const std::string_view token = word(what);
    double value = 0.0;
    const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
    require(error == std::errc() && end == token.data() + token.size(),
            where() + "'" + std::string(token) + "' is no number where " + what + " is wanted");
    return value;
  }

  /// A whole number from 0 to `most`.
  int count(const char* what, int most) {
    const double value = number(what);
    require(value >= 0.0 && value <= most && value == static_cast<int>(value),
            where() + what + " must be a whole number from 0 to " + std::to_string(most));
    return static_cast<int>(value);
  }

  /// "line 3: ".
  std::string where() const { return "line " + std::to_string(line_) + ": "; }

 private:
  static bool is_space(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }
  void skip_space() {
    bool in_remark = false;
    for (; at_ < text_.size(); ++at_) {
      in_remark = (in_remark || text_[at_] == '#') && text_[at_] != '\n';
      if (!in_remark && !is_space(text_[at_])) return;
      line_ += text_[at_] == '\n';
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

}  // namespace volcontact
