# SPDX-License-Identifier: Apache-2.0
# Turns a script of another project into a source: cmake -DSCRIPT=a.js -DHEADER=… -DNAMESPACE=… -DNAME=… -DSOURCE=out.cpp
# -P embed_script.cmake: the constant NAME, declared in HEADER. Without SCRIPT the constant is empty.
set(text "")
if(SCRIPT)
  file(READ ${SCRIPT} text)
  if(text MATCHES "\\)script\"")
    message(FATAL_ERROR "${SCRIPT} would end the literal that it is put into")
  endif()
endif()
file(WRITE ${SOURCE} "// Made by cmake/embed_script.cmake.
#include \"${HEADER}\"
namespace penumbra::${NAMESPACE} {
const std::string_view ${NAME} = R\"script(${text})script\";
}  // namespace penumbra::${NAMESPACE}
")
