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

# Messages name sources from the root of the tree, and the cache of compiled sources serves other checkouts as well: with whole
# paths in __FILE__ no two would compile the same text.
add_compile_options(-fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=)

# Warnings are errors in the project's code; imported targets' headers are system headers and stay silent. Some warnings
# of GCC 12 are left to the sanitizer presets, because optimisation makes them wrong, on some processors alone: with
# -march=native it takes the deliberately undefined registers of its own AVX-512 intrinsics for uninitialised variables (GCC bug
# 105593), "text" + std::string for overlapping copies (GCC bug 105651), and, where registers of 32 bytes are the widest, Eigen's
# loads of two or four doubles for loads beyond a vector of three. Without AVX-512 it notes that functions which pass vectors of
# 64 bytes by value have another ABI than with it (-Wpsabi): here they are all local to their file. Clang, which builds the fuzz
# targets alone, has warnings of its own, which are shown.
function(saccade_set_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wshadow $<$<CXX_COMPILER_ID:GNU>:-Werror>
    $<$<CXX_COMPILER_ID:GNU>:-Wno-psabi>
    "$<$<AND:$<CXX_COMPILER_ID:GNU>,$<CONFIG:Release>>:-Wno-uninitialized;-Wno-maybe-uninitialized;-Wno-restrict;-Wno-array-bounds>")
endfunction()

# saccade_group_by_folder(<target>): with SACCADE_UNITY_BUILD the sources of one folder are compiled as one unit. Most of a clean
# build is parsing the same outside headers, some 3 s for each of seven hundred short files; per folder it takes less than half.
# Every file keeps its unit whatever is added beside it. Hence the rule that a name in an anonymous namespace is unique in
# its folder. Generated files, added later, stay alone.
function(saccade_group_by_folder target)
  if(NOT SACCADE_UNITY_BUILD)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    cmake_path(GET source PARENT_PATH folder)
    cmake_path(RELATIVE_PATH folder BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE group)
    string(MAKE_C_IDENTIFIER "${group}" group)
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group})
  endforeach()
  # GCC takes the sources of a unit for headers, of whose classes none may hold what is in an anonymous namespace.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()
