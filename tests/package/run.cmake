# Installs the build in BUILD_DIR to a prefix of its own, then configures, builds and runs the outside project against it.
set(prefix ${WORK_DIR}/prefix)
set(outside ${WORK_DIR}/outside)
file(REMOVE_RECURSE ${WORK_DIR})

execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE_DIR}/tests/package -B ${outside} -G ${GENERATOR}
  -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_COMPILER=${CXX_COMPILER} "-DCMAKE_CXX_FLAGS=${CXX_FLAGS}" COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${outside} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${outside}/outside COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${prefix}/bin/saccade --version COMMAND_ERROR_IS_FATAL ANY)
