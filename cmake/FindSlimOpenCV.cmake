# OpenCV's core and imgproc without OpenCVConfig.cmake: Debian ships that file only with the
# complete libopencv-dev (642 MB installed), the two modules' own packages come without it.
# Its imgcodecs is left out: it loads GDAL with a hundred libraries, half the time of a short command.
# Defines the imported target SlimOpenCV::SlimOpenCV.
find_path(SlimOpenCV_INCLUDE_DIR opencv2/core.hpp PATH_SUFFIXES opencv4)
mark_as_advanced(SlimOpenCV_INCLUDE_DIR)
set(_slim_opencv_required SlimOpenCV_INCLUDE_DIR)
set(_slim_opencv_libraries)
foreach(_module core imgproc)
  find_library(SlimOpenCV_${_module}_LIBRARY opencv_${_module})
  mark_as_advanced(SlimOpenCV_${_module}_LIBRARY)
  list(APPEND _slim_opencv_required SlimOpenCV_${_module}_LIBRARY)
  list(APPEND _slim_opencv_libraries ${SlimOpenCV_${_module}_LIBRARY})
endforeach()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SlimOpenCV REQUIRED_VARS ${_slim_opencv_required})

if(SlimOpenCV_FOUND AND NOT TARGET SlimOpenCV::SlimOpenCV)
  add_library(SlimOpenCV::SlimOpenCV INTERFACE IMPORTED)
  set_target_properties(SlimOpenCV::SlimOpenCV PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${SlimOpenCV_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "${_slim_opencv_libraries}")
endif()
