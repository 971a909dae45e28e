# SPDX-License-Identifier: Apache-2.0
# cmake -DPROGRAM=penumbra -DPREFIX=… -P install_words.cmake: writes the program's manual pages and shell completion
# scripts to the folders searched by man, bash, zsh and fish.
function(ask file)
  execute_process(COMMAND ${PROGRAM} ${ARGN} OUTPUT_VARIABLE text RESULT_VARIABLE code)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "${PROGRAM} ${ARGN}: exit code ${code}")
  endif()
  file(WRITE "${PREFIX}/${file}" "${text}")
  message(STATUS "Installing: ${PREFIX}/${file}")
endfunction()

execute_process(COMMAND ${PROGRAM} completion commands OUTPUT_VARIABLE commands RESULT_VARIABLE code OUTPUT_STRIP_TRAILING_WHITESPACE)
if(NOT code EQUAL 0)
  message(FATAL_ERROR "${PROGRAM} completion commands: exit code ${code}")
endif()
ask(share/man/man1/penumbra.1 man)
foreach(command ${commands})
  ask(share/man/man1/penumbra-${command}.1 man ${command})
endforeach()
ask(share/bash-completion/completions/penumbra completion bash)
ask(share/zsh/site-functions/_penumbra completion zsh)
ask(share/fish/vendor_completions.d/penumbra.fish completion fish)
