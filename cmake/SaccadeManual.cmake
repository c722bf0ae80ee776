# Target saccade_manual: manual pages and completion of the shells as the command itself prints them, in manual/share of the
# build folder, where they stand below share/ of an installation.
set(manual ${PROJECT_BINARY_DIR}/manual/share)
add_custom_target(saccade_manual
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${manual}
  COMMAND ${CMAKE_COMMAND} -E make_directory ${manual}/bash-completion/completions ${manual}/zsh/vendor-completions
          ${manual}/fish/vendor_completions.d
  COMMAND saccade man -o ${manual}/man/man1
  COMMAND saccade completion bash > ${manual}/bash-completion/completions/saccade
  COMMAND saccade completion zsh > ${manual}/zsh/vendor-completions/_saccade
  COMMAND saccade completion fish > ${manual}/fish/vendor_completions.d/saccade.fish
  COMMAND sh -c "gzip -9n ${manual}/man/man1/*.1"
  COMMENT "Writing manual pages and completion" VERBATIM)
