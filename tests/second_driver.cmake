# SPDX-License-Identifier: Apache-2.0
# Tests the program on a second Vulkan driver for processors, if one is installed.
penumbra_test(second_driver
  SOURCES cli/program.cpp cli/second_driver.cpp
  LIBRARIES penumbra_mesh penumbra_base nlohmann_json::nlohmann_json)
target_compile_definitions(second_driver_test PRIVATE PENUMBRA_PROGRAM="$<TARGET_FILE:penumbra>")
add_dependencies(second_driver_test penumbra)
