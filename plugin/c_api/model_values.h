// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "c_api/solid.h"
#include "volcontact/force/law_table.h"
#include "volcontact/model/contact_model.h"

namespace volcontact::c_api {

/// A law by its name, with what was set of it.
struct NamedLaw {
  std::string law;  ///< "none": there is none
  FieldValues values;
  ChoiceValues words;
};

/// One side of a pair.
struct NamedSide {
  NamedSolid solid;
  Pose X;  ///< in its body
};

/// All numbers and words that a contact model is made of, by the names that MJCF keys and Python
/// use.
class ModelValues {
 public:
  /// Throw std::invalid_argument naming what there is.
  std::vector<double> get(std::string_view name) const;
  void set(std::string_view name, const double* numbers, int count);
  std::string chosen(std::string_view name) const;
  void choose(std::string_view name, std::string_view word);

  void add_pair(NamedSide a, NamedSide b) { pairs_.push_back({std::move(a), std::move(b)}); }
  int pair_count() const { return static_cast<int>(pairs_.size()); }

  /// The model; it must have a pair. Throws std::invalid_argument on values out of range, and where
  /// engine or formulation do not serve a pair.
  ContactModel model() const;

  /// The laws alone, checked.
  ContactLaws laws() const;

  /// A line for each name: unit, range, value.
  std::string table() const;

 private:
  struct SideName {
    std::size_t pair;
    bool is_b;
    std::string_view field;
  };
  /// A row of one of the two laws; null where neither has it.
  template <typename Row>
  struct Found {
    const Row* row = nullptr;
    bool in_friction = false;
  };
  Found<FieldRow> field(std::string_view name) const;
  Found<ChoiceRow> choice(std::string_view name) const;
  NamedLaw& law(bool friction) { return friction ? friction_ : normal_; }
  const NamedLaw& law(bool friction) const { return friction ? friction_ : normal_; }
  static bool is_side(std::string_view name) { return name.substr(0, 5) == "pair/"; }
  SideName side_name(std::string_view name) const;
  const NamedSide& side(const SideName& name) const;
  NamedSide& side(const SideName& name);
  std::vector<std::string> number_names() const;
  std::vector<std::string> word_names() const;

  struct NamedPair {
    NamedSide a, b;
  };
  std::vector<NamedPair> pairs_;
  NamedLaw normal_{"hunt_crossley", {}, {}};
  NamedLaw friction_{"none", {}, {}};
  bool rolling_ = true;
  Formulation formulation_ = Formulation::kGonthier;
  Engine engine_ = Engine::kAuto;
  double tolerance_ = 1e-3;
  double share_of_a_ = 0.5;
  double mass_ = 0.0;
  double threads_ = 1;
};

}  // namespace volcontact::c_api
