// SPDX-License-Identifier: Apache-2.0
#include "adaptor/keys/materials.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "volcontact/force/elastic_layer.h"
#include "volcontact/force/laws.h"

namespace volcontact::adaptor {
namespace {

std::string material_text(const Side& side) {
  return side.material ? side.material->key : "the default material";
}

const std::vector<double>* given(const KeyedValues* keyed, const std::string& name) {
  if (!keyed) return nullptr;
  const auto found = keyed->values.find(name);
  return found == keyed->values.end() ? nullptr : &found->second;
}

const std::string* chosen(const KeyedValues* keyed, const std::string& name) {
  if (!keyed) return nullptr;
  const auto found = keyed->choices.find(name);
  return found == keyed->choices.end() ? nullptr : &found->second;
}

// Where a material gives no number, that of the field which its rule names.
const std::vector<double>* given_for(const KeyedValues* keyed, const FieldRow& field) {
  const std::vector<double>* own = given(keyed, field.name);
  return own || !field.rule->at_least ? own : given(keyed, field.rule->at_least);
}

std::vector<double> value_of(const Side& side, const FieldRow& field) {
  const std::vector<double>* own = given_for(side.material, field);
  return own ? *own : default_value(field, side.native_friction);
}

std::string source_of(const Side& side, const FieldRow& field) {
  if (given(side.material, field.name)) return side.material->key;
  if (given_for(side.material, field)) return side.material->key + "/" + field.rule->at_least;
  if (field.rule->native == NativeValue::kNone) return "default";
  return "friction of " + (side.friction_giver.empty() ? "geom " + side.name : side.friction_giver);
}

// The word for `choice`: the pair's, else the one word the two materials name; empty when nobody
// names one.
std::string choose(const std::string& choice, const Side& a, const Side& b,
                   const KeyedValues* pair) {
  if (const std::string* word = chosen(pair, choice)) return *word;
  const std::string* of_a = chosen(a.material, choice);
  const std::string* of_b = chosen(b.material, choice);
  require(!of_a || !of_b || *of_a == *of_b || choice == kRolling,
          "geoms '" + a.name + "' and '" + b.name + "': " + material_text(a) + " has " + choice +
              "/" + (of_a ? *of_a : "") + " and " + material_text(b) + " has " + choice + "/" +
              (of_b ? *of_b : "") + "; choose one in a volcontact/pair/<name> that lists the two");
  if (choice == kRolling) {
    const bool off = (of_a && *of_a == kOff) || (of_b && *of_b == kOff);
    return off ? kOff : "on";
  }
  return of_a ? *of_a : of_b ? *of_b : std::string();
}

// Stiffnesses of the two materials, which weight their damping.
struct Stiffnesses {
  double a;
  double b;
};

// The field of the law that `field` may replace, or that may replace it; null where there is none.
const FieldRow* replaced_by(const LawRow& law, const FieldRow& field) {
  return field.rule->in_place_of ? law.field(field.rule->in_place_of) : nullptr;
}
const FieldRow* replacing(const LawRow& law, const FieldRow& field) {
  for (const FieldRow& other : law.fields) {
    if (other.rule->in_place_of && field.name == other.rule->in_place_of) return &other;
  }
  return nullptr;
}

// Whether `field` holds in place of the one that it replaces: where it is given.
bool replaces(const FieldRow& field, const Side& a, const Side& b, const KeyedValues* pair) {
  const std::string replaced = field.rule->in_place_of;
  if (given(pair, field.name)) return true;
  if (given(pair, replaced)) return false;
  const bool old = given(a.material, replaced) || given(b.material, replaced);
  const bool own = given(a.material, field.name) || given(b.material, field.name);
  require(!(old && own), "geoms '" + a.name + "' and '" + b.name +
                             "': one of their materials gives " + replaced + " and one " +
                             field.name +
                             ", which exclude each other; give one of the two in a "
                             "volcontact/pair/<name> that lists the two geoms");
  return own;
}

PairField combine_field(const LawRow& law, const FieldRow& field, const Side& a, const Side& b,
                        const KeyedValues* pair, const Stiffnesses& stiffnesses) {
  PairField out{field.name, field.unit, {}, {}};
  if (const std::vector<double>* own = given(pair, field.name)) {
    out.value = *own;
    out.source = pair->key;
    return out;
  }
  const FieldRow* other = replacing(law, field);
  if (other && replaces(*other, a, b, pair)) {
    return {field.name, field.unit, field.defaults, "none: " + other->name + " is given"};
  }
  const FieldRow* usual = replaced_by(law, field);
  if (usual && !replaces(field, a, b, pair)) {
    return {field.name, field.unit, field.defaults, "none: " + usual->name + " holds"};
  }
  std::vector<double> of_a = value_of(a, field), of_b = value_of(b, field);
  if (usual) {  // where one side alone gives it, it holds for both
    if (!given(a.material, field.name)) of_a = of_b;
    if (!given(b.material, field.name)) of_b = of_a;
  }
  const Combination& combination = *field.rule->combination;
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    out.value.push_back(combination.of(of_a[i], of_b[i], stiffnesses.a, stiffnesses.b));
  }
  const std::string source_a = source_of(a, field), source_b = source_of(b, field);
  const bool same = source_a == source_b && of_a == of_b;
  out.source = combination.text + (same ? source_a + " (both)" : source_a + ", " + source_b);
  return out;
}

// A pair that gives a kinetic friction above the static one of its materials means both.
void raise(PairField& field, const char* at_least, const std::vector<PairField>& fields) {
  for (const PairField& other : fields) {
    if (other.name != at_least || other.value[0] <= field.value[0]) continue;
    field.value = other.value;
    field.source = "as " + other.name;
  }
}

const FieldRow* stiffness_of(const LawRow& law) {
  for (const FieldRow& field : law.fields) {
    if (field.rule->is_stiffness) return &field;
  }
  return nullptr;
}

// Fields that the pair or a material gives and neither law has.
void warn_unused(const KeyedValues* keyed, const LawRow& normal, const LawRow& friction,
                 PairLaws& out) {
  if (!keyed) return;
  for (const auto& [name, value] : keyed->values) {
    if (normal.field(name) || friction.field(name)) continue;
    out.warnings.push_back(keyed->key + "/" + name + " is not used: neither " + normal.name +
                           " nor " + friction.name + " has it");
  }
}

// Where nobody names a law: the first that has all the fields of such laws that are given, so that
// a slip speed says which law is meant; else the first of all.
const LawRow& law_with_the_fields(const std::vector<LawRow>& laws, const Side& a, const Side& b,
                                  const KeyedValues* pair) {
  const auto is_of_another = [&](const LawRow& law) {
    for (const KeyedValues* keyed : {pair, a.material, b.material}) {
      if (!keyed) continue;
      for (const auto& [name, value] : keyed->values) {
        const auto has = [&field = name](const LawRow& row) { return row.field(field) != nullptr; };
        if (!has(law) && std::any_of(laws.begin(), laws.end(), has)) return true;
      }
    }
    return false;
  };
  const auto found = std::find_if_not(laws.begin(), laws.end(), is_of_another);
  return found != laws.end() ? *found : laws.front();
}

ChoiceValues law_choices(const LawRow& law, const Side& a, const Side& b, const KeyedValues* pair) {
  ChoiceValues choices;
  for (const ChoiceRow& choice : law.choices) {
    const std::string word = choose(choice.name, a, b, pair);
    choices[choice.name] = word.empty() ? choice.words.front() : word;
  }
  return choices;
}

}  // namespace

