// SPDX-License-Identifier: Apache-2.0
#include "c_api/model_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <utility>

#include "c_api/guarded.h"
#include "volcontact/base/check.h"
#include "volcontact/force/laws.h"

namespace volcontact::c_api {
namespace {

constexpr const char* kNone = "none";
constexpr Range kTolerance{0.0, 1.0, true, true, "> 0 and < 1"};
constexpr Range kThreads{0.0, 1024.0, false, false, "whole, 0 (decide by work) to 1024"};

template <typename Base>
const LawRow* find_law(const std::vector<LawEntry<Base>>& entries, std::string_view name) {
  for (const LawEntry<Base>& entry : entries) {
    if (entry.row.name == name) return &entry.row;
  }
  return nullptr;
}
const LawRow* normal_row(const NamedLaw& law) { return find_law(normal_law_entries(), law.law); }
const LawRow* friction_row(const NamedLaw& law) {
  return find_law(friction_law_entries(), law.law);
}

template <typename Base>
std::vector<std::string> law_names(const std::vector<LawEntry<Base>>& entries) {
  std::vector<std::string> names;
  for (const LawEntry<Base>& entry : entries) names.push_back(entry.row.name);
  return names;
}
std::vector<std::string> friction_names() {
  std::vector<std::string> names = law_names(friction_law_entries());
  names.emplace_back(kNone);
  return names;
}
std::vector<std::string> engine_names() {
  std::vector<std::string> names;
  for (const Engine engine : kEngines) names.emplace_back(to_string(engine));
  return names;
}
const std::vector<std::string> kOnOff{"on", "off"};
const std::vector<std::string> kFormulations(std::begin(kFormulationWords),
                                             std::end(kFormulationWords));

std::size_t index_of(const std::vector<std::string>& words, std::string_view word,
                     const char* what) {
  const auto found = std::find(words.begin(), words.end(), word);
  require(found != words.end(), unknown_word_message(what, word, words));
  return static_cast<std::size_t>(found - words.begin());
}

double one_number(std::string_view name, const double* numbers, int count, const Range& range,
                  const char* unit = "-") {
  const std::vector<double> list = numbers_from(numbers, count, name);
  require(list.size() == 1, wrong_size_message("contact_model", name, 1, list.size()));
  require(range.contains(list[0]),
          out_of_range_message("contact_model", name, unit, list[0], range));
  return list[0];
}

std::string joined(const std::vector<std::string>& words, const char* by) {
  std::string text;
  for (const std::string& word : words) {
    if (!text.empty()) text += by;
    text += word;
  }
  return text;
}

std::string digits(const std::vector<double>& numbers) {
  std::string text;
  for (const double number : numbers) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.17g", number);
    if (!text.empty()) text += ' ';
    text += buffer;
  }
  return text;
}

}  // namespace

auto ModelValues::field(std::string_view name) const -> Found<FieldRow> {
  for (const bool friction : {false, true}) {
    const LawRow* of = friction ? friction_row(friction_) : normal_row(normal_);
    const FieldRow* row = of ? of->field(name) : nullptr;
    if (row) return {row, friction};
  }
  return {};
}

auto ModelValues::choice(std::string_view name) const -> Found<ChoiceRow> {
  for (const bool friction : {false, true}) {
    const LawRow* of = friction ? friction_row(friction_) : normal_row(normal_);
    const ChoiceRow* row = of ? of->choice(name) : nullptr;
    if (row) return {row, friction};
  }
  return {};
}

ModelValues::SideName ModelValues::side_name(std::string_view name) const {
  const std::string whole(name);
  constexpr std::size_t kPrefix = 5;  // "pair/"
  SideName out{};
  const char* end = name.data() + name.size();
  const auto [rest, error] = std::from_chars(name.data() + kPrefix, end, out.pair);
  const std::string_view tail(rest, static_cast<std::size_t>(end - rest));
  require(error == std::errc() && tail.size() > 3 &&
              (tail.substr(0, 3) == "/a/" || tail.substr(0, 3) == "/b/"),
          "'" + whole + "' is no name: write pair/<index>/a/<parameter> or pair/<index>/b/...");
  require(out.pair < pairs_.size(), "'" + whole + "': the last pair of the model is number " +
                                        std::to_string(pairs_.size() - 1));
  out.is_b = tail[1] == 'b';
  out.field = tail.substr(3);
  return out;
}

