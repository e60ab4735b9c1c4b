// SPDX-License-Identifier: Apache-2.0
#include "adaptor/keys/scene_keys.h"

#include <algorithm>
#include <string_view>

#include "adaptor/keys/scene_key.h"
#include "adaptor/mujoco/mjgeoms.h"
#include "volcontact/base/check.h"

namespace volcontact::adaptor {
namespace {

const std::vector<std::string> kSections{"material", "option", "pair", "shape", "solid"};

using Key = SceneKey;

class KeyReader {
 public:
  KeyReader(const mjModel* m, const std::vector<GivenKey>& given) : m_(m) {
    keys_.given = given;
    keys_.material_of_geom.assign(static_cast<std::size_t>(m->ngeom), -1);
    keys_.shape_of_geom.assign(static_cast<std::size_t>(m->ngeom), -1);
    keys_.solid_of_geom.assign(static_cast<std::size_t>(m->ngeom), -1);
  }

  SceneKeys read() {
    refuse_texts();
    for (const int stage : {0, 1, 2}) {
      for (int i = 0; i < m_->ntuple; ++i) {
        const auto key = parse_key(m_->names + m_->name_tupleadr[i]);
        if (key && stage_of(key->parts[0]) == stage) read_tuple(*key, i);
      }
    }
    for (int i = 0; i < m_->nnumeric; ++i) {
      if (const auto key = parse_key(m_->names + m_->name_numericadr[i])) read_numeric(*key, i);
    }
    reads_given_ = true;
    for (const GivenKey& given : keys_.given) read_given(given);
    keys_.options = options_.finish();
    keys_.has_target = options_.has("target");
    for (int geom = 0; geom < m_->ngeom; ++geom) {
      if (const GivenShape* shape = keys_.given_shape(geom)) check_stand_in(m_, geom, *shape);
    }
    for (const KeyedValues& material : keys_.materials) check_fields(material);
    for (const ListedPair& pair : keys_.pairs) check_fields(pair.keyed);
    return std::move(keys_);
  }

 private:
  void refuse_texts() const {
    for (int i = 0; i < m_->ntext; ++i) {
      const std::string name = m_->names + m_->name_textadr[i];
      require(!parse_key(name), name + ": is a <text>; volcontact reads <numeric> and <tuple>");
    }
  }

  // Tuples: which geoms a material or a pair is about.

  // Solids are made of shapes, and pairs are about solids.
  static int stage_of(const std::string& section) {
    return section == "shape" ? 0 : section == "solid" ? 1 : 2;
  }

  void read_tuple(const Key& key, int tuple) {
    const std::vector<std::string> sections{"material", "pair", "shape", "solid"};
    const std::string& section = key.parts[0];
    if (std::find(sections.begin(), sections.end(), section) == sections.end()) {
      unknown_part(key, 0, sections);
    }
    require(
        key.parts.size() == 2 && !key.parts[1].empty(),
        key.text + ": a tuple is named " + key.prefix + std::string(kRoot) + section + "/<name>");
    if (section == "material") {
      read_material(key, tuple);
    } else if (section == "pair") {
      read_pair(key, tuple);
    } else if (section == "shape") {
      read_stand_ins(key, tuple);
    } else {
      read_solid(key, tuple);
    }
  }

  // "volcontact/solid/bore: geom 'hole'", for messages.
  std::string part_text(const Key& key, int geom) const {
    return key.text + ": geom '" + label(m_, mjOBJ_GEOM, geom) + "'";
  }

  // The one geom of an element.
  int geom_of_element(const Key& key, int tuple, int element, const char* rule) const {
    const int at = m_->tuple_adr[tuple] + element, type = m_->tuple_objtype[at];
    require(type == mjOBJ_GEOM, key.text + ": element " + std::to_string(element + 1) + " is a " +
                                    mju_type2Str(type) + "; " + rule);
    return m_->tuple_objid[at];
  }

  void read_stand_ins(const Key& key, int tuple) {
    for (int element = 0; element < m_->tuple_size[tuple]; ++element) {
      const int geom = geom_of_element(key, tuple, element, "a shape lists its geoms one by one");
      int& owner = keys_.shape_of_geom[static_cast<std::size_t>(geom)];
      require(owner < 0, part_text(key, geom) + " is listed already; a geom has one shape");
      owner = static_cast<int>(keys_.shapes.size());
    }
    keys_.shapes.push_back({key.text, {}, {}});
  }

