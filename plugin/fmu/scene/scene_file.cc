// SPDX-License-Identifier: Apache-2.0
#include "fmu/scene/scene_file.h"

namespace volcontact::fmu {
namespace {

constexpr int kMostCount = 1000000;

std::string library_name(TextReader& reader) {
  const std::string name(reader.word("the name of a library"));
  require(name.find_first_of("/\\") == std::string::npos, reader.where() + "a name has no folder");
  return name;
}

std::vector<int> read_geoms(TextReader& reader) {
  std::vector<int> geoms(static_cast<std::size_t>(reader.count("a count of geoms", kMostCount)));
  for (int& geom : geoms) geom = reader.count("a geom", kMostCount);
  return geoms;
}

void read_line(TextReader& reader, std::string_view word, SceneFile& scene) {
  if (word == "adaptor") {
    scene.adaptor = library_name(reader);
  } else if (word == "mujoco") {
    scene.mujoco = library_name(reader);
  } else if (word == "timestep") {
    scene.timestep = reader.number("the timestep");
  } else if (word == "key") {
    SceneFile::Key key{std::string(reader.word("a key")), {}};
    key.numbers.resize(static_cast<std::size_t>(reader.count("a count of numbers", kMostCount)));
    for (double& number : key.numbers) number = reader.number("a number");
    scene.keys.push_back(std::move(key));
  } else if (word == "pair") {
    SceneFile::Pair pair;
    pair.a = read_geoms(reader);
    pair.b = read_geoms(reader);
    scene.pairs.push_back(std::move(pair));
  } else {
    require(false, reader.where() + "'" + std::string(word) + "' is no key");
  }
}

}  // namespace

SceneFile read_scene(const std::string& folder) {
  const std::string path = folder + "/scene.txt", text = content_of(path);
  SceneFile scene;
  try {
    TextReader reader(text);
    require(
        reader.word("volcontact_scene") == "volcontact_scene" && reader.count("1", kMostCount) == 1,
        "this is no scene unit of version 1; export the FMU again with this volcontact");
    while (!reader.at_end()) {
      const std::string word(reader.word("a key"));
      if (!read_value_line(reader, word, scene)) read_line(reader, word, scene);
    }
    require(!scene.adaptor.empty() && !scene.mujoco.empty(), "no libraries are named");
    for (const Group& group : scene.groups) {
      require(group.role >= Role::kCtrl || group.role == Role::kTime,
              "a group of values is not of a scene");
    }
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(path + ": " + error.what());
  }
  return scene;
}

}  // namespace volcontact::fmu