const NamedSide& ModelValues::side(const SideName& name) const {
  const NamedPair& pair = pairs_[name.pair];
  return name.is_b ? pair.b : pair.a;
}

NamedSide& ModelValues::side(const SideName& name) {
  NamedPair& pair = pairs_[name.pair];
  return name.is_b ? pair.b : pair.a;
}

std::vector<double> ModelValues::get(std::string_view name) const {
  if (is_side(name)) {
    const SideName parts = side_name(name);
    const NamedSide& of = side(parts);
    if (parts.field != "pose") return of.solid.get(parts.field);
    std::vector<double> numbers(16);
    copy_pose(of.X, numbers.data());
    return numbers;
  }
  if (name == "tolerance") return {tolerance_};
  if (name == "share_of_a") return {share_of_a_};
  if (name == "mass") return {mass_};
  if (name == "threads") return {threads_};
  const auto [row, in_friction] = field(name);
  require(row != nullptr, unknown_word_message("parameter", name, number_names()));
  const FieldValues& values = law(in_friction).values;
  const auto found = values.find(name);
  return found != values.end() ? found->second : row->defaults;
}

void ModelValues::set(std::string_view name, const double* numbers, int count) {
  if (is_side(name)) {
    const SideName parts = side_name(name);
    NamedSide& of = side(parts);
    if (parts.field == "pose") {
      require(numbers_from(numbers, count, name).size() == 16,
              wrong_size_message("contact_model", name, 16, static_cast<std::size_t>(count)));
      of.X = pose_from(numbers, std::string(name).c_str());
    } else {
      of.solid = of.solid.with(parts.field, numbers, count);
    }
  } else if (name == "tolerance") {
    tolerance_ = one_number(name, numbers, count, kTolerance);
  } else if (name == "share_of_a") {
    share_of_a_ = one_number(name, numbers, count, kZeroToOne);
  } else if (name == "mass") {
    mass_ = one_number(name, numbers, count, kNonNegative, "kg");
  } else if (name == "threads") {
    const double number = one_number(name, numbers, count, kThreads);
    require(number == std::floor(number),
            out_of_range_message("contact_model", name, "-", number, kThreads));
    threads_ = number;
  } else {
    const auto [row, in_friction] = field(name);
    require(row != nullptr, unknown_word_message("parameter", name, number_names()));
    law(in_friction).values[std::string(name)] = numbers_from(numbers, count, name);
  }
}

std::string ModelValues::chosen(std::string_view name) const {
  if (name == "normal_law") return normal_.law;
  if (name == "friction_law") return friction_.law;
  if (name == "rolling") return kOnOff[rolling_ ? 0 : 1];
  if (name == "engine") return to_string(engine_);
  if (name == "formulation") return kFormulations[static_cast<std::size_t>(formulation_)];
  const auto [row, in_friction] = choice(name);
  require(row != nullptr, unknown_word_message("choice", name, word_names()));
  const ChoiceValues& words = law(in_friction).words;
  const auto found = words.find(name);
  return found != words.end() ? found->second : row->words.front();
}

void ModelValues::choose(std::string_view name, std::string_view word) {
  if (name == "normal_law") {
    index_of(law_names(normal_law_entries()), word, "normal law");
    if (normal_.law != word) normal_ = {std::string(word), {}, {}};
  } else if (name == "friction_law") {
    index_of(friction_names(), word, "friction law");
    if (friction_.law != word) friction_ = {std::string(word), {}, {}};
  } else if (name == "rolling") {
    rolling_ = index_of(kOnOff, word, "choice of rolling") == 0;
  } else if (name == "engine") {
    engine_ = engine_from(word);
  } else if (name == "formulation") {
    formulation_ = formulation_from(word);
  } else {
    const auto [row, in_friction] = choice(name);
    require(row != nullptr, unknown_word_message("choice", name, word_names()));
    index_of(row->words, word, row->name.c_str());
    law(in_friction).words[std::string(name)] = word;
  }
}

