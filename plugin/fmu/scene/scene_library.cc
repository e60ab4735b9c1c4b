// SPDX-License-Identifier: Apache-2.0
#include "fmu/scene/scene_library.h"

#include "volcontact/base/check.h"

#if !defined(_WIN32)
#include <dlfcn.h>
#endif

namespace volcontact::fmu {

#if defined(_WIN32)

const SceneRunFunctions& load_scene_library(const std::string&, const std::string&) {
  throw std::invalid_argument("units of whole scenes run on Linux");
}

#else

namespace {

// Other copies of MuJoCo may be global in the process, as Python's is: own functions come first.
#if defined(RTLD_DEEPBIND)
constexpr int kOwnFirst = RTLD_DEEPBIND;
#else
constexpr int kOwnFirst = 0;
#endif

std::string own_folder() {
  Dl_info about{};
  const bool found = dladdr(reinterpret_cast<const void*>(&load_scene_library), &about) != 0 &&
                     about.dli_fname != nullptr;
  require(found, "the folder of the binary is unknown");
  const std::string path(about.dli_fname);
  return path.substr(0, path.rfind('/') + 1);
}

// Threads of OpenMP and callbacks live in it: it is never unloaded. A library of that very name is
// the same one, since the name tells the content.
void* open(const std::string& name) {
  constexpr int kHow = RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE | kOwnFirst;
  if (void* present = dlopen(name.c_str(), kHow | RTLD_NOLOAD)) return present;
  void* library = dlopen((own_folder() + name).c_str(), kHow);
  if (!library) {
    const char* reason = dlerror();
    throw std::invalid_argument(std::string("cannot load ") + name +
                                " of the FMU: " + (reason ? reason : "no reason is given"));
  }
  return library;
}

}  // namespace

const SceneRunFunctions& load_scene_library(const std::string& adaptor, const std::string& mujoco) {
  open(mujoco);  // the adaptor asks for it by name
  const auto entry = reinterpret_cast<SceneRunEntry>(dlsym(open(adaptor), kSceneRunSymbol));
  const SceneRunFunctions* functions = entry ? entry(SceneRunFunctions::kVersion) : nullptr;
  require(functions != nullptr, adaptor + " is no library of this unit; export the FMU again");
  return *functions;
}

#endif

}  // namespace volcontact::fmu
