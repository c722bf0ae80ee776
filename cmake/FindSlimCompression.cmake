# LZ4, Zstandard and libdeflate, for which Debian installs no CMake packages of a stable name. Defines the imported
# targets SlimCompression::lz4, SlimCompression::zstd and SlimCompression::deflate.
include(FindPackageHandleStandardArgs)
find_path(SlimCompression_LZ4_INCLUDE_DIR lz4frame.h)
find_library(SlimCompression_LZ4_LIBRARY lz4)
find_path(SlimCompression_ZSTD_INCLUDE_DIR zstd.h)
find_library(SlimCompression_ZSTD_LIBRARY zstd)
find_path(SlimCompression_DEFLATE_INCLUDE_DIR libdeflate.h)
find_library(SlimCompression_DEFLATE_LIBRARY deflate)
mark_as_advanced(SlimCompression_DEFLATE_LIBRARY SlimCompression_DEFLATE_INCLUDE_DIR
  SlimCompression_LZ4_INCLUDE_DIR SlimCompression_LZ4_LIBRARY
  SlimCompression_ZSTD_INCLUDE_DIR SlimCompression_ZSTD_LIBRARY)
find_package_handle_standard_args(SlimCompression REQUIRED_VARS
  SlimCompression_LZ4_LIBRARY SlimCompression_LZ4_INCLUDE_DIR SlimCompression_ZSTD_LIBRARY SlimCompression_ZSTD_INCLUDE_DIR
  SlimCompression_DEFLATE_LIBRARY SlimCompression_DEFLATE_INCLUDE_DIR)

foreach(name IN ITEMS lz4 zstd deflate)
  string(TOUPPER ${name} upper)
  if(SlimCompression_FOUND AND NOT TARGET SlimCompression::${name})
    add_library(SlimCompression::${name} UNKNOWN IMPORTED)
    set_target_properties(SlimCompression::${name} PROPERTIES
      IMPORTED_LOCATION "${SlimCompression_${upper}_LIBRARY}"
      INTERFACE_INCLUDE_DIRECTORIES "${SlimCompression_${upper}_INCLUDE_DIR}")
  endif()
endforeach()
