# What is installed, by component: the command with its configurations; the libraries, of which find_package(saccade) gives
# saccade::core, ::simulator, ::estimator and ::eval; the Python module; the site of the documentation.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/saccade)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME libraries)
foreach(library IN LISTS SACCADE_LIBRARIES)
  install(TARGETS saccade_${library} EXPORT saccadeTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${library} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/saccade FILES_MATCHING PATTERN *.h)
endforeach()

install(TARGETS saccade RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT command)
# The command finds them from its own file upwards (core/config/shipped.h).
install(DIRECTORY ${PROJECT_SOURCE_DIR}/configs ${PROJECT_SOURCE_DIR}/scenes ${PROJECT_SOURCE_DIR}/examples
  DESTINATION ${CMAKE_INSTALL_DATADIR}/saccade COMPONENT command USE_SOURCE_PERMISSIONS
  PATTERN __pycache__ EXCLUDE PATTERN .github EXCLUDE)
# Made by the target saccade_manual.
install(DIRECTORY ${PROJECT_BINARY_DIR}/manual/share/ DESTINATION ${CMAKE_INSTALL_DATADIR} COMPONENT command OPTIONAL)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/build/docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR}-doc/html COMPONENT documentation OPTIONAL)

# All libraries are of the system, and found without a path in the program.
set_target_properties(saccade PROPERTIES SKIP_BUILD_RPATH ON INSTALL_RPATH "")
if(TARGET saccade_python)
  set_target_properties(saccade_python PROPERTIES SKIP_BUILD_RPATH ON INSTALL_RPATH "")
  set(python_dir lib/python3/dist-packages CACHE STRING "Where the Python module is installed, below the prefix")
  install(TARGETS saccade_python LIBRARY DESTINATION ${python_dir}/saccade COMPONENT python)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/python/saccade DESTINATION ${python_dir} COMPONENT python
    PATTERN __pycache__ EXCLUDE)
endif()

install(EXPORT saccadeTargets NAMESPACE saccade:: DESTINATION ${package_dir})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/saccadeConfig.cmake.in ${PROJECT_BINARY_DIR}/saccadeConfig.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/saccadeConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/saccadeConfig.cmake ${PROJECT_BINARY_DIR}/saccadeConfigVersion.cmake
              ${PROJECT_SOURCE_DIR}/cmake/FindSlimOpenCV.cmake ${PROJECT_SOURCE_DIR}/cmake/FindSlimLibzip.cmake
              ${PROJECT_SOURCE_DIR}/cmake/FindSlimWebP.cmake ${PROJECT_SOURCE_DIR}/cmake/FindSlimHDF5.cmake
              ${PROJECT_SOURCE_DIR}/cmake/FindSlimCompression.cmake ${PROJECT_SOURCE_DIR}/cmake/FindSlimCairo.cmake
        DESTINATION ${package_dir})