std::vector<double> default_value(const FieldRow& field, double native_friction) {
  if (field.rule->native == NativeValue::kSlidingFriction) return {native_friction};
  if (!std::isnan(field.rule->usual)) return {field.rule->usual};
  return field.defaults;
}

PairLaws combine(const Side& a, const Side& b, const KeyedValues* pair) {
  const auto law = [&](const char* choice, const std::vector<LawRow>& laws) -> const LawRow& {
    const std::string word = choose(choice, a, b, pair);
    return word.empty() ? law_with_the_fields(laws, a, b, pair) : law_called(laws, word);
  };
  const LawRow& normal = law(kNormalLaw, normal_laws());
  const LawRow& friction = law(kFrictionLaw, friction_laws());
  const FieldRow* stiffness = stiffness_of(normal);
  const Stiffnesses stiffnesses =
      stiffness ? Stiffnesses{value_of(a, *stiffness)[0], value_of(b, *stiffness)[0]}
                : Stiffnesses{1.0, 1.0};

  PairLaws out;
  out.normal_law = normal.name;
  out.friction_law = friction.name;
  FieldValues normal_values, friction_values;
  const auto fill = [&](const LawRow& row, FieldValues& values) {
    for (const FieldRow& field : row.fields) {
      PairField found = combine_field(row, field, a, b, pair, stiffnesses);
      const char* at_least = field.rule->at_least;
      if (at_least && !given(pair, field.name)) raise(found, at_least, out.fields);
      values[field.name] = found.value;
      if (&field == stiffness) out.stiffness = found.value[0];
      out.fields.push_back(std::move(found));
    }
  };
  fill(normal, normal_values);
  fill(friction, friction_values);
  const ChoiceValues normal_choices = law_choices(normal, a, b, pair);
  const ChoiceValues friction_choices = law_choices(friction, a, b, pair);
  out.choices = friction_choices;
  out.choices.insert(normal_choices.begin(), normal_choices.end());
  try {
    out.laws.normal = make_normal(normal.name, normal_values, normal_choices);
    out.laws.friction = make_friction(friction.name, friction_values, friction_choices);
  } catch (const std::invalid_argument& error) {  // each is in range, and the two together are not
    throw std::invalid_argument("geoms '" + a.name + "' and '" + b.name + "', of " +
                                material_text(a) + " and " + material_text(b) +
                                (pair ? " with " + pair->key : "") + ": " + error.what());
  }
  out.laws.rolling = choose(kRolling, a, b, pair) != kOff;
  out.laws.share_of_a = share_of_first(stiffnesses.a, stiffnesses.b);
  warn_unused(pair, normal, friction, out);
  warn_unused(a.material, normal, friction, out);
  if (b.material != a.material) warn_unused(b.material, normal, friction, out);
  return out;
}

}  // namespace volcontact::adaptor
