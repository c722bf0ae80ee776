# OpenCV's core and imgproc without OpenCVConfig.cmake: Debian ships that file only with the complete libopencv-dev
# (642 MB installed), the two modules' own packages come without it. imgcodecs is left out: it loads GDAL and a hundred
# libraries with it, which takes half the time of a short command.
# Defines the imported target SlimOpenCV::SlimOpenCV. With SlimOpenCV_USE_STATIC_LIBRARIES it is made of archives where
# they are, of which a program takes the little that it calls: it then starts without the window system's libraries,
# which the shared one loads for an OpenGL that nobody here calls.
find_path(SlimOpenCV_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4)
mark_as_advanced(SlimOpenCV_INCLUDE_DIR)
set(_slim_opencv_required SlimOpenCV_INCLUDE_DIR)
set(_slim_opencv_libraries)
set(_slim_opencv_archives)
foreach(_module imgproc core)
  find_library(SlimOpenCV_${_module}_LIBRARY opencv_${_module})
  find_library(SlimOpenCV_${_module}_ARCHIVE libopencv_${_module}.a)
  mark_as_advanced(SlimOpenCV_${_module}_LIBRARY SlimOpenCV_${_module}_ARCHIVE)
  list(APPEND _slim_opencv_required SlimOpenCV_${_module}_LIBRARY)
  list(APPEND _slim_opencv_libraries ${SlimOpenCV_${_module}_LIBRARY})
  list(APPEND _slim_opencv_archives ${SlimOpenCV_${_module}_ARCHIVE})
endforeach()
find_library(SlimOpenCV_lapack_LIBRARY lapack)
find_library(SlimOpenCV_blas_LIBRARY blas)
mark_as_advanced(SlimOpenCV_lapack_LIBRARY SlimOpenCV_blas_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SlimOpenCV REQUIRED_VARS ${_slim_opencv_required})

if(SlimOpenCV_FOUND AND NOT TARGET SlimOpenCV::SlimOpenCV)
  add_library(SlimOpenCV::SlimOpenCV INTERFACE IMPORTED)
  set_target_properties(SlimOpenCV::SlimOpenCV PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${SlimOpenCV_INCLUDE_DIR}")
  if(SlimOpenCV_USE_STATIC_LIBRARIES AND SlimOpenCV_core_ARCHIVE AND SlimOpenCV_imgproc_ARCHIVE AND SlimOpenCV_lapack_LIBRARY
     AND SlimOpenCV_blas_LIBRARY)
    find_package(TBB REQUIRED)
    find_package(ZLIB REQUIRED)
    set_target_properties(SlimOpenCV::SlimOpenCV PROPERTIES
      INTERFACE_LINK_LIBRARIES "${_slim_opencv_archives};${SlimOpenCV_lapack_LIBRARY};${SlimOpenCV_blas_LIBRARY};TBB::tbb;ZLIB::ZLIB;${CMAKE_DL_LIBS}"
      INTERFACE_LINK_OPTIONS "LINKER:--gc-sections;LINKER:--defsym=glXGetProcAddressARB=0;LINKER:--defsym=glXGetCurrentContext=0;LINKER:--defsym=glXGetCurrentDisplay=0")
  else()
    set_target_properties(SlimOpenCV::SlimOpenCV PROPERTIES INTERFACE_LINK_LIBRARIES "${_slim_opencv_libraries}")
  endif()
endif()
