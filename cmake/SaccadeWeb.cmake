# Pages of scripts: libraries from npm by the lock file in `lists`, fetched into ${PROJECT_BINARY_DIR}/web. npm is asked once per
# lock file; from then on a build needs no network.
function(saccade_fetch_web lists)
  find_program(SACCADE_NPM npm)
  if(NOT SACCADE_NPM)
    message(FATAL_ERROR "npm is missing, with which the pages of `saccade report` and `saccade view` are bundled. "
                        "`./dev install-deps` installs it; by hand: apt-get install nodejs npm")
  endif()
  set(packages ${PROJECT_BINARY_DIR}/web)
  set(list_files package.json package-lock.json .npmrc)
  list(TRANSFORM list_files PREPEND ${PROJECT_SOURCE_DIR}/${lists}/)
  add_custom_command(OUTPUT ${packages}/installed DEPENDS ${list_files}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${packages}
    COMMAND ${CMAKE_COMMAND} -E copy ${list_files} ${packages}
    # No package's own scripts are run: none is needed.
    COMMAND ${SACCADE_NPM} ci --ignore-scripts --loglevel=error
    COMMAND ${CMAKE_COMMAND} -E touch ${packages}/installed
    WORKING_DIRECTORY ${PROJECT_BINARY_DIR}/web COMMENT "Fetching the libraries of ${lists} from npm" VERBATIM)
  file(MAKE_DIRECTORY ${packages})
endfunction()

# saccade_bundle_web(<folder> <name> <page> <folder with sources>...): the script and the style of a page, <folder>/src/main.js with
# all that it imports, as <name>.js and <name>.css in ${PROJECT_BINARY_DIR}/generated/<folder>, and <page> beside them. Made anew
# when a source of the named folders changes.
function(saccade_bundle_web folder name page)
  set(source ${PROJECT_SOURCE_DIR}/${folder})
  set(output ${PROJECT_BINARY_DIR}/generated/${folder})
  set(packages ${PROJECT_BINARY_DIR}/web)
  set(patterns)
  foreach(used IN LISTS ARGN)
    list(APPEND patterns ${PROJECT_SOURCE_DIR}/${used}/src/*.js ${PROJECT_SOURCE_DIR}/${used}/*.css)
  endforeach()
  file(GLOB scripts CONFIGURE_DEPENDS ${patterns})
  add_custom_command(OUTPUT ${output}/${name}.js ${output}/${name}.css ${output}/${page}
    DEPENDS ${scripts} ${source}/${page} ${packages}/installed
    COMMAND ${CMAKE_COMMAND} -E env NODE_PATH=${packages}/node_modules ${packages}/node_modules/.bin/esbuild
            ${source}/src/main.js --bundle --minify --format=iife --target=chrome123,firefox120,safari17.5
            --log-level=warning --outfile=${output}/${name}.js
    COMMAND ${CMAKE_COMMAND} -E copy ${source}/${page} ${output}
    COMMENT "Bundling ${folder}" VERBATIM)
endfunction()
