// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "fmu/unit_file.h"

namespace volcontact::fmu {

/// What resources/scene.txt says of a scene unit; the scene itself is scene.mjb beside it.
struct SceneFile : ValueFile {
  struct Key {
    std::string name;
    std::vector<double> numbers;
  };
  struct Pair {
    std::vector<int> a, b;  ///< geoms
  };
  std::string adaptor;  ///< file names of the libraries beside the binary
  std::string mujoco;
  double timestep = 0.0;  ///< of the model [s]
  std::vector<Key> keys;  ///< of the program that made the unit
  std::vector<Pair> pairs;
};

/// Reads scene.txt of a folder. Throws std::invalid_argument naming the file.
SceneFile read_scene(const std::string& folder);

}  // namespace volcontact::fmu
