# SPDX-License-Identifier: Apache-2.0

# volcontact_add_law(<target> <header> <class>)
#
# Adds a force law of your own to a program or library that links volcontact::core or
# volcontact::adaptor: MJCF keys, make_normal() and make_friction() then know it by its name. The
# class derives from OwnNormalLaw or OwnFrictionLaw; docs/own_laws.md.
function(volcontact_add_law target header class)
  cmake_path(ABSOLUTE_PATH header NORMALIZE)
  string(MAKE_C_IDENTIFIER "${target}_${class}" name)
  set(source "${CMAKE_CURRENT_BINARY_DIR}/volcontact_laws/${name}.cc")
  file(CONFIGURE OUTPUT "${source}" CONTENT "// Made by volcontact_add_law().
#include \"${header}\"
#include \"volcontact/force/laws.h\"

namespace {
[[maybe_unused]] const bool is_added = volcontact::add_law<${class}>();
}
")
  target_sources(${target} PRIVATE "${source}")
endfunction()

# volcontact_add_laws(<target> <header>:<class>...)
function(volcontact_add_laws target)
  foreach(law IN LISTS ARGN)
    if(NOT law MATCHES "^(.+[^:]):([A-Za-z_].*)$")
      message(FATAL_ERROR "VOLCONTACT_LAWS: '${law}' is not <header>:<class>")
    endif()
    volcontact_add_law(${target} "${CMAKE_MATCH_1}" "${CMAKE_MATCH_2}")
  endforeach()
endfunction()
