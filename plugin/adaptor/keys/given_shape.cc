// SPDX-License-Identifier: Apache-2.0
#include "adaptor/keys/given_shape.h"

#include <algorithm>

#include "adaptor/mujoco/mjgeoms.h"
#include "volcontact/base/check.h"

namespace volcontact::adaptor {
namespace {

// Shapes by their numbers, in the order of their fields.
using NumberedShapes = TypeList<Frustum, Torus>;
constexpr const char* kHull = ConvexPolytope::kName;
constexpr const char* kRounded = RoundedBox::kName;

template <typename Solid>
Shape shape_of(const SceneKey& key, const std::vector<double>& numbers) {
  require(numbers.size() == Solid::kFields.size(),
          key.text + " takes " + std::to_string(Solid::kFields.size()) + " numbers, " +
              joined(field_names<Solid>()) + " in metres, got " + std::to_string(numbers.size()));
  typename Solid::Params params;
  for (std::size_t i = 0; i < numbers.size(); ++i) Solid::kFields[i].set(params, 0, numbers[i]);
  try {
    const Solid solid(params);
    require(solid.own_metrics().volume > 0.0, "it has no volume");
    return solid;
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(key.text + ": " + error.what());
  }
}

}  // namespace

std::vector<std::string> shape_words() {
  std::vector<std::string> words;
  for_each_type(NumberedShapes{},
                [&](auto tag) { words.emplace_back(decltype(tag)::Type::kName); });
  words.emplace_back(kRounded);
  words.emplace_back(kHull);
  return words;
}

void read_shape(const SceneKey& key, const std::vector<double>& numbers, GivenShape& given) {
  const std::vector<std::string> words = shape_words();
  const std::string& word = key.parts[2];
  if (std::find(words.begin(), words.end(), word) == words.end()) unknown_part(key, 2, words);
  if (key.parts.size() > 3) {
    throw std::invalid_argument(key.text + ": unknown key (did you mean '" + key.stem(3) + "'?)");
  }
  require(given.word.empty() || given.word == word,
          key.text + ": " + given.key + "/" + given.word + " is given already");
  if (word == kHull) {
    ChoiceValues choices;
    read_choice(key, 2, words, numbers, choices);
    given.word = choices.empty() ? "" : word;
    return;
  }
  given.word = word;
  if (word == kRounded) {
    require(numbers.size() == 1, key.text +
                                     " takes 1 number, the radius of the edges in metres, got " +
                                     std::to_string(numbers.size()));
    given.radius = numbers[0];
    return;
  }
  for_each_type(NumberedShapes{}, [&](auto tag) {
    using Solid = typename decltype(tag)::Type;
    if (word == Solid::kName) given.shape = shape_of<Solid>(key, numbers);
  });
}

Shape rounded_box_of(const mjModel* m, int geom, const GivenShape& given) {
  try {
    return RoundedBox({.half_sizes = vec3_at(m->geom_size, geom), .radius = given.radius});
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(given.key + ": geom '" + label(m, mjOBJ_GEOM, geom) +
                                "': " + error.what());
  }
}

void check_stand_in(const mjModel* m, int geom, const GivenShape& given) {
  const std::string name =
      given.key + ": geom '" + label(m, mjOBJ_GEOM, geom) + "' is of type " + type_name(m, geom);
  require(!given.word.empty(), given.key + ": no <numeric> says what it is: " +
                                   joined(shape_words()) + " comes after the name");
  const int type = m->geom_type[geom];
  if (given.word == kRounded) {
    require(type == mjGEOM_BOX, name + "; a box is what edges can be rounded of");
    rounded_box_of(m, geom, given);
    return;
  }
  if (given.word == kHull) {
    require(type == mjGEOM_MESH, name + "; the convex hull of a mesh geom is a " + kHull);
    return;
  }
  const bool primitive = type == mjGEOM_SPHERE || type == mjGEOM_CAPSULE ||
                         type == mjGEOM_ELLIPSOID || type == mjGEOM_CYLINDER || type == mjGEOM_BOX;
  require(primitive, name +
                         ", whose frame is not its author's; let a sphere, capsule, ellipsoid, "
                         "cylinder or box stand where the " +
                         given.word + " is");
}

}  // namespace volcontact::adaptor
