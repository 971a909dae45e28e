# SPDX-License-Identifier: Apache-2.0
# Tests of the library, used as a program would that knows only its headers, and of the Python module.
penumbra_test(library
  SOURCES library/ends.cpp library/instances.cpp library/own_method.cpp library/renderer.cpp cli/program.cpp
  LIBRARIES penumbra::penumbra penumbra_base nlohmann_json::nlohmann_json)
target_compile_definitions(library_test PRIVATE PENUMBRA_PROGRAM="$<TARGET_FILE:penumbra>")
add_dependencies(library_test penumbra)
if(NOT PENUMBRA_SANITIZE)  # a program or an interpreter without sanitizers cannot load the library
add_test(NAME library.consumer COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/library/consumer.sh ${PROJECT_BINARY_DIR} ${PROJECT_SOURCE_DIR}
                                       ${PROJECT_BINARY_DIR}/library_consumer)
set_tests_properties(library.consumer PROPERTIES LABELS quick)
foreach(test module page)
  add_test(NAME python.${test} COMMAND ${Python_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/python/${test}.py $<TARGET_FILE:penumbra>
                                       ${PROJECT_SOURCE_DIR})
  set_tests_properties(python.${test} PROPERTIES LABELS quick ENVIRONMENT "PYTHONPATH=${PROJECT_BINARY_DIR}/python;MPLBACKEND=Agg")
endforeach()
# Compares map methods with twins: independent versions in numpy, written from the methods' papers.
foreach(twin backprojection filtered_fits filtering fits hard layers rays samples screen sun_fits warps)
  add_test(NAME twins.${twin} COMMAND ${Python_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/twins/${twin}.py)
  set_tests_properties(twins.${twin} PROPERTIES LABELS full ENVIRONMENT "PYTHONPATH=${PROJECT_BINARY_DIR}/python")
endforeach()
add_test(NAME twins.frames COMMAND ${Python_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/twins/frames.py $<TARGET_FILE:penumbra>)
set_tests_properties(twins.frames PROPERTIES LABELS full ENVIRONMENT "PYTHONPATH=${PROJECT_BINARY_DIR}/python")
add_test(NAME twins.flip COMMAND ${Python_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/twins/flip.py $<TARGET_FILE:penumbra>
                                 ${PROJECT_SOURCE_DIR}/scenes/parallel-square.json)
set_tests_properties(twins.flip PROPERTIES LABELS full)
endif()
