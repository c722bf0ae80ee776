# The Python package `saccade` in python/ of the build folder: the compiled module and the Python files beside it.
option(SACCADE_BUILD_PYTHON "Build the Python module where pybind11 and numpy are installed" ON)

# saccade_find_python(<result>): whether interpreter, headers, pybind11 and numpy are there; says what is missing.
macro(saccade_find_python result)
  set(${result} FALSE)
  # Debian's packages are of the system's interpreter, which is not always the first one on the search path.
  if(NOT Python_EXECUTABLE AND EXISTS /usr/bin/python3)
    set(Python_EXECUTABLE /usr/bin/python3)
  endif()
  find_package(Python COMPONENTS Interpreter Development.Module QUIET)
  find_package(pybind11 2.10 CONFIG QUIET)
  set(numpy_missing 1)
  if(Python_EXECUTABLE)
    execute_process(COMMAND ${Python_EXECUTABLE} -c "import numpy" RESULT_VARIABLE numpy_missing OUTPUT_QUIET ERROR_QUIET)
  endif()
  if(Python_FOUND AND pybind11_FOUND AND numpy_missing EQUAL 0)
    set(${result} TRUE)
  else()
    message(STATUS "The Python module is left out: install pybind11-dev, python3-dev and python3-numpy for it")
  endif()
endmacro()

function(saccade_add_python)
  set(package ${PROJECT_BINARY_DIR}/python/saccade)
  file(GLOB binding CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/python/binding/*.cpp)
  # Without its extras: they are the link-time optimisation of code whose work is done in the libraries.
  pybind11_add_module(saccade_python MODULE NO_EXTRAS ${binding})
  target_link_libraries(saccade_python PRIVATE saccade_apps)
  saccade_set_warnings(saccade_python)
  saccade_group_by_folder(saccade_python)
  # The lanes of simulator and estimator, which never meet elsewhere, have names in common.
  set_source_files_properties(${PROJECT_SOURCE_DIR}/python/binding/tracking.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  set_target_properties(saccade_python PROPERTIES OUTPUT_NAME _native LIBRARY_OUTPUT_DIRECTORY ${package})

  file(GLOB sources CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/python/saccade
    ${PROJECT_SOURCE_DIR}/python/saccade/*.py ${PROJECT_SOURCE_DIR}/python/saccade/*.pyi
    ${PROJECT_SOURCE_DIR}/python/saccade/py.typed)
  set(copies)
  foreach(source IN LISTS sources)
    add_custom_command(OUTPUT ${package}/${source} DEPENDS ${PROJECT_SOURCE_DIR}/python/saccade/${source}
      COMMAND ${CMAKE_COMMAND} -E copy ${PROJECT_SOURCE_DIR}/python/saccade/${source} ${package}/${source} VERBATIM)
    list(APPEND copies ${package}/${source})
  endforeach()
  add_custom_target(saccade_python_files ALL DEPENDS ${copies})
  add_dependencies(saccade_python saccade_python_files)
endfunction()
