// SPDX-License-Identifier: Apache-2.0
#include "adaptor/keys/materials.h"

#include <algorithm>

#include "volcontact/force/elastic_layer.h"
#include "volcontact/force/laws.h"

namespace volcontact::adaptor {
namespace {

constexpr const char* kStiffness = "stiffness";
constexpr const char* kDamping = "damping";
constexpr const char* kRestitution = "restitution";
constexpr const char* kFriction = "friction";
constexpr const char* kStaticFriction = "static_friction";
constexpr double kDefaultDamping = 1.0;  // [s/m]; a resting contact settles within 1 / (g a)

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

std::vector<double> value_of(const Side& side, const FieldRow& field) {
  if (const std::vector<double>* own = given(side.material, field.name)) return *own;
  if (field.name == kStaticFriction) {  // without a number of its own, as the kinetic one
    const std::vector<double>* kinetic = given(side.material, kFriction);
    return kinetic ? *kinetic : std::vector<double>{side.native_friction};
  }
  return default_value(field, side.native_friction);
}

std::string source_of(const Side& side, const FieldRow& field) {
  if (given(side.material, field.name)) return side.material->key;
  if (field.name == kStaticFriction && given(side.material, kFriction)) {
    return side.material->key + "/" + kFriction;
  }
  const bool native = field.name == kFriction || field.name == kStaticFriction;
  if (!native) return "default";
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

double combined(const std::string& field, double a, double b, const Stiffnesses& k) {
  if (field == kStiffness) return series_stiffness(a, b);
  if (field == kDamping) return series_damping(k.a, a, k.b, b);
  if (field == kRestitution) return series_restitution(k.a, a, k.b, b);
  return std::max(a, b);
}

const char* rule_of(const std::string& field) {
  if (field == kStiffness) return "in series: ";
  if (field == kDamping) return "weighted by compliance: ";
  if (field == kRestitution) return "its damping weighted by compliance: ";
  return "larger of: ";
}

// How the normal law of a pair is damped: by `damping`, or by `restitution` where that is given.
bool has_restitution(const Side& a, const Side& b, const KeyedValues* pair) {
  if (given(pair, kRestitution)) return true;
  if (given(pair, kDamping)) return false;
  const bool damping = given(a.material, kDamping) || given(b.material, kDamping);
  const bool restitution = given(a.material, kRestitution) || given(b.material, kRestitution);
  require(!(damping && restitution),
          "geoms '" + a.name + "' and '" + b.name +
              "': one of their materials gives damping and one restitution, which exclude each "
              "other; give one of the two in a volcontact/pair/<name> that lists the two geoms");
  return restitution;
}

PairField combine_field(const FieldRow& field, const Side& a, const Side& b,
                        const KeyedValues* pair, const Stiffnesses& stiffnesses) {
  PairField out{field.name, field.unit, {}, {}};
  if (const std::vector<double>* own = given(pair, field.name)) {
    out.value = *own;
    out.source = pair->key;
    return out;
  }
  if (field.name == kDamping && has_restitution(a, b, pair)) {
    return {field.name, field.unit, {0.0}, "none: restitution is given"};
  }
  if (field.name == kRestitution && !has_restitution(a, b, pair)) {
    return {field.name, field.unit, {1.0}, "none: damping holds"};
  }
  std::vector<double> of_a = value_of(a, field), of_b = value_of(b, field);
  if (field.name == kRestitution) {  // where one side alone gives it, it holds for both
    if (!given(a.material, field.name)) of_a = of_b;
    if (!given(b.material, field.name)) of_b = of_a;
  }
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    out.value.push_back(combined(field.name, of_a[i], of_b[i], stiffnesses));
  }
  const std::string source_a = source_of(a, field), source_b = source_of(b, field);
  const bool same = source_a == source_b && of_a == of_b;
  out.source = rule_of(field.name) + (same ? source_a + " (both)" : source_a + ", " + source_b);
  return out;
}

// A pair that gives a kinetic friction above the static one of its materials means both.
void raise_static(std::vector<PairField>& fields) {
  PairField& least = fields.back();
  for (const PairField& field : fields) {
    if (field.name != kFriction || field.value[0] <= least.value[0]) continue;
    least.value = field.value;
    least.source = "as friction";
  }
}

Stiffnesses stiffnesses_of(const LawRow& law, const Side& a, const Side& b) {
  const FieldRow* field = law.field(kStiffness);
  if (!field) return {1.0, 1.0};
  return {value_of(a, *field)[0], value_of(b, *field)[0]};
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
  if (field.name == kFriction || field.name == kStaticFriction) return {native_friction};
  if (field.name == kDamping) return {kDefaultDamping};
  return field.defaults;
}

PairLaws combine(const Side& a, const Side& b, const KeyedValues* pair) {
  const auto law = [&](const char* choice, const std::vector<LawRow>& laws) -> const LawRow& {
    const std::string word = choose(choice, a, b, pair);
    return word.empty() ? laws.front() : law_called(laws, word);
  };
  const LawRow& normal = law(kNormalLaw, normal_laws());
  const LawRow& friction = law(kFrictionLaw, friction_laws());
  const Stiffnesses stiffnesses = stiffnesses_of(normal, a, b);

  PairLaws out;
  out.normal_law = normal.name;
  out.friction_law = friction.name;
  FieldValues normal_values, friction_values;
  const auto fill = [&](const LawRow& row, FieldValues& values) {
    for (const FieldRow& field : row.fields) {
      out.fields.push_back(combine_field(field, a, b, pair, stiffnesses));
      if (field.name == kStaticFriction && !given(pair, field.name)) raise_static(out.fields);
      values[field.name] = out.fields.back().value;
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
