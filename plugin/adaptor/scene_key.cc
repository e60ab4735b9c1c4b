// SPDX-License-Identifier: Apache-2.0
#include "adaptor/scene_key.h"

#include <sstream>
#include <stdexcept>

#include "volcontact/base/check.h"
#include "volcontact/base/spelling.h"

namespace volcontact::adaptor {
namespace {

std::vector<std::string> split(std::string_view text) {
  std::vector<std::string> parts;
  std::istringstream stream{std::string(text)};
  for (std::string part; std::getline(stream, part, '/');) parts.push_back(part);
  if (text.empty() || text.back() == '/') parts.emplace_back();
  return parts;
}

}  // namespace

std::string SceneKey::stem(std::size_t count) const {
  std::string out = prefix + std::string(kRoot);
  for (std::size_t i = 0; i < count; ++i) out += (i ? "/" : "") + parts[i];
  return out;
}

std::optional<SceneKey> parse_key(const std::string& name) {
  const std::size_t at = name.find(kRoot);
  if (at != std::string::npos) {
    return SceneKey{name, name.substr(0, at),
                    split(std::string_view(name).substr(at + kRoot.size()))};
  }
  const std::size_t slash = name.find('/');
  if (slash == std::string::npos) return std::nullopt;
  const std::string root(kRoot.substr(0, kRoot.size() - 1));
  require(nearest_spelling(name.substr(0, slash), {root}).empty(),
          name + ": unknown key (did you mean '" + root + name.substr(slash) + "'?)");
  return std::nullopt;
}

std::string number_text(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

void unknown_part(SceneKey key, std::size_t part, const std::vector<std::string>& words) {
  const std::string stem = key.stem(part) + (part ? "/" : "");
  std::string message =
      key.text + ": unknown key; after '" + stem + "' comes one of " + joined(words);
  const std::string word = part < key.parts.size() ? key.parts[part] : "";
  const std::string nearest = nearest_spelling(word, words);
  if (!nearest.empty()) {
    key.parts[part] = nearest;
    message += " (did you mean '" + key.stem(key.parts.size()) + "'?)";
  }
  throw std::invalid_argument(message);
}

}  // namespace volcontact::adaptor
