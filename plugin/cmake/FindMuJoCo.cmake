# SPDX-License-Identifier: Apache-2.0
#
# Finds the one MuJoCo in MUJOCO_DIR, and never another: every release has another struct layout, so
# headers that do not belong to the library that will run corrupt memory without a word.
#
# MUJOCO_DIR is the folder of the installed `mujoco` Python package, or a prefix such as /usr.
# Result: target MuJoCo::MuJoCo and MUJOCO_VERSION, such as 2.2.2.

if(NOT MUJOCO_DIR)
  message(FATAL_ERROR "MUJOCO_DIR is empty. Set it to the installed `mujoco` Python package folder.")
endif()

# Searched anew each time: a cached hit in an earlier MUJOCO_DIR would mix two releases.
unset(MuJoCo_INCLUDE_DIR CACHE)
find_path(MuJoCo_INCLUDE_DIR mujoco/mujoco.h PATHS "${MUJOCO_DIR}/include" NO_DEFAULT_PATH)

# No release ships a plain libmujoco.so in its wheel; the version is part of the file name.
file(GLOB MuJoCo_LIBRARY
  "${MUJOCO_DIR}/libmujoco.so.*.*.*"
  "${MUJOCO_DIR}/lib/libmujoco.so.*.*.*"
  "${MUJOCO_DIR}/lib/${CMAKE_LIBRARY_ARCHITECTURE}/libmujoco.so.*.*.*")
list(LENGTH MuJoCo_LIBRARY library_count)
if(NOT library_count EQUAL 1)
  message(FATAL_ERROR
    "Expected exactly one libmujoco.so.X.Y.Z in ${MUJOCO_DIR}, found: '${MuJoCo_LIBRARY}'.")
endif()
string(REGEX REPLACE "^.*libmujoco\\.so\\." "" MUJOCO_VERSION "${MuJoCo_LIBRARY}")

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(MuJoCo
  REQUIRED_VARS MuJoCo_LIBRARY MuJoCo_INCLUDE_DIR VERSION_VAR MUJOCO_VERSION
  REASON_FAILURE_MESSAGE "No include/mujoco/mujoco.h in MUJOCO_DIR = ${MUJOCO_DIR}.")

# mjVERSION_HEADER is 222 for 2.2.2 and 3006000 for 3.6.0.
file(STRINGS "${MuJoCo_INCLUDE_DIR}/mujoco/mujoco.h" version_line
  REGEX "^#define +mjVERSION_HEADER +[0-9]+")
string(REGEX MATCH "[0-9]+$" header_number "${version_line}")
if(header_number GREATER_EQUAL 1000000)
  math(EXPR major "${header_number} / 1000000")
  math(EXPR minor "${header_number} / 1000 % 1000")
  math(EXPR patch "${header_number} % 1000")
  set(header_version "${major}.${minor}.${patch}")
else()
  string(REGEX REPLACE "^(.)(.)(.+)$" "\\1.\\2.\\3" header_version "${header_number}")
endif()
if(NOT header_version VERSION_EQUAL MUJOCO_VERSION)
  message(FATAL_ERROR "${MuJoCo_INCLUDE_DIR}/mujoco/mujoco.h is of MuJoCo ${header_version}, "
    "but ${MuJoCo_LIBRARY} is ${MUJOCO_VERSION}.")
endif()

if(NOT TARGET MuJoCo::MuJoCo)
  add_library(MuJoCo::MuJoCo SHARED IMPORTED)
  set_target_properties(MuJoCo::MuJoCo PROPERTIES
    IMPORTED_LOCATION "${MuJoCo_LIBRARY}"
    IMPORTED_SONAME "libmujoco.so.${MUJOCO_VERSION}"
    INTERFACE_INCLUDE_DIRECTORIES "${MuJoCo_INCLUDE_DIR}")
endif()
