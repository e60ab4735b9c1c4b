// SPDX-License-Identifier: Apache-2.0
#include "adaptor/keys/scene_key.h"

#include <algorithm>
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
  for (std::size_t i = 0; i < std::min(count, parts.size()); ++i) out += (i ? "/" : "") + parts[i];
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
  const bool has_name = part <= key.parts.size();  // else it ends before what the words follow
  const std::string stem = key.stem(part) + (part ? "/" : "");
  std::string message = key.text + ": unknown key; after '" + stem + "' comes " +
                        (has_name ? "" : "a name, then '/' and ") + "one of " + joined(words);
  const std::string nearest =
      part < key.parts.size() ? nearest_spelling(key.parts[part], words) : "";
  if (!nearest.empty()) {
    key.parts[part] = nearest;
    message += " (did you mean '" + key.stem(key.parts.size()) + "'?)";
  }
  throw std::invalid_argument(message);
}

void check_count(const SceneKey& key, std::size_t wanted, const std::vector<double>& numbers) {
  require(numbers.size() == wanted, key.text + " takes " + std::to_string(wanted) +
                                        (wanted == 1 ? " number, got " : " numbers, got ") +
                                        std::to_string(numbers.size()));
}

void read_choice(const SceneKey& key, std::size_t part, const std::vector<std::string>& words,
                 const std::vector<double>& numbers, ChoiceValues& choices) {
  if (key.parts.size() <= part) unknown_part(key, part, words);
  const std::string& word = key.parts[part];
  if (std::find(words.begin(), words.end(), word) == words.end()) unknown_part(key, part, words);
  if (key.parts.size() > part + 1) {
    throw std::invalid_argument(key.text + ": unknown key (did you mean '" + key.stem(part + 1) +
                                "'?)");
  }
  check_count(key, 1, numbers);
  require(numbers[0] == 0.0 || numbers[0] == 1.0,
          key.text + ": the choice is in the key; its data must be 1 (or 0 for off)");
  if (numbers[0] == 0.0) return;
  const auto [entry, is_new] = choices.emplace(key.parts[part - 1], word);
  require(is_new, key.text + ": " + key.stem(part) + "/" + entry->second + " is chosen already");
}

}  // namespace volcontact::adaptor
