# The installed package: find_package(saccade) gives saccade::core, ::simulator, ::estimator and ::eval.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/saccade)
foreach(library IN LISTS SACCADE_LIBRARIES)
  install(TARGETS saccade_${library} EXPORT saccadeTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${library} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/saccade FILES_MATCHING PATTERN *.h)
endforeach()
install(TARGETS saccade RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})

install(EXPORT saccadeTargets NAMESPACE saccade:: DESTINATION ${package_dir})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/saccadeConfig.cmake.in ${PROJECT_BINARY_DIR}/saccadeConfig.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/saccadeConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/saccadeConfig.cmake ${PROJECT_BINARY_DIR}/saccadeConfigVersion.cmake
              ${PROJECT_SOURCE_DIR}/cmake/FindSlimOpenCV.cmake ${PROJECT_SOURCE_DIR}/cmake/FindSlimLibzip.cmake
              ${PROJECT_SOURCE_DIR}/cmake/FindSlimWebP.cmake ${PROJECT_SOURCE_DIR}/cmake/FindSlimHDF5.cmake
              ${PROJECT_SOURCE_DIR}/cmake/FindSlimCompression.cmake
        DESTINATION ${package_dir})
