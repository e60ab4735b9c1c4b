// SPDX-License-Identifier: GPL-3.0-or-later
#include "cgal/off_file.h"

#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string_view>

namespace volcontact_cgal {
namespace {

/// Words of a text one by one, without comments; fails with the name of what was expected.
class Words {
 public:
  Words(std::string path, std::string_view text) : path_(std::move(path)), text_(text) {}

  std::string_view next(const char* expected) {
    for (;;) {
      const std::size_t start = text_.find_first_not_of(" \t\r\n", at_);
      if (start == std::string_view::npos) fail(std::string("ends before ") + expected);
      if (text_[start] != '#') {
        at_ = std::min(text_.find_first_of(" \t\r\n#", start), text_.size());
        return text_.substr(start, at_ - start);
      }
      at_ = std::min(text_.find('\n', start), text_.size());
    }
  }

  template <typename Number>
  Number number(const char* expected) {
    const std::string_view word = next(expected);
    Number value{};
    const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (fault != std::errc() || end != word.data() + word.size()) {
      fail("has '" + std::string(word) + "' instead of " + expected);
    }
    return value;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw std::invalid_argument(path_ + " " + what);
  }

  std::size_t left() const { return text_.size() - at_; }

 private:
  std::string path_;
  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

Soup read_off(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw std::invalid_argument(path + " cannot be read");
  Words words(path, text);
  if (words.next("the word OFF") != "OFF") words.fail("does not begin with OFF");
  const auto points = words.number<std::size_t>("the number of points");
  const auto faces = words.number<std::size_t>("the number of faces");
  words.number<std::size_t>("the number of edges");
  // Each takes six bytes or more: a wrong number must not ask for all memory.
  if (points > words.left() || faces > words.left()) words.fail("is shorter than its counts say");

  Soup soup;
  soup.points.resize(points);
  for (Point& point : soup.points) {
    for (double& x : point) {
      x = words.number<double>("a coordinate");
      if (!std::isfinite(x)) words.fail("has a coordinate that is no finite number");
    }
  }
  soup.faces.resize(faces);
  for (Face& face : soup.faces) {
    if (words.number<std::size_t>("the size of a face") != 3)
      words.fail("has a face of not 3 points");
    for (std::size_t& corner : face) {
      corner = words.number<std::size_t>("the index of a point");
      if (corner >= points) words.fail("has a face with a point that does not exist");
    }
  }
  return soup;
}

void write_off(const Soup& soup, const std::string& path) {
  std::string text = "OFF\n" + std::to_string(soup.points.size()) + ' ' +
                     std::to_string(soup.faces.size()) + " 0\n";
  char digits[32];
  for (const Point& p : soup.points) {
    for (int i = 0; i < 3; ++i) {
      text.append(digits, std::to_chars(digits, digits + sizeof digits, p[i]).ptr);
      text += i < 2 ? ' ' : '\n';
    }
  }
  for (const Face& f : soup.faces) {
    text += "3 " + std::to_string(f[0]) + ' ' + std::to_string(f[1]) + ' ' + std::to_string(f[2]) +
            '\n';
  }
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(path + " cannot be written");
}

}  // namespace volcontact_cgal
