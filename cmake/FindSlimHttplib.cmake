# cpp-httplib, which Debian ships with a pkg-config file alone. Defines the imported target SlimHttplib::httplib. The macros are
# those that Debian's library is built with: the layout of its types depends on them.
include(FindPackageHandleStandardArgs)
find_path(SlimHttplib_INCLUDE_DIR httplib.h)
find_library(SlimHttplib_LIBRARY cpp-httplib)
mark_as_advanced(SlimHttplib_INCLUDE_DIR SlimHttplib_LIBRARY)
find_package_handle_standard_args(SlimHttplib REQUIRED_VARS SlimHttplib_LIBRARY SlimHttplib_INCLUDE_DIR)

if(SlimHttplib_FOUND AND NOT TARGET SlimHttplib::httplib)
  add_library(SlimHttplib::httplib UNKNOWN IMPORTED)
  set_target_properties(SlimHttplib::httplib PROPERTIES
    IMPORTED_LOCATION "${SlimHttplib_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${SlimHttplib_INCLUDE_DIR}"
    INTERFACE_COMPILE_DEFINITIONS "CPPHTTPLIB_OPENSSL_SUPPORT;CPPHTTPLIB_ZLIB_SUPPORT;CPPHTTPLIB_BROTLI_SUPPORT")
endif()
