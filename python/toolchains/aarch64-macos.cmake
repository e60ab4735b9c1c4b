# SPDX-License-Identifier: Apache-2.0
# Compiles for macOS on 64-bit ARM, on another system: -DCMAKE_TOOLCHAIN_FILE=<this file>.
# The tools are zig's, which has Apple's headers and libc++; OpenMP's library is LLVM's. `./run cross`
# puts both there.
cmake_path(SET macos NORMALIZE "${CMAKE_CURRENT_LIST_DIR}/../../.venv/macos")
set(CMAKE_SYSTEM_NAME Darwin)
set(CMAKE_SYSTEM_PROCESSOR arm64)
set(CMAKE_OSX_SYSROOT "")
foreach(language IN ITEMS C CXX)
  set(CMAKE_${language}_COMPILER "${macos}/bin/${language}")
endforeach()
set(CMAKE_AR "${macos}/bin/ar" CACHE FILEPATH "")
set(CMAKE_RANLIB "${macos}/bin/ranlib" CACHE FILEPATH "")
set(CMAKE_INSTALL_NAME_TOOL /bin/false CACHE FILEPATH "")  # nothing is installed
set(OpenMP_CXX_FLAGS "-fopenmp -I${macos}/openmp/cmeel.prefix/include" CACHE STRING "")
set(OpenMP_CXX_LIB_NAMES omp CACHE STRING "")
set(OpenMP_omp_LIBRARY "${macos}/openmp/cmeel.prefix/lib/libomp.dylib" CACHE FILEPATH "")
