# SPDX-License-Identifier: Apache-2.0

option(VOLCONTACT_UNITY "Compile several files as one: headers take longer than what is in them" ON)

# Warnings, visibility and language level of every target of ours; third-party targets keep theirs.
# Where warnings are no errors, as in `pip install`, nobody reads them, and looking for them takes a
# twentieth of the compiler's time.
function(volcontact_target name)
  target_compile_features(${name} PUBLIC cxx_std_20)
  if(VOLCONTACT_WARNINGS_AS_ERRORS)
    target_compile_options(${name} PRIVATE -Wall -Wextra -Wshadow -Wpedantic)
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # Guesses that depend on what was inlined, often wrong; the sanitizers look for the real thing.
    target_compile_options(${name} PRIVATE -Wno-maybe-uninitialized -Wno-stringop-overflow)
    # Vectors of eight are passed only between functions compiled for one machine, or inlined.
    target_compile_options(${name} PRIVATE -Wno-psabi)
    # By default GCC looks for garbage from 128 MB on, which takes a fifteenth of its time; in kB.
    target_compile_options(${name} PRIVATE --param=ggc-min-heapsize=500000)
    # Passes that take a seventh of its time, and without which steps and engines are as fast: these
    # processors order instructions themselves.
    if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
      target_compile_options(${name} PRIVATE -fno-schedule-insns2 -fno-gcse -fno-gcse-after-reload
        --param=sccvn-max-alias-queries-per-access=100)
      # Else what takes 160 ns takes 190 when something that stands before it grows.
      target_compile_options(${name} PRIVATE -falign-functions=64)
      # By default it sets and copies what has 128 bytes and more by `rep`, whose start alone takes as
      # long as that by registers: 1 to 4 % of a step.
      foreach(operation memset memcpy)
        target_compile_options(${name} PRIVATE
          -m${operation}-strategy=vector_loop:1024:noalign,libcall:-1:noalign)
      endforeach()
    endif()
  endif()
  set_target_properties(${name} PROPERTIES
    CXX_EXTENSIONS OFF
    CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON
    POSITION_INDEPENDENT_CODE ON
    UNITY_BUILD ${VOLCONTACT_UNITY}
    UNITY_BUILD_RELOCATABLE ON  # the same text in every checkout, for the compiler cache
    COMPILE_WARNING_AS_ERROR ${VOLCONTACT_WARNINGS_AS_ERRORS})
endfunction()

# Compiles the sources of each folder as one: names of unnamed namespaces are shared in a room alone,
# and an edit compiles its room. Sources named after ALONE are compiled by themselves. JOINED names
# small rooms, as a,b,c, that are compiled as one, since what the headers make of templates takes as
# long as what is in them; they share those names as well.
function(volcontact_unity_by_folder name)
  cmake_parse_arguments(PARSE_ARGV 1 argument "" "" "ALONE;JOINED")
  get_target_property(sources ${name} SOURCES)
  foreach(source IN LISTS sources)
    cmake_path(GET source PARENT_PATH folder)
    foreach(rooms IN LISTS argument_JOINED)
      string(REPLACE "," ";" rooms "${rooms}")
      if(folder IN_LIST rooms)
        list(JOIN rooms "_" folder)
        break()
      endif()
    endforeach()
    string(MAKE_C_IDENTIFIER "${folder}" group)
    if(NOT folder)
      set(group of_target)
    endif()
    if(NOT source IN_LIST argument_ALONE)
      set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group})
    endif()
  endforeach()
  set_target_properties(${name} PROPERTIES UNITY_BUILD_MODE GROUP)
endfunction()

option(VOLCONTACT_PRECOMPILE "Parse the headers that most sources need once for all of them" ON)

# Headers that most sources of a target need, as <name>: a path would differ from checkout to
# checkout, and the compiler cache with it. A source must still include
# what it uses: tests/test_includes.py reads that, and the build under the thread sanitizer
# precompiles nothing. FROM another target of the same flags takes what that one has.
function(volcontact_precompile name)
  cmake_parse_arguments(PARSE_ARGV 1 argument "" "FROM" "")
  if(NOT VOLCONTACT_PRECOMPILE)
    return()
  endif()
  if(argument_FROM)
    target_precompile_headers(${name} REUSE_FROM ${argument_FROM})
  else()
    target_precompile_headers(${name} PRIVATE ${argument_UNPARSED_ARGUMENTS})
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${name} PRIVATE -fpch-preprocess)  # ccache asks for it
  endif()
endfunction()

# For what calls the core: compiled in three quarters of the time with few optimisations, in half
# with -Og, which tests ask for.
function(volcontact_compile_quickly name)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_BUILD_TYPE STREQUAL "Release")
    set(level -O1)
    if("FOR_TESTS" IN_LIST ARGN)
      set(level -Og)
    endif()
    target_compile_options(${name} PRIVATE ${level})
  endif()
endfunction()

# Where the core and a target of other flags instantiate the same template, the linker takes the first
# that it sees: that of the core.
function(volcontact_link_core_first name)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU"
      AND (CMAKE_BUILD_TYPE STREQUAL "Release" OR VOLCONTACT_TEST_OBJECTS))
    target_link_options(${name} PRIVATE
      "LINKER:--whole-archive,$<TARGET_FILE:volcontact::core>,--no-whole-archive")
  endif()
endfunction()

# What a user of the core must have as well. Scope: PUBLIC for the core, INTERFACE for one that was
# compiled before.
function(volcontact_core_usage name scope)
  cmake_path(GET CMAKE_CURRENT_FUNCTION_LIST_DIR PARENT_PATH plugin)
  target_include_directories(${name} ${scope} "${plugin}")
  target_link_libraries(${name} ${scope} OpenMP::OpenMP_CXX)
  # Equal bits on every machine: headers are inlined into users of the core, so they need it too.
  target_compile_options(${name} ${scope} -ffp-contract=off)
endfunction()
