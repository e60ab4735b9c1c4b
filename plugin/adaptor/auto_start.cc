// SPDX-License-Identifier: Apache-2.0
#include <dlfcn.h>

#include <cstdlib>
#include <cstring>

#include "adaptor/engine_plugin.h"
#include "adaptor/volcontact_mujoco.h"

// In the shared library alone. A program that knows nothing of volcontact, such as MuJoCo's
// `simulate`, gets it by being loaded; plugin/README.md has how.

namespace {

// `simulate` loads every library in the folder mujoco_plugin beside it.
bool lies_in_a_plugin_folder() {
  Dl_info info{};
  return dladdr(reinterpret_cast<const void*>(&volcontact_set_auto), &info) != 0 &&
         info.dli_fname != nullptr && std::strstr(info.dli_fname, "/mujoco_plugin/") != nullptr;
}

__attribute__((constructor)) void start() {
  const char* wish = std::getenv("VOLCONTACT_AUTO");
  const bool is_wanted = wish ? std::strcmp(wish, "1") == 0 : lies_in_a_plugin_folder();
  if (is_wanted) volcontact_set_auto(1);
  volcontact::adaptor::register_engine_plugin();
}

}  // namespace
