# Files that a library carries inside itself, so that it needs nothing beside it when installed. Run as a
# script (cmake -P) this file writes the source that holds them.
if(CMAKE_SCRIPT_MODE_FILE)
  set(source "// Generated from ${FOLDER}.\n#include \"${HEADER}\"\n\nnamespace saccade::assets {\n\n")
  foreach(name IN LISTS NAMES)
    file(READ ${FOLDER}/${name} text)
    string(MAKE_C_IDENTIFIER "${name}" identifier)
    string(APPEND source "const std::string_view ${identifier} = R\"asset(${text})asset\";\n\n")
  endforeach()
  string(APPEND source "}  // namespace saccade::assets\n")
  file(WRITE ${OUTPUT} "${source}")
  return()
endif()

# saccade_embed_assets(<library> <folder> <header> <file>...): `header` declares saccade::assets::<file with _ for .>. The files
# lie in ${PROJECT_BINARY_DIR}/generated/<folder>, where a bundler wrote them.
function(saccade_embed_assets library folder header)
  set(output ${PROJECT_BINARY_DIR}/generated/${folder}.cpp)
  set(made ${PROJECT_BINARY_DIR}/generated/${folder})
  list(TRANSFORM ARGN PREPEND ${made}/ OUTPUT_VARIABLE files)
  add_custom_command(OUTPUT ${output} DEPENDS ${files} ${PROJECT_SOURCE_DIR}/cmake/SaccadeAssets.cmake
    COMMAND ${CMAKE_COMMAND} -DFOLDER=${made} -DHEADER=${header} "-DNAMES=${ARGN}" -DOUTPUT=${output}
            -P ${PROJECT_SOURCE_DIR}/cmake/SaccadeAssets.cmake
    COMMENT "Embedding ${folder}" VERBATIM)
  target_sources(saccade_${library} PRIVATE ${output})
endfunction()
