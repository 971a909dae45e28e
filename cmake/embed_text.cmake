# SPDX-License-Identifier: Apache-2.0
# Turns a page into a source: cmake -DFOLDER=… -DSTYLE=a;b -DSCRIPT=… -DMARKUP=… -DHEADER=… -DNAMESPACE=… -DPREFIX=…
# -DSOURCE=out.cpp -P embed_text.cmake: the constants k<PREFIX>Style, k<PREFIX>Script and k<PREFIX>Markup, declared in
# HEADER. Files of one kind follow one another; scripts are in one strict block, so that none of their names is global.
foreach(kind STYLE SCRIPT MARKUP)
  set(${kind}_text "")
  foreach(file ${${kind}})
    file(READ ${FOLDER}/${file} text)
    if(text MATCHES "</(script|style)|\\)page\"")
      message(FATAL_ERROR "${file} would end the element, or the literal, that it is put into")
    endif()
    string(APPEND ${kind}_text "${text}")
  endforeach()
endforeach()
set(SCRIPT_text "\"use strict\";\n{\n${SCRIPT_text}}\n")
file(WRITE ${SOURCE} "// Made by cmake/embed_text.cmake.
#include \"${HEADER}\"
namespace penumbra::${NAMESPACE} {
const std::string_view k${PREFIX}Style = R\"page(${STYLE_text})page\";
const std::string_view k${PREFIX}Script = R\"page(${SCRIPT_text})page\";
const std::string_view k${PREFIX}Markup = R\"page(${MARKUP_text})page\";
}  // namespace penumbra::${NAMESPACE}
")
