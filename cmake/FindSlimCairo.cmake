# cairo, which Debian ships with a pkg-config file alone. Defines the imported target SlimCairo::cairo.
find_path(SlimCairo_INCLUDE_DIR cairo.h PATH_SUFFIXES cairo)
find_library(SlimCairo_LIBRARY cairo)
mark_as_advanced(SlimCairo_INCLUDE_DIR SlimCairo_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SlimCairo REQUIRED_VARS SlimCairo_LIBRARY SlimCairo_INCLUDE_DIR)

if(SlimCairo_FOUND AND NOT TARGET SlimCairo::cairo)
  add_library(SlimCairo::cairo UNKNOWN IMPORTED)
  set_target_properties(SlimCairo::cairo PROPERTIES
    IMPORTED_LOCATION "${SlimCairo_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${SlimCairo_INCLUDE_DIR}")
endif()
