# The script and the style of the report's page: sources and lock file in `folder`, libraries from npm, bundled by esbuild into
# ${PROJECT_BINARY_DIR}/generated/${folder}. npm is asked once per lock file; from then on a build needs no network.
function(saccade_bundle_web folder)
  find_program(SACCADE_NPM npm)
  if(NOT SACCADE_NPM)
    message(FATAL_ERROR "npm is missing, with which the page of `saccade report` is bundled. "
                        "`./dev install-deps` installs it; by hand: apt-get install nodejs npm")
  endif()
  set(source ${PROJECT_SOURCE_DIR}/${folder})
  set(output ${PROJECT_BINARY_DIR}/generated/${folder})
  set(packages ${PROJECT_BINARY_DIR}/web)
  set(lists package.json package-lock.json .npmrc)
  list(TRANSFORM lists PREPEND ${source}/ OUTPUT_VARIABLE list_files)
  add_custom_command(OUTPUT ${packages}/installed DEPENDS ${list_files}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${packages}
    COMMAND ${CMAKE_COMMAND} -E copy ${list_files} ${packages}
    # No package's own scripts are run: none is needed.
    COMMAND ${SACCADE_NPM} ci --ignore-scripts --loglevel=error
    COMMAND ${CMAKE_COMMAND} -E touch ${packages}/installed
    WORKING_DIRECTORY ${PROJECT_BINARY_DIR}/web COMMENT "Fetching the libraries of ${folder} from npm" VERBATIM)
  file(MAKE_DIRECTORY ${packages})
  file(GLOB scripts CONFIGURE_DEPENDS ${source}/src/*.js)
  add_custom_command(OUTPUT ${output}/report.js ${output}/report.css ${output}/page.html
    DEPENDS ${scripts} ${source}/style.css ${source}/page.html ${packages}/installed
    COMMAND ${CMAKE_COMMAND} -E env NODE_PATH=${packages}/node_modules ${packages}/node_modules/.bin/esbuild
            ${source}/src/main.js --bundle --minify --format=iife --target=chrome123,firefox120,safari17.5
            --log-level=warning --outfile=${output}/report.js
    COMMAND ${CMAKE_COMMAND} -E copy ${source}/page.html ${output}
    COMMENT "Bundling ${folder}" VERBATIM)
endfunction()
