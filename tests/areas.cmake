# SPDX-License-Identifier: Apache-2.0
# Tests of the areas of unions on the light, and of the method `exact`, which computes them. No device.
penumbra_test(areas
  SOURCES analytic/exact_area_closed_forms.cpp property/exact_area_soups.cpp unit/exact_method.cpp
  LIBRARIES penumbra_reference)
if(PENUMBRA_WITH_CGAL_GPL)
  # CGAL's Boolean set operations (GPL) check the union: an independent library and algorithm, used in this test alone.
  find_package(CGAL REQUIRED)
  target_sources(areas_test PRIVATE agreement/exact_area_booleans.cpp)
  set_source_files_properties(agreement/exact_area_booleans.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  if(PENUMBRA_SANITIZE)  # CGAL's arrangements cast faces to types that they do not have
    set_source_files_properties(agreement/exact_area_booleans.cpp PROPERTIES COMPILE_OPTIONS -fno-sanitize=vptr)
  endif()
  target_link_libraries(areas_test PRIVATE CGAL::CGAL)
endif()