  static Csg::Operation operation_of(const std::string& part, double sign) {
    if (sign == 1.0) return Csg::Operation::kUnion;
    if (sign == -1.0) return Csg::Operation::kDifference;
    require(sign == 2.0, part + " has prm=\"" + number_text(sign) +
                             "\"; write prm=\"1\" to add it, prm=\"-1\" to cut it out or "
                             "prm=\"2\" to keep only what lies in it");
    return Csg::Operation::kIntersection;
  }

  void read_solid(const Key& key, int tuple) {
    const int index = static_cast<int>(keys_.solids.size());
    ComposedGeoms solid{key.text, {}};
    for (int element = 0; element < m_->tuple_size[tuple]; ++element) {
      const int geom = geom_of_element(key, tuple, element, "a solid lists its geoms one by one");
      const Csg::Operation operation =
          operation_of(part_text(key, geom), m_->tuple_objprm[m_->tuple_adr[tuple] + element]);
      check_part(key, geom);
      int& owner = keys_.solid_of_geom[static_cast<std::size_t>(geom)];
      require(owner < 0, part_text(key, geom) + " is listed already, in " +
                             (owner < 0       ? ""
                              : owner < index ? keys_.solids[static_cast<std::size_t>(owner)].key
                                              : key.text) +
                             "; a geom belongs to one solid, once");
      owner = index;
      solid.parts.push_back({geom, operation});
    }
    const ComposedGeoms::Part first = solid.parts[0];
    require(first.operation == Csg::Operation::kUnion,
            part_text(key, first.geom) +
                " is the first one and has not prm=\"1\": there is nothing "
                "yet to cut; begin with a geom that has prm=\"1\"");
    for (const ComposedGeoms::Part& part : solid.parts) {
      const int own = m_->geom_bodyid[part.geom], body = m_->geom_bodyid[first.geom];
      require(own == body,
              part_text(key, part.geom) + " is on body '" + label(m_, mjOBJ_BODY, own) + "' and '" +
                  label(m_, mjOBJ_GEOM, first.geom) + "' on body '" + label(m_, mjOBJ_BODY, body) +
                  "'; the geoms of a solid must be on one body: move it there");
    }
    keys_.solids.push_back(std::move(solid));
  }

  void check_part(const Key& key, int geom) const {
    const int type = m_->geom_type[geom];
    if (keys_.given_shape(geom)) return;
    require(type != mjGEOM_PLANE,
            part_text(key, geom) + " is a plane; cut with a box that is large enough instead");
    const bool simple = type == mjGEOM_SPHERE || type == mjGEOM_CAPSULE ||
                        type == mjGEOM_ELLIPSOID || type == mjGEOM_CYLINDER || type == mjGEOM_BOX;
    require(simple, part_text(key, geom) + " is of type " + type_name(m_, geom) +
                        "; a solid is made of spheres, ellipsoids, capsules, cylinders, boxes and "
                        "what a volcontact/shape/... says");
  }

  std::vector<int> geoms_of_element(const Key& key, int tuple, int element) const {
    const int at = m_->tuple_adr[tuple] + element;
    const int type = m_->tuple_objtype[at], id = m_->tuple_objid[at];
    if (type == mjOBJ_GEOM) return {id};
    require(type == mjOBJ_BODY || type == mjOBJ_XBODY,
            key.text + ": element " + std::to_string(element + 1) + " is a " + mju_type2Str(type) +
                "; a tuple takes geoms and bodies only");
    std::vector<int> geoms;
    for (int i = 0; i < m_->body_geomnum[id]; ++i) geoms.push_back(m_->body_geomadr[id] + i);
    require(!geoms.empty(), key.text + ": body '" + label(m_, mjOBJ_BODY, id) + "' has no geoms");
    return geoms;
  }

  void read_material(const Key& key, int tuple) {
    const int index = static_cast<int>(keys_.materials.size());
    keys_.materials.push_back({key.text, {}, {}});
    for (int element = 0; element < m_->tuple_size[tuple]; ++element) {
      for (const int geom : geoms_of_element(key, tuple, element)) {
        int& owner = keys_.material_of_geom[static_cast<std::size_t>(geom)];
        require(owner < 0,
                key.text + ": geom '" + label(m_, mjOBJ_GEOM, geom) + "' is listed already, in " +
                    (owner < 0 ? "" : keys_.materials[static_cast<std::size_t>(owner)].key) +
                    "; a geom has one material");
        owner = index;
      }
    }
  }

