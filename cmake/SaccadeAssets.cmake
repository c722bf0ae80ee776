# Files that a room's library carries inside itself, so that it needs nothing beside it when installed. Run as a
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

# saccade_embed_assets(<room> <folder> <header> <file>...): `header` declares saccade::assets::<file with _ for .>.
function(saccade_embed_assets room folder header)
  set(output ${PROJECT_BINARY_DIR}/generated/${folder}.cpp)
  list(TRANSFORM ARGN PREPEND ${PROJECT_SOURCE_DIR}/${folder}/ OUTPUT_VARIABLE files)
  add_custom_command(OUTPUT ${output} DEPENDS ${files} ${PROJECT_SOURCE_DIR}/cmake/SaccadeAssets.cmake
    COMMAND ${CMAKE_COMMAND} -DFOLDER=${PROJECT_SOURCE_DIR}/${folder} -DHEADER=${header} "-DNAMES=${ARGN}" -DOUTPUT=${output}
            -P ${PROJECT_SOURCE_DIR}/cmake/SaccadeAssets.cmake
    COMMENT "Embedding ${folder}" VERBATIM)
  target_sources(saccade_${room} PRIVATE ${output})
endfunction()
