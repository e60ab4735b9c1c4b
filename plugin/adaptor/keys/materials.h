// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "adaptor/keys/law_tables.h"
#include "volcontact/model/contact_model.h"

namespace volcontact::adaptor {

/// Fields and choices as a scene gives them under one name: a material, or the overrides of a pair.
struct KeyedValues {
  std::string key;  ///< e.g. "volcontact/material/rubber", with the prefix MjSpec.attach gave it
  FieldValues values;
  ChoiceValues choices;  ///< "normal_law" -> "volume_spring", "rolling" -> "off"
};

/// One side of a pair: what its geom is made of.
struct Side {
  std::string name;                       ///< of the geom
  double native_friction = 0.0;           ///< its sliding friction in MuJoCo [-]
  const KeyedValues* material = nullptr;  ///< null: the default material
  std::string friction_giver = {};        ///< "<pair> 'p'" where not the geom gives it
};

/// The number a pair uses and where it comes from.
struct PairField {
  std::string name;
  std::string unit;
  std::vector<double> value;
  std::string source;
};

/// The laws of one pair, ready to use and ready to explain.
struct PairLaws {
  ContactLaws laws;
  std::string normal_law;
  std::string friction_law;
  ChoiceValues choices;  ///< of the laws themselves: coupling
  std::vector<PairField> fields;
  double stiffness = HUGE_VAL;  ///< of the normal law [N/m^3]; infinite where it says none
  std::vector<std::string> warnings;
};

/// Value of the default material, which also fills what a material leaves out, after the rule of
/// the field: MuJoCo's own value of the geom, the rule's usual one, or the law's default.
std::vector<double> default_value(const FieldRow& field, double native_friction);

/// Laws of a pair from two materials: the pair's own values first, else what the rules of the
/// fields make of the two (force/material_rule.h). docs/theory.md, "Materials". Throws
/// std::invalid_argument where the materials name different laws and the pair does not choose.
PairLaws combine(const Side& a, const Side& b, const KeyedValues* pair);

}  // namespace volcontact::adaptor
