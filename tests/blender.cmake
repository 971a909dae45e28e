# SPDX-License-Identifier: Apache-2.0
# Tests of the Blender add-on: without Blender (quick), and in Blender, compared with Cycles (full). They need Debian's
# Python, because numpy is Debian's package.
find_program(PENUMBRA_SYSTEM_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH REQUIRED)
set(addon ${PROJECT_BINARY_DIR}/penumbra-blender.zip)
add_test(NAME blender.addon
         COMMAND ${PENUMBRA_SYSTEM_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/blender/addon.py ${PROJECT_SOURCE_DIR}/blender ${addon}
                 $<TARGET_FILE:penumbra>)
add_test(NAME blender.nodes
         COMMAND ${PENUMBRA_SYSTEM_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/blender/addon_nodes.py ${addon})
add_test(NAME blender.serve COMMAND ${PENUMBRA_SYSTEM_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/blender/serve.py ${addon} $<TARGET_FILE:penumbra>)
add_test(NAME blender.views COMMAND ${PENUMBRA_SYSTEM_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/blender/views.py ${addon} $<TARGET_FILE:penumbra>)
set_tests_properties(blender.addon blender.nodes blender.serve blender.views PROPERTIES LABELS quick)
add_test(NAME blender.farm
         COMMAND ${PENUMBRA_SYSTEM_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/blender/farm.py ${addon} $<TARGET_FILE:penumbra>
                 ${PROJECT_BINARY_DIR}/blender_farm)
set_tests_properties(blender.farm PROPERTIES LABELS full TIMEOUT 1200)
foreach(script engine motion panels surfaces baked cycles exported foreign compositor)
  add_test(NAME blender.${script}
           COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/blender/run.sh ${script}.py ${addon} $<TARGET_FILE:penumbra>
                   ${PROJECT_BINARY_DIR}/blender_${script})
  set_tests_properties(blender.${script} PROPERTIES LABELS full TIMEOUT 7200)
endforeach()
add_test(NAME blender.viewport
         COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/blender/run.sh viewport.py ${addon} $<TARGET_FILE:penumbra> ${PROJECT_BINARY_DIR}/blender_viewport)
set_tests_properties(blender.viewport PROPERTIES LABELS full TIMEOUT 1800 ENVIRONMENT WINDOW=1)
add_test(NAME blender.killed
         COMMAND ${PENUMBRA_SYSTEM_PYTHON} ${CMAKE_CURRENT_SOURCE_DIR}/blender/killed.py ${addon} $<TARGET_FILE:penumbra>
                 ${PROJECT_BINARY_DIR}/blender_killed)
set_tests_properties(blender.killed PROPERTIES LABELS full TIMEOUT 1200)
