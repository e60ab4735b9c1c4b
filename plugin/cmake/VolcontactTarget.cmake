# SPDX-License-Identifier: Apache-2.0

# Warnings, visibility and language level of every target of ours; third-party targets keep theirs.
function(volcontact_target name)
  target_compile_features(${name} PUBLIC cxx_std_20)
  target_compile_options(${name} PRIVATE -Wall -Wextra -Wshadow -Wpedantic)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # Guesses that depend on what was inlined, often wrong; the sanitizers look for the real thing.
    target_compile_options(${name} PRIVATE -Wno-maybe-uninitialized -Wno-stringop-overflow)
    # Vectors of eight are passed only between functions compiled for one machine, or inlined.
    target_compile_options(${name} PRIVATE -Wno-psabi)
  endif()
  set_target_properties(${name} PROPERTIES
    CXX_EXTENSIONS OFF
    CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON
    POSITION_INDEPENDENT_CODE ON
    COMPILE_WARNING_AS_ERROR ${VOLCONTACT_WARNINGS_AS_ERRORS})
endfunction()
