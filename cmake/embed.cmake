# SPDX-License-Identifier: Apache-2.0
# Turns a SPIR-V file into a header: view_sample.comp → kViewSampleComp.
file(READ ${SPIRV} bytes HEX)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1," words "${bytes}")
include(${CMAKE_CURRENT_LIST_DIR}/shader_name.cmake)
file(WRITE ${HEADER} "#pragma once\n#include <cstdint>\nnamespace penumbra::shaders {\ninline constexpr std::uint32_t ${name}[] = {${words}};\n}\n")
