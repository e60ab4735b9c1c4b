// SPDX-License-Identifier: Apache-2.0
#include "c_api/model.h"

#include <algorithm>
#include <cmath>

#include "c_api/guarded.h"
#include "volcontact/base/check.h"

using namespace volcontact;
using namespace volcontact::c_api;

namespace {

// Makes the model of changed values; only then are they taken over.
void take_over(vc_model* model, ModelValues values) {
  values.laws();  // checks them, also where there is no pair yet
  std::optional<ContactModel> made;
  if (values.pair_count() > 0) made.emplace(values.model());
  model->values = std::move(values);
  model->contact = std::move(made);
}

// The state tables of both laws, in the order of a row.
std::vector<StateField> states_of(const vc_model* model) {
  const ContactLaws laws = model->values.laws();
  std::vector<StateField> states(laws.normal->states().begin(), laws.normal->states().end());
  if (!laws.friction) return states;
  const auto more = laws.friction->states();
  states.insert(states.end(), more.begin(), more.end());
  return states;
}

int row_size(const vc_model* model) {
  const std::vector<StateField> states = states_of(model);
  return states.empty() ? 0 : kSiteHead + size_of(states);
}

}  // namespace

extern "C" {

int vc_model_create(vc_model** model) {
  return guarded([&, function = __func__] {
    require_given(model, function, "model");
    *model = new vc_model;
    return 0;
  });
}

int vc_model_add_pair(vc_model* model, const vc_solid* a, const double* X_Aa, const vc_solid* b,
                      const double* X_Bb) {
  return guarded([&, function = __func__] {
    require_given(model, function, "model");
    require_given(a, function, "a");
    require_given(b, function, "b");
    ModelValues values = model->values;
    values.add_pair({a->named, pose_from(X_Aa, "vc_model_add_pair: X_Aa")},
                    {b->named, pose_from(X_Bb, "vc_model_add_pair: X_Bb")});
    take_over(model, std::move(values));
    return model->values.pair_count() - 1;
  });
}

int vc_model_choose(vc_model* model, const char* name, const char* word) {
  return guarded([&, function = __func__] {
    require_given(model, function, "model");
    require_given(name, function, "name");
    require_given(word, function, "word");
    ModelValues values = model->values;
    values.choose(name, word);
    take_over(model, std::move(values));
    return 0;
  });
}

int vc_model_chosen(const vc_model* model, const char* name, char* word, int capacity) {
  return guarded([&, function = __func__] {
    require_given(model, function, "model");
    require_given(name, function, "name");
    return copy_text(model->values.chosen(name), word, capacity);
  });
}

int vc_model_set(vc_model* model, const char* name, const double* numbers, int count) {
  return guarded([&, function = __func__] {
    require_given(model, function, "model");
    require_given(name, function, "name");
    ModelValues values = model->values;
    values.set(name, numbers, count);
    take_over(model, std::move(values));
    return 0;
  });
}

int vc_model_get(const vc_model* model, const char* name, double* numbers, int capacity) {
  return guarded([&, function = __func__] {
    require_given(model, function, "model");
    require_given(name, function, "name");
    const std::vector<double> values = model->values.get(name);
    const int count = static_cast<int>(values.size());
    if (numbers) std::copy_n(values.begin(), std::clamp(capacity, 0, count), numbers);
    return count;
  });
}

int vc_model_parameters(const vc_model* model, char* text, int capacity) {
  return guarded([&, function = __func__] {
    require_given(model, function, "model");
    return copy_text(model->values.table(), text, capacity);
  });
}

int vc_model_state_size(const vc_model* model, int sites) {
  return guarded([&, function = __func__] {
    require_given(model, function, "model");
    constexpr int kMostSites = 1000000;
    require(sites >= 0 && sites <= kMostSites,
            "vc_model_state_size: sites = " + std::to_string(sites) + " must be 0 to 1000000");
    const int row = row_size(model);
    return row > 0 ? kStateHead + sites * row : 0;
  });
}

int vc_model_states(const vc_model* model, char* text, int capacity) {
  return guarded([&, function = __func__] {
    require_given(model, function, "model");
    std::string table;
    int at = kSiteHead;
    for (const StateField& state : states_of(model)) {
      table += std::string(state.name) + "\t" + state.unit + "\t" + std::to_string(at) + "\t" +
               std::to_string(state.size()) + "\n";
      at += state.size();
    }
    return copy_text(table, text, capacity);
  });
}

void vc_model_free(vc_model* model) { delete model; }

}  // extern "C"
