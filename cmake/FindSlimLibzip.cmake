# libzip without libzip-config.cmake: Debian's file also exports the command line tools and stops with an error
# where their packages (zipcmp, zipmerge, ziptool) are not installed. Defines the imported target SlimLibzip::zip.
find_path(SlimLibzip_INCLUDE_DIR zip.h)
find_library(SlimLibzip_LIBRARY zip)
mark_as_advanced(SlimLibzip_INCLUDE_DIR SlimLibzip_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SlimLibzip REQUIRED_VARS SlimLibzip_LIBRARY SlimLibzip_INCLUDE_DIR)

if(SlimLibzip_FOUND AND NOT TARGET SlimLibzip::zip)
  add_library(SlimLibzip::zip UNKNOWN IMPORTED)
  set_target_properties(SlimLibzip::zip PROPERTIES
    IMPORTED_LOCATION "${SlimLibzip_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${SlimLibzip_INCLUDE_DIR}")
endif()
