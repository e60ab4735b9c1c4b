// SPDX-License-Identifier: Apache-2.0
#include "adaptor/readings/description.h"

#include <cstdio>

#include "adaptor/readings/json_text.h"
#include "adaptor/scene/pair_rates.h"

namespace volcontact::adaptor {
namespace {

// "c1_rubber" for "c1_volcontact/material/rubber".
std::string short_name(const KeyedValues& material) {
  const std::string middle = "volcontact/material/";
  const std::size_t at = material.key.find(middle);
  return material.key.substr(0, at) + material.key.substr(at + middle.size());
}

std::string material_of(const SceneKeys& keys, int geom) {
  const int index = keys.material_of_geom[static_cast<std::size_t>(geom)];
  return index < 0 ? "default" : short_name(keys.materials[static_cast<std::size_t>(index)]);
}

void write_options(const SceneOptions& options, JsonText& json) {
  json.name("options").begin_object();
  json.member("tolerance", options.tolerance);
  json.member("engine", to_string(options.engine));
  json.member("target", kTargetWords[static_cast<int>(options.target)]);
  json.member("pairs", kPairRuleWords[static_cast<int>(options.pairs)]);
  json.member("mesh", kMeshFormWords[static_cast<int>(options.mesh)]);
  json.member("formulation", kFormulationWords[static_cast<int>(options.formulation)]);
  json.member("implicit", kImplicitWords[static_cast<int>(options.implicit)]);
  json.member("disabled", kDisabledWords[static_cast<int>(options.disabled)]);
  json.member("threads", options.threads);
  json.member("exit_speed", options.exit_speed);
  json.end_object();
}

void write_values(const KeyedValues& keyed, JsonText& json) {
  for (const auto& [name, numbers] : keyed.values) json.member(name, numbers);
  for (const auto& [name, word] : keyed.choices) json.member(name, word);
}

// The default material's values, except the friction, which is the geom's own.
void write_default_material(JsonText& json) {
  json.name("default").begin_object();
  json.member("key", "default");
  for (const auto* laws : {&normal_laws(), &friction_laws()}) {
    for (const FieldRow& field : laws->front().fields) {
      const std::vector<double> value = default_value(field, -1.0);
      if (value[0] == -1.0) {
        json.member(field.name, "the geom's own");
      } else {
        json.member(field.name, value);
      }
    }
  }
  json.member(kNormalLaw, normal_laws().front().name);
  json.member(kFrictionLaw, friction_laws().front().name);
}

void write_materials(const mjModel* m, const SceneContact& contact, JsonText& json) {
  const SceneKeys& keys = contact.keys();
  const auto write_geoms = [&](int material, bool all) {
    json.name("geoms").begin_array();
    for (int geom = 0; geom < m->ngeom; ++geom) {
      const bool has_it = keys.material_of_geom[static_cast<std::size_t>(geom)] == material;
      if (has_it && (all || contact.rules().can_touch(geom)))
        json.value(label(m, mjOBJ_GEOM, geom));
    }
    json.end_array();
  };
  json.name("materials").begin_object();
  for (std::size_t i = 0; i < keys.materials.size(); ++i) {
    const KeyedValues& material = keys.materials[i];
    json.name(short_name(material)).begin_object();
    json.member("key", material.key);
    write_values(material, json);
    write_geoms(static_cast<int>(i), true);
    json.end_object();
  }
  write_default_material(json);
  write_geoms(-1, false);
  json.end_object().end_object();
}

std::string sign_of(Csg::Operation operation) {
  switch (operation) {
    case Csg::Operation::kUnion:
      return "+ ";
    case Csg::Operation::kIntersection:
      return "& ";
    case Csg::Operation::kDifference:
      break;
  }
  return "- ";
}

void write_parts(const mjModel* m, const ComposedGeoms& solid, JsonText& json) {
  json.member("key", solid.key);
  json.name("parts").begin_array();
  for (const ComposedGeoms::Part& part : solid.parts) {
    json.value(sign_of(part.operation) + label(m, mjOBJ_GEOM, part.geom));
  }
  json.end_array();
}

void write_solids(const mjModel* m, const SceneContact& contact, JsonText& json) {
  json.name("solids").begin_array();
  for (const int geom : contact.rules().touching()) {
    const Shape& solid = contact.solids()[static_cast<std::size_t>(geom)];
    json.begin_object();
    json.member("geom", label(m, mjOBJ_GEOM, geom));
    json.member("id", geom);
    json.member("body", label(m, mjOBJ_BODY, m->geom_bodyid[geom]));
    json.member("shape", name_of(solid));
    if (const ComposedGeoms* parts = contact.keys().composed(geom)) write_parts(m, *parts, json);
    json.member("material", material_of(contact.keys(), geom));
    json.member("volume", own_metrics_of(solid).volume);
    json.end_object();
  }
  json.end_array();
}

// Those that some solid can touch together.
void write_flush_solids(const mjModel* m, const SceneContact& contact, JsonText& json) {
  json.name("flush_solids").begin_array();
  for (const std::vector<int>& group : contact.flush().groups()) {
    if (!contact.flush().can_touch_together(group)) continue;
    json.begin_object();
    json.name("geoms").begin_array();
    for (const int geom : group) json.value(label(m, mjOBJ_GEOM, geom));
    json.end_array().end_object();
  }
  json.end_array();
}

// Whether steps are implicit in the contact of the pair, in words.
std::string implicit_text(const mjModel* m, const SceneContact& contact, const PairContact& pair) {
  if (contact.options().implicit == Implicit::kNever) return "off";
  if (contact.options().implicit == Implicit::kAlways) return "on";
  const ImplicitUse use = implicit_use(m, pair);
  if (use.by_friction) return "always, for its friction";
  const Friction* friction = pair.model.laws().friction.get();
  if (!use.is_possible) {
    if (pair.friction_follows_patch) return "where friction would stop the sliding within a step";
    const bool reverses = friction && friction->states().empty();
    return reverses ? "where friction would reverse the sliding within a step" : "not needed";
  }
  char text[64];
  std::snprintf(text, sizeof text, "where a patch is larger than %.2g m^2", use.least_area);
  return text;
}

void write_pair(const mjModel* m, const SceneContact& contact, const GeomPair& geoms,
                JsonText& json) {
  const PairContact pair = contact.make_pair(geoms);
  const PairLaws laws = contact.laws().in_words(m, geoms);
  json.begin_object();
  json.member("pair", contact.rules().id(geoms.a, geoms.b));
  json.member("geom_a", label(m, mjOBJ_GEOM, pair.geoms.a));
  json.member("geom_b", label(m, mjOBJ_GEOM, pair.geoms.b));
  json.member("id_a", pair.geoms.a);
  json.member("id_b", pair.geoms.b);
  json.member("because", kPairOriginWords[static_cast<int>(pair.geoms.origin)]);
  json.member("engine", to_string(pair.engine));
  json.member("implicit", implicit_text(m, contact, pair));
  json.member("explicit_step", implicit_use(m, pair).explicit_step);
  json.member("normal_law", laws.normal_law);
  json.member("friction_law", laws.friction_law);
  json.member("rolling", laws.laws.rolling ? "on" : kOff);
  for (const auto& [choice, word] : laws.choices) json.member(choice, word);
  for (const PairField& field : laws.fields) json.member(field.name, field.value);
  json.name("sources").begin_object();
  for (const PairField& field : laws.fields) json.member(field.name, field.source);
  json.end_object().end_object();
}

}  // namespace

std::string describe(const mjModel* m, const SceneContact& contact) {
  JsonText json;
  json.begin_object();
  json.member("mujoco_version", version_text(mjVERSION_HEADER));
  write_options(contact.options(), json);
  json.name("userdata").begin_object();
  json.member("needed", contact.layout(m).size());
  json.member("present", static_cast<int>(m->nuserdata));
  json.member("state", contact.is_in_plugin() ? "in plugin_state"
                       : contact.is_beside()  ? "beside mjData"
                                              : "in userdata");
  json.end_object();
  write_materials(m, contact, json);
  write_solids(m, contact, json);
  write_flush_solids(m, contact, json);
  json.name("pairs").begin_array();
  contact.rules().for_each([&](const GeomPair& geoms) {
    write_pair(m, contact, geoms, json);
    return true;
  });
  json.end_array();
  json.name("warnings").begin_array();
  for (const std::string& warning : contact.warnings()) json.value(warning);
  json.end_array();
  json.end_object();
  return json.text();
}

}  // namespace volcontact::adaptor
