# SPDX-License-Identifier: Apache-2.0
# Tests of repair, and of the program that does it.
if(PENUMBRA_WITH_CGAL_GPL)
  penumbra_test(repair SOURCES unit/repair/helper.cpp unit/repair/repair.cpp LIBRARIES penumbra_repair penumbra_mesh)
  add_dependencies(repair_test penumbra-repair)
endif()
# No object of the library or of a program includes a header under the GPL alone, except those of penumbra-repair.
add_test(NAME repair.licence
         COMMAND ${Python_EXECUTABLE} ${CMAKE_CURRENT_SOURCE_DIR}/unit/repair/licence.py ${PROJECT_BINARY_DIR})
set_tests_properties(repair.licence PROPERTIES LABELS quick SKIP_RETURN_CODE 77)
