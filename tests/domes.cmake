# SPDX-License-Identifier: Apache-2.0
# Tests of domes: every method that supports them, compared with closed forms, with the other methods and with the exact
# decision; and the program from outside. No device.
penumbra_test(domes
  SOURCES
  agreement/domes.cpp
  analytic/dome_closed_forms.cpp
  analytic/dome_screen.cpp
  analytic/sky_exact.cpp
  cli/domes.cpp
  cli/program.cpp
  unit/dome_samples.cpp
  LIBRARIES penumbra_session penumbra_volumes penumbra_vsm penumbra_reference penumbra_compare penumbra_scenes
            nlohmann_json::nlohmann_json)
target_compile_definitions(domes_test PRIVATE PENUMBRA_PROGRAM="$<TARGET_FILE:penumbra>")
add_dependencies(domes_test penumbra)
