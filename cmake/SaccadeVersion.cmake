# The version source is written at build time, so that the commit in it is the one that was built; it is left
# untouched while nothing changed. Run as a script (cmake -P) this file writes it.
if(CMAKE_SCRIPT_MODE_FILE)
  set(SACCADE_COMMIT unknown)
  find_program(git git)
  if(git AND EXISTS ${SOURCE_DIR}/.git)
    execute_process(COMMAND ${git} -C ${SOURCE_DIR} rev-parse --short=12 HEAD
      RESULT_VARIABLE failed OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    execute_process(COMMAND ${git} --no-optional-locks -C ${SOURCE_DIR} status --porcelain --untracked-files=no
      OUTPUT_VARIABLE changes ERROR_QUIET)
    if(NOT failed)
      set(SACCADE_COMMIT ${commit})
      if(changes)
        string(APPEND SACCADE_COMMIT -dirty)
      endif()
    endif()
  endif()
  configure_file(${SOURCE_DIR}/cmake/version.cpp.in ${OUTPUT} @ONLY)
  return()
endif()

function(saccade_add_version library)
  set(output ${PROJECT_BINARY_DIR}/generated/version.cpp)
  add_custom_target(saccade_version BYPRODUCTS ${output}
    COMMAND ${CMAKE_COMMAND} -DSOURCE_DIR=${PROJECT_SOURCE_DIR} -DOUTPUT=${output} -DSACCADE_VERSION=${PROJECT_VERSION}
            -P ${PROJECT_SOURCE_DIR}/cmake/SaccadeVersion.cmake
    COMMENT "Looking up the commit" VERBATIM)
  target_sources(saccade_${library} PRIVATE ${output})
  add_dependencies(saccade_${library} saccade_version)
endfunction()