  void read_pair(const Key& key, int tuple) {
    require(m_->tuple_size[tuple] == 2, key.text +
                                            ": a pair lists exactly 2 geoms or bodies, got " +
                                            std::to_string(m_->tuple_size[tuple]));
    const int index = static_cast<int>(keys_.pairs.size());
    keys_.pairs.push_back({{key.text, {}, {}}, {}});
    for (const int a : solids_of_element(key, tuple, 0)) {
      for (const int b : solids_of_element(key, tuple, 1)) add_geom_pair(key, index, a, b);
    }
    require(!keys_.pairs.back().geoms.empty(),
            key.text + ": the two are parts of one rigid body and cannot touch each other");
  }

  // The geoms of an element that are solids or name one.
  std::vector<int> solids_of_element(const Key& key, int tuple, int element) const {
    std::vector<int> geoms = geoms_of_element(key, tuple, element);
    if (geoms.size() == 1 && !keys_.is_solid(geoms[0])) {
      const ComposedGeoms& solid = *keys_.composed(geoms[0]);
      throw std::invalid_argument(part_text(key, geoms[0]) + " is a part of " + solid.key +
                                  ", which is named by its first geom; list '" +
                                  label(m_, mjOBJ_GEOM, solid.parts[0].geom) + "'");
    }
    std::erase_if(geoms, [this](int geom) { return !keys_.is_solid(geom); });
    return geoms;
  }

  void add_geom_pair(const Key& key, int index, int a, int b) {
    if (m_->body_weldid[m_->geom_bodyid[a]] == m_->body_weldid[m_->geom_bodyid[b]]) return;
    require(m_->geom_type[a] != mjGEOM_PLANE || m_->geom_type[b] != mjGEOM_PLANE,
            key.text + ": two planes cannot be a pair");
    const std::pair<int, int> geoms = std::minmax(a, b);
    const auto [entry, is_new] = keys_.pair_of_geoms.emplace(geoms, index);
    require(is_new, key.text + ": geoms '" + label(m_, mjOBJ_GEOM, a) + "' and '" +
                        label(m_, mjOBJ_GEOM, b) + "' are listed already, in " +
                        keys_.pairs[static_cast<std::size_t>(entry->second)].keyed.key);
    keys_.pairs[static_cast<std::size_t>(index)].geoms.push_back(geoms);
  }

  // Numerics: fields, choices and options.

  void read_numeric(const Key& key, int numeric) {
    keys_.numerics.push_back({m_->numeric_adr[numeric], m_->numeric_size[numeric]});
    const mjtNum* data = m_->numeric_data + m_->numeric_adr[numeric];
    read_numbers(key, {data, data + m_->numeric_size[numeric]});
  }

  // What the program gives beside the file.
  void read_given(const GivenKey& given) {
    const auto key = parse_key(given.name);
    require(key.has_value(),
            given.name + ": unknown key; it must begin with " + std::string(kRoot));
    if (key->parts[0] == "material" && key->parts.size() > 2) add_default_material(key->stem(2));
    read_numbers(*key, given.numbers);
  }

  // A material that no tuple names is that of all geoms without one.
  void add_default_material(const std::string& stem) {
    const auto is_it = [&](const KeyedValues& material) { return material.key == stem; };
    if (std::any_of(keys_.materials.begin(), keys_.materials.end(), is_it)) return;
    require(default_material_.empty(), stem + ": no <tuple> says which geoms it is for, and " +
                                           default_material_ +
                                           " is that of all geoms without a material already");
    default_material_ = stem;
    std::replace(keys_.material_of_geom.begin(), keys_.material_of_geom.end(), -1,
                 static_cast<int>(keys_.materials.size()));
    keys_.materials.push_back({stem, {}, {}});
  }

  void read_numbers(const Key& key, const std::vector<double>& numbers) {
    if (key.parts[0] == "option") {
      options_.read(key, numbers, reads_given_);
    } else if (key.parts[0] == "material" || key.parts[0] == "pair") {
      read_keyed(key, numbers);
    } else if (key.parts[0] == "shape") {
      read_shape_of(key, numbers);
    } else {
      require(key.parts[0] != "solid",
              key.text +
                  ": a solid has no numbers; its geoms are listed in a <tuple>, with prm=\"1\", "
                  "\"-1\" or \"2\"");
      unknown_part(key, 0, kSections);
    }
  }