ContactLaws ModelValues::laws() const {
  ContactLaws laws;
  laws.normal = make_normal(normal_.law, normal_.values, normal_.words);
  if (friction_.law != kNone) {
    laws.friction = make_friction(friction_.law, friction_.values, friction_.words);
  }
  laws.rolling = rolling_;
  laws.formulation = formulation_;
  laws.share_of_a = share_of_a_;
  laws.mass = mass_;
  return laws;
}

ContactModel ModelValues::model() const {
  std::vector<GeometricPair> pairs;
  pairs.reserve(pairs_.size());
  for (const NamedPair& pair : pairs_) {
    pairs.push_back({pair.a.solid.shape, pair.b.solid.shape, pair.a.X, pair.b.X});
  }
  return {std::move(pairs), laws(), {tolerance_, engine_, static_cast<int>(threads_)}};
}

std::vector<std::string> ModelValues::number_names() const {
  std::vector<std::string> names;
  for (const LawRow* row : {normal_row(normal_), friction_row(friction_)}) {
    if (!row) continue;
    for (const FieldRow& field : row->fields) names.push_back(field.name);
  }
  names.insert(names.end(), {"tolerance", "share_of_a", "mass", "threads"});
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    for (const bool is_b : {false, true}) {
      const std::string head = "pair/" + std::to_string(i) + (is_b ? "/b/" : "/a/");
      for (const auto& row : side({i, is_b, {}}).solid.rows()) names.push_back(head + row.name);
      names.push_back(head + "pose");
    }
  }
  return names;
}

std::vector<std::string> ModelValues::word_names() const {
  std::vector<std::string> names{"normal_law", "friction_law", "rolling", "engine", "formulation"};
  for (const LawRow* row : {normal_row(normal_), friction_row(friction_)}) {
    if (!row) continue;
    for (const ChoiceRow& choice : row->choices) names.push_back(choice.name);
  }
  return names;
}

std::string ModelValues::table() const {
  std::string text;
  const auto line = [&](const std::string& name, const std::string& unit, const std::string& range,
                        const std::string& value) {
    text += name + "\t" + unit + "\t" + range + "\t" + value + "\n";
  };
  const auto words = [&](const std::string& name, const std::vector<std::string>& allowed) {
    line(name, "word", joined(allowed, "|"), chosen(name));
  };
  words("normal_law", law_names(normal_law_entries()));
  words("friction_law", friction_names());
  words("rolling", kOnOff);
  words("engine", engine_names());
  words("formulation", kFormulations);
  for (const LawRow* row : {normal_row(normal_), friction_row(friction_)}) {
    if (!row) continue;
    for (const ChoiceRow& choice : row->choices) words(choice.name, choice.words);
    for (const FieldRow& field : row->fields) {
      line(field.name, field.unit, field.range.text, digits(get(field.name)));
    }
  }
  line("tolerance", "-", kTolerance.text, digits(get("tolerance")));
  line("share_of_a", "-", kZeroToOne.text, digits(get("share_of_a")));
  line("mass", "kg", kNonNegative.text, digits(get("mass")));
  line("threads", "-", kThreads.text, digits(get("threads")));
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    for (const bool is_b : {false, true}) {
      const std::string head = "pair/" + std::to_string(i) + (is_b ? "/b/" : "/a/");
      for (const auto& row : side({i, is_b, {}}).solid.rows()) {
        line(head + row.name, row.unit, row.range, digits(get(head + row.name)));
      }
      line(head + "pose", "m", "row-major 4x4", digits(get(head + "pose")));
    }
  }
  return text;
}

}  // namespace volcontact::c_api
