# The figures of docs/ are what their script draws; each picture and link of a page leads somewhere.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
add_test(NAME docs.figures COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/docs/figures/make.py --check)
set_tests_properties(docs.figures PROPERTIES LABELS quick)
