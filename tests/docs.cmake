# SPDX-License-Identifier: Apache-2.0
# Tests that docs/ agrees with the program and the data: figures are what their script draws; each picture and link of a
# page leads somewhere; the commands of the README, the tutorials and docs/scenes.md print what the pages say;
# options.md is the program's own help; tables of timings, and the README's figures next to those of Cycles, are what
# bench/results/ holds; every method has its rows in these tables and in the ranking; the marks in a benchmark's chart
# are where its data say; the example in the help of each command runs.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_test(NAME docs.figures COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/docs/figures/make.py --check)
add_test(NAME docs.options COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/docs/option_tables.py --program $<TARGET_FILE:penumbra> --check)
add_test(NAME docs.options_missing COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/docs/option_tables.py ${PROJECT_SOURCE_DIR}/docs)
add_test(NAME docs.results COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/bench/tables.py --check)
add_test(NAME docs.examples COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/docs/examples.py $<TARGET_FILE:penumbra> ${PROJECT_SOURCE_DIR})
add_test(NAME docs.error_chart COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/docs/error_chart.py)
add_test(NAME docs.methods_have_rows COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/docs/every_method_has_rows.py $<TARGET_FILE:penumbra>
                                             ${PROJECT_SOURCE_DIR})
add_test(NAME docs.against_cycles COMMAND ${PENUMBRA_SYSTEM_PYTHON} ${PROJECT_SOURCE_DIR}/bench/against_cycles.py page --check)
set_tests_properties(docs.against_cycles docs.examples docs.figures docs.options docs.options_missing docs.results docs.error_chart docs.methods_have_rows PROPERTIES LABELS quick)
foreach(page IN ITEMS README docs/start/artist docs/start/researcher docs/start/mesh-tester docs/start/wedge-validator docs/scenes)
  cmake_path(GET page FILENAME name)
  string(TOLOWER ${name} name)
  add_test(NAME docs.commands.${name}
           COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/docs/console.py $<TARGET_FILE:penumbra> ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/${page}.md)
  set_tests_properties(docs.commands.${name} PROPERTIES LABELS quick)
endforeach()
