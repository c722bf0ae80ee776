# libwebp, for which neither CMake nor Debian has a package file. Defines the imported target SlimWebP::webp.
find_path(SlimWebP_INCLUDE_DIR webp/decode.h)
find_library(SlimWebP_LIBRARY webp)
mark_as_advanced(SlimWebP_INCLUDE_DIR SlimWebP_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SlimWebP REQUIRED_VARS SlimWebP_LIBRARY SlimWebP_INCLUDE_DIR)

if(SlimWebP_FOUND AND NOT TARGET SlimWebP::webp)
  add_library(SlimWebP::webp UNKNOWN IMPORTED)
  set_target_properties(SlimWebP::webp PROPERTIES
    IMPORTED_LOCATION "${SlimWebP_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${SlimWebP_INCLUDE_DIR}")
endif()
