# Language level, warnings and compiler cache of the project's own targets.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

find_program(SACCADE_CCACHE ccache)
if(SACCADE_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # No precompiled headers: they save a seventh of a clean build, but tie the cache to one build folder and make
  # GCC 12 warn where it otherwise does not.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${SACCADE_CCACHE})
endif()

# Warnings are errors in the project's code; imported targets' headers are system headers and stay silent. Three warnings
# of GCC 12 are left to the sanitizer presets, because optimisation makes them wrong: with -march=native it takes the
# deliberately undefined registers of its own AVX-512 intrinsics for uninitialised variables (GCC bug 105593), and
# "text" + std::string for overlapping copies (GCC bug 105651). Without AVX-512 it notes that functions which pass vectors of
# 64 bytes by value have another ABI than with it (-Wpsabi): here they are all local to their file.
function(saccade_set_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror
    $<$<CXX_COMPILER_ID:GNU>:-Wno-psabi>
    "$<$<AND:$<CXX_COMPILER_ID:GNU>,$<CONFIG:Release>>:-Wno-uninitialized;-Wno-maybe-uninitialized;-Wno-restrict>")
endfunction()
