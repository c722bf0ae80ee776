# HDF5's C library. Debian's shared one reads from the web as well, and loads thirty libraries for that. Programs take the
# archive instead where it is; shared libraries cannot, because its code is not position-independent.
# Defines the imported target SlimHDF5::hdf5. Not to be mixed with hdf5::hdf5: a program must not have two of it.
find_package(HDF5 COMPONENTS C)
find_package(ZLIB)
set(_slim_hdf5_folders)
foreach(_library IN LISTS HDF5_C_LIBRARIES)
  if(IS_ABSOLUTE "${_library}")
    cmake_path(GET _library PARENT_PATH _folder)
    list(APPEND _slim_hdf5_folders ${_folder})
  endif()
endforeach()
find_library(SlimHDF5_ARCHIVE libhdf5.a PATHS ${_slim_hdf5_folders} NO_DEFAULT_PATH)
find_library(SlimHDF5_szip_LIBRARY sz)
mark_as_advanced(SlimHDF5_ARCHIVE SlimHDF5_szip_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SlimHDF5 REQUIRED_VARS HDF5_C_LIBRARIES HDF5_C_INCLUDE_DIRS)

if(SlimHDF5_FOUND AND NOT TARGET SlimHDF5::hdf5)
  add_library(SlimHDF5::hdf5 INTERFACE IMPORTED)
  set(_slim_hdf5_libraries hdf5::hdf5)
  if(SlimHDF5_ARCHIVE AND SlimHDF5_szip_LIBRARY AND ZLIB_FOUND)
    # Not in debug builds, whose LeakSanitizer knows what HDF5 never frees by the name of the shared library.
    set(_is_program $<AND:$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>,$<NOT:$<CONFIG:Debug>>>)
    set(_slim_hdf5_libraries $<IF:${_is_program},${SlimHDF5_ARCHIVE},hdf5::hdf5>
      $<${_is_program}:${SlimHDF5_szip_LIBRARY}> $<${_is_program}:ZLIB::ZLIB> $<${_is_program}:${CMAKE_DL_LIBS}>)
  endif()
  set_target_properties(SlimHDF5::hdf5 PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${HDF5_C_INCLUDE_DIRS}"
    INTERFACE_COMPILE_DEFINITIONS "${HDF5_C_DEFINITIONS}"
    INTERFACE_LINK_LIBRARIES "${_slim_hdf5_libraries}")
endif()
