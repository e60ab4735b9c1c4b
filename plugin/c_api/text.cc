// SPDX-License-Identifier: Apache-2.0
// Solids and models as text. docs/c_container.md, "A model as text".
#include "c_api/guarded.h"
#include "c_api/model.h"
#include "volcontact/model/model_text.h"
#include "volcontact/shape/shape_text.h"

using namespace volcontact;
using namespace volcontact::c_api;

namespace {

NamedSolid named(Shape shape) {
  NamedSolid solid{std::move(shape), {}};
  solid.values = std::visit(
      [](const auto& made) -> FieldValues {
        using S = std::decay_t<decltype(made)>;
        if constexpr (std::is_same_v<S, HalfSpace> || !requires { S::kFields; }) {
          return {};
        } else {
          return values_of<S>(made.params());
        }
      },
      solid.shape);
  return solid;
}

NamedSide read_side(TextReader& reader) {
  require(reader.word("at") == "at", reader.where() + "'at' and 16 numbers are wanted");
  const Pose X = read_pose(reader);
  require(reader.word("solid") == "solid", reader.where() + "'solid' is wanted");
  return {named(read_shape(reader)), X};
}

ModelValues read_values(TextReader& reader) {
  constexpr int kMostNumbers = 16;
  ModelValues values;
  while (!reader.at_end()) {
    const std::string word(reader.word("choose, set or pair"));
    if (word == "choose") {
      const std::string name(reader.word("a name"));
      values.choose(name, reader.word("a word"));
    } else if (word == "set") {
      const std::string name(reader.word("a name"));
      std::vector<double> numbers;
      const int count = reader.count("the count of numbers", kMostNumbers);
      for (int i = 0; i < count; ++i) numbers.push_back(reader.number("a number"));
      values.set(name, numbers.data(), count);
    } else {
      require(word == "pair", reader.where() + "'" + word + "' is not choose, set or pair");
      NamedSide a = read_side(reader);
      values.add_pair(std::move(a), read_side(reader));
    }
  }
  return values;
}

}  // namespace

extern "C" {

int vc_solid_create_text(const char* text, vc_solid** solid) {
  return guarded([&, function = __func__] {
    require_given(text, function, "text");
    require_given(solid, function, "solid");
    TextReader reader(text);
    NamedSolid made = named(read_shape(reader));
    require(reader.at_end(), reader.where() + "more text than one solid");
    *solid = new vc_solid{std::move(made)};
    return 0;
  });
}

int vc_solid_text(const vc_solid* solid, char* text, int capacity) {
  return guarded([&, function = __func__] {
    require_given(solid, function, "solid");
    return copy_text(text_of(solid->named.shape), text, capacity);
  });
}

int vc_model_create_text(const char* text, vc_model** model) {
  return guarded([&, function = __func__] {
    require_given(text, function, "text");
    require_given(model, function, "model");
    TextReader reader(text);
    auto made = std::make_unique<vc_model>();
    made->values = read_values(reader);
    made->values.laws();  // checks them, also where there is no pair
    if (made->values.pair_count() > 0) made->contact.emplace(made->values.model());
    *model = made.release();
    return 0;
  });
}

int vc_model_text(const vc_model* model, char* text, int capacity) {
  return guarded([&, function = __func__] {
    require_given(model, function, "model");
    require(model->contact.has_value(),
            "vc_model_text: the model has no pairs; add one with vc_model_add_pair");
    return copy_text(text_of(*model->contact), text, capacity);
  });
}

}  // extern "C"