  void read_shape_of(const Key& key, const std::vector<double>& numbers) {
    if (key.parts.size() < 3) unknown_part(key, 2, shape_words());
    std::vector<std::string> names;
    for (GivenShape& shape : keys_.shapes) {
      if (shape.key == key.stem(2)) return read_shape(key, numbers, shape);
      names.push_back(shape.key);
    }
    no_tuple(key, names);
  }

  [[noreturn]] static void no_tuple(const Key& key, const std::vector<std::string>& names) {
    throw std::invalid_argument(key.text + ": there is no <tuple name=\"" + key.stem(2) +
                                "\"> that says which geoms it is for" +
                                did_you_mean(key.stem(2), names));
  }

  KeyedValues& owner_of(const Key& key) {
    const std::string stem = key.stem(2);
    std::vector<std::string> names;
    for (KeyedValues& material : keys_.materials) {
      if (material.key == stem) return material;
      names.push_back(material.key);
    }
    for (ListedPair& pair : keys_.pairs) {
      if (pair.keyed.key == stem) return pair.keyed;
      names.push_back(pair.keyed.key);
    }
    no_tuple(key, names);
  }

  void read_keyed(const Key& key, const std::vector<double>& numbers) {
    if (key.parts.size() < 3) unknown_part(key, 2, words_after_name());
    const std::string& word = key.parts[2];
    const FieldRow* field = field_of_any_law(word);
    const ChoiceRow* choice = find_choice(word);
    if (!field && !choice) unknown_part(key, 2, words_after_name());
    KeyedValues& owner = owner_of(key);
    if (choice) {
      if (reads_given_) owner.choices.erase(word);
      read_choice(key, 3, choice->words, numbers, owner.choices);
      return;
    }
    if (key.parts.size() > 3) {
      throw std::invalid_argument(key.text + ": unknown key (did you mean '" + key.stem(3) + "'?)");
    }
    check_count(key, field->defaults.size(), numbers);
    for (const double number : numbers) {
      require(field->range.contains(number),
              out_of_range_message(key.stem(2), field->name, field->unit, number, field->range));
    }
    owner.values[word] = numbers;
  }

  static const ChoiceRow* find_choice(const std::string& name) {
    for (const ChoiceRow& choice : all_choices()) {
      if (choice.name == name) return &choice;
    }
    return nullptr;
  }

  static std::vector<std::string> words_after_name() {
    std::vector<std::string> words = all_field_names();
    for (const ChoiceRow& choice : all_choices()) words.push_back(choice.name);
    return words;
  }

  // A material that names its law may only give that law's fields.
  static void check_fields(const KeyedValues& keyed) {
    const auto normal = keyed.choices.find(kNormalLaw), friction = keyed.choices.find(kFrictionLaw);
    for (const auto& [name, value] : keyed.values) {
      for (const auto& [choice, laws] :
           {std::pair{normal, &normal_laws()}, std::pair{friction, &friction_laws()}}) {
        if (choice == keyed.choices.end()) continue;
        const LawRow& law = law_called(*laws, choice->second);
        const bool of_this_kind =
            std::any_of(laws->begin(), laws->end(),
                        [&, &field = name](const LawRow& other) { return other.field(field); });
        std::vector<std::string> fields;
        for (const FieldRow& field : law.fields) fields.push_back(field.name);
        require(!of_this_kind || law.field(name), keyed.key + "/" + name + ": " + law.name +
                                                      " has no such field; it has " +
                                                      joined(fields));
      }
    }
  }

  const mjModel* m_;
  SceneKeys keys_;
  bool reads_given_ = false;
  std::string default_material_;  // given by the program
  OptionReader options_;
};

}  // namespace

SceneKeys read_scene_keys(const mjModel* m, const std::vector<GivenKey>& given) {
  return KeyReader(m, given).read();
}

bool has_scene_keys(const mjModel* m) noexcept {
  const auto is_ours = [m](int address) {  // a prefix may come before it
    return std::string_view(m->names + address).find(kRoot) != std::string_view::npos;
  };
  return std::any_of(m->name_numericadr, m->name_numericadr + m->nnumeric, is_ours) ||
         std::any_of(m->name_tupleadr, m->name_tupleadr + m->ntuple, is_ours);
}

}  // namespace volcontact::adaptor
