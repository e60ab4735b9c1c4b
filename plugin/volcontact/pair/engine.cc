// SPDX-License-Identifier: Apache-2.0
#include "volcontact/pair/engine.h"

#include <string>
#include <vector>

#include "volcontact/base/check.h"
#include "volcontact/base/spelling.h"

namespace volcontact {

const char* to_string(Engine engine) {
  switch (engine) {
    case Engine::kAuto:
      return "auto";
    case Engine::kClosedForm:
      return "closed_form";
    case Engine::kClip:
      return "clip";
    case Engine::kLines:
      return "lines";
    case Engine::kSurfaceSweep:
      return "surface_sweep";
    case Engine::kColumns:
      return "columns";
    case Engine::kOctree:
      return "octree";
  }
  return "unknown";
}

Engine engine_from(std::string_view name) {
  std::vector<std::string> names;
  std::string listed;
  for (Engine engine : kEngines) {
    if (name == to_string(engine)) return engine;
    names.emplace_back(to_string(engine));
    listed += (listed.empty() ? "" : ", ") + names.back();
  }
  require(false, "unknown engine '" + std::string(name) + "', must be one of " + listed +
                     did_you_mean(name, names));
  return Engine::kAuto;
}

}  // namespace volcontact
