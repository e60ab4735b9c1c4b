// SPDX-License-Identifier: Apache-2.0
#include "adaptor/keys/scene_options.h"

#include <cmath>
#include <iterator>

#include "volcontact/base/check.h"

namespace volcontact::adaptor {
namespace {

const std::map<std::string, std::vector<std::string>>& option_choices() {
  static const std::map<std::string, std::vector<std::string>> choices = [] {
    std::map<std::string, std::vector<std::string>> made;
    for (const Engine engine : kEngines) made["engine"].emplace_back(to_string(engine));
    made["target"] = {std::begin(kTargetWords), std::end(kTargetWords)};
    made["pairs"] = {std::begin(kPairRuleWords), std::end(kPairRuleWords)};
    made["implicit"] = {std::begin(kImplicitWords), std::end(kImplicitWords)};
    made["disabled"] = {std::begin(kDisabledWords), std::end(kDisabledWords)};
    made["mesh"] = {std::begin(kMeshFormWords), std::end(kMeshFormWords)};
    made["formulation"] = {std::begin(kFormulationWords), std::end(kFormulationWords)};
    return made;
  }();
  return choices;
}

}  // namespace

void OptionReader::read(const SceneKey& key, const std::vector<double>& numbers, bool by_program) {
  std::vector<std::string> names = field_names<OptionNumbers>();
  for (const auto& [name, words] : option_choices()) names.push_back(name);
  if (key.parts.size() < 2) unknown_part(key, 1, names);
  const std::string& name = key.parts[1];
  const auto choice = option_choices().find(name);
  if (choice != option_choices().end()) {
    ChoiceValues chosen;
    const auto before = given_.find(name);
    if (before != given_.end() && before->second.prefix == key.prefix &&
        before->second.by_program == by_program) {
      chosen[name] = before->second.word;
    }
    read_choice(key, 2, choice->second, numbers, chosen);
    if (numbers[0] == 1.0) keep(name, {key.prefix, key.text, numbers, key.parts[2], by_program});
    return;
  }
  const auto* field = find_field<OptionNumbers>(name);
  if (!field || key.parts.size() > 2) unknown_part(key, 1, names);
  check_count(key, 1, numbers);
  require(field->range.contains(numbers[0]) &&
              (name != "threads" || numbers[0] == std::floor(numbers[0])),
          out_of_range_message(key.stem(1), field->name, field->unit, numbers[0], field->range));
  keep(name, {key.prefix, key.text, numbers, "", by_program});
}

void OptionReader::keep(const std::string& name, Given option) {
  Given& kept = given_.emplace(name, option).first->second;
  if (option.prefix.empty()) {
    kept = std::move(option);
  } else if (kept.numbers != option.numbers || kept.word != option.word) {
    disagreements_.emplace(name, option.key + " and " + kept.key + " differ; say which in " +
                                     std::string(kRoot) + "option/" + name);
  }
}

template <typename Enum, std::size_t kCount>
void OptionReader::set_choice(const std::string& name, const char* const (&words)[kCount],
                              Enum& out) const {
  const auto given = given_.find(name);
  if (given == given_.end()) return;
  for (std::size_t i = 0; i < kCount; ++i) {
    if (given->second.word == words[i]) out = static_cast<Enum>(i);
  }
}

SceneOptions OptionReader::finish() const {
  for (const auto& [name, message] : disagreements_) {
    require(given_.at(name).prefix.empty(), message);
  }
  OptionNumbers::Params numbers;
  for (const auto& field : OptionNumbers::kFields) {
    const auto given = given_.find(field.name);
    if (given != given_.end()) field.set(numbers, 0, given->second.numbers[0]);
  }
  SceneOptions options;
  options.tolerance = numbers.tolerance;
  options.threads = static_cast<int>(numbers.threads);
  options.exit_speed = numbers.exit_speed;
  const auto engine = given_.find("engine");
  if (engine != given_.end()) options.engine = engine_from(engine->second.word);
  set_choice("target", kTargetWords, options.target);
  set_choice("pairs", kPairRuleWords, options.pairs);
  set_choice("implicit", kImplicitWords, options.implicit);
  set_choice("disabled", kDisabledWords, options.disabled);
  set_choice("mesh", kMeshFormWords, options.mesh);
  set_choice("formulation", kFormulationWords, options.formulation);
  return options;
}

}  // namespace volcontact::adaptor
