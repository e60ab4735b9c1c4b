// SPDX-License-Identifier: Apache-2.0
#include "volcontact/model/model_text.h"

#include "volcontact/force/laws.h"
#include "volcontact/shape/shape_text.h"

namespace volcontact {
namespace {

void append_choice(const std::string& name, const std::string& word, std::string& text) {
  text += "choose " + name + " " + word + "\n";
}

void append_value(const char* name, const std::vector<double>& numbers, std::string& text) {
  text += std::string("set ") + name + " " + std::to_string(numbers.size());
  for (const double number : numbers) append_number(number, text);
  text += "\n";
}

// The lines of a law, if it is a `Law`.
template <typename Law, typename Base>
bool append_law(const Base& base, const char* slot, std::string& text) {
  const auto* law = dynamic_cast<const Law*>(&base);
  if (!law) return false;
  append_choice(slot, Law::kName, text);
  if constexpr (kHasChoices<Law>) {
    for (const auto& choice : Law::kChoices) {
      const auto index = static_cast<std::size_t>(law->params().*(choice.member));
      append_choice(choice.name, choice.words[index], text);
    }
  }
  for (const auto& field : Law::kFields) {
    std::vector<double> numbers;
    for (int i = 0; i < field.size(); ++i) numbers.push_back(field.get(law->params(), i));
    append_value(field.name, numbers, text);
  }
  return true;
}

template <typename Laws, typename Base>
void append_one_of(const Base& law, const char* slot, std::string& text) {
  bool found = false;
  for_each_type(Laws{}, [&]<typename Tag>(Tag) {
    found = found || append_law<typename Tag::Type>(law, slot, text);
  });
  require(found, std::string("the law '") + law.name() +
                     "' is not of the library and cannot be written as text");
}

void append_side(const Pose& X, const Shape& shape, std::string& text) {
  text += "at";
  append_pose(X, text);
  text += "\nsolid " + text_of(shape) + "\n";
}

}  // namespace

std::string text_of(const ContactModel& model) {
  const ContactLaws& laws = model.laws();
  std::string text;
  append_one_of<NormalLaws>(*laws.normal, "normal_law", text);
  if (laws.friction) {
    append_one_of<FrictionLaws>(*laws.friction, "friction_law", text);
  } else {
    append_choice("friction_law", "none", text);
  }
  append_choice("rolling", laws.rolling ? "on" : "off", text);
  append_choice("engine", to_string(model.options().engine), text);
  append_choice("formulation", kFormulationWords[static_cast<int>(laws.formulation)], text);
  append_value("tolerance", {model.options().tolerance}, text);
  append_value("share_of_a", {laws.share_of_a}, text);
  append_value("mass", {laws.mass}, text);
  for (const GeometricPair& pair : model.pairs()) {
    text += "pair\n";
    append_side(pair.X_Aa, pair.a, text);
    append_side(pair.X_Bb, pair.b, text);
  }
  return text;
}

}  // namespace volcontact
