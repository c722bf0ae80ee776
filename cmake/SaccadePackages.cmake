# Debian packages by `cpack -G DEB` in the build folder; ./dev package builds what they hold first.
set(SACCADE_LIBRARY_PACKAGES "" CACHE STRING "Packages that libsaccade-dev depends on, separated by commas; ./dev package states them")

# What a package says of itself: copyright and changelog, below doc/ of the build folder.
file(READ ${PROJECT_SOURCE_DIR}/LICENSE SACCADE_LICENSE)
string(STRIP "${SACCADE_LICENSE}" SACCADE_LICENSE)
string(REPLACE "\n\n" "\n.\n" SACCADE_LICENSE "${SACCADE_LICENSE}")
string(REPLACE "\n" "\n " SACCADE_LICENSE "${SACCADE_LICENSE}")
# The time of the configuration, or $SOURCE_DATE_EPOCH.
string(TIMESTAMP SACCADE_DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)
configure_file(${PROJECT_SOURCE_DIR}/cmake/debian/copyright.in ${PROJECT_BINARY_DIR}/doc/copyright @ONLY)
configure_file(${PROJECT_SOURCE_DIR}/cmake/debian/changelog.in ${PROJECT_BINARY_DIR}/doc/changelog @ONLY)
execute_process(COMMAND gzip -9nkf ${PROJECT_BINARY_DIR}/doc/changelog COMMAND_ERROR_IS_FATAL ANY)

set(CPACK_DEBIAN_COMMAND_PACKAGE_NAME saccade)
set(CPACK_DEBIAN_LIBRARIES_PACKAGE_NAME libsaccade-dev)
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-saccade)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_NAME saccade-doc)
foreach(component IN ITEMS command libraries python documentation)
  string(TOUPPER ${component} upper)
  set(package ${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  install(FILES ${PROJECT_BINARY_DIR}/doc/copyright ${PROJECT_BINARY_DIR}/doc/changelog.gz
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component})
endforeach()

# What is packaged was built before; the tests need not be.
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)
set(CPACK_CMAKE_GENERATOR Ninja)
set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL command libraries)
if(TARGET saccade_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
if(EXISTS ${PROJECT_SOURCE_DIR}/build/docs/index.html)
  list(APPEND CPACK_COMPONENTS_ALL documentation)
endif()
set(CPACK_PACKAGE_CONTACT "the saccade authors <saccade@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_SOURCE_DIR}/build/package)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_STRIP_FILES ON)
# Group and others never write to what is installed, whatever the umask of the build.
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_COMMAND_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMMAND_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_COMMAND_PACKAGE_RECOMMENDS "ffmpeg, sweethome3d-furniture")
set(CPACK_DEBIAN_COMMAND_PACKAGE_SUGGESTS "python3-saccade, saccade-doc")
set(CPACK_DEBIAN_COMMAND_DESCRIPTION "simulation and benchmarks for event-camera visual odometry
 Simulates event cameras without a frame rate, estimates motion, depth and
 images from their events, and scores the result against ground truth.")

set(CPACK_DEBIAN_LIBRARIES_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBRARIES_PACKAGE_DEPENDS "${SACCADE_LIBRARY_PACKAGES}")
set(CPACK_DEBIAN_LIBRARIES_DESCRIPTION "event-camera simulation and odometry, development files
 Static libraries, headers and the CMake package of saccade.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "saccade (= ${PROJECT_VERSION}), python3-numpy")
if(Python_VERSION_MINOR)
  math(EXPR next "${Python_VERSION_MINOR} + 1")
  string(APPEND CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS ", python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${next})")
endif()
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS python3-matplotlib)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS python3-pandas)
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "event-camera simulation and odometry, Python module
 Events, frames and depth of simulated and recorded cameras as numpy arrays,
 estimators and scores of saccade as functions.")

set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DOCUMENTATION_DESCRIPTION "event-camera simulation and odometry, documentation
 Tutorials, methods, formats and reference of saccade as a site that works
 offline.")
include(CPack)
