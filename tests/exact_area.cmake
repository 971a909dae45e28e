# `exact`: areas of unions on the light. No device.
add_executable(exact_area_tests
  ${CMAKE_CURRENT_LIST_DIR}/analytic/exact_area_closed_forms.cpp
  ${CMAKE_CURRENT_LIST_DIR}/property/exact_area_soups.cpp
  ${CMAKE_CURRENT_LIST_DIR}/unit/exact_method.cpp)
target_link_libraries(exact_area_tests PRIVATE penumbra_reference penumbra_warnings GTest::gtest_main)
if(PENUMBRA_WITH_CGAL_GPL)
  # CGAL's Boolean set operations (GPL) judge the union: another library, another way, in a test alone.
  find_package(CGAL REQUIRED)
  target_sources(exact_area_tests PRIVATE ${CMAKE_CURRENT_LIST_DIR}/agreement/exact_area_booleans.cpp)
  if(PENUMBRA_SANITIZE)  # CGAL's arrangements cast faces down to what they are not
    set_source_files_properties(
      ${CMAKE_CURRENT_LIST_DIR}/agreement/exact_area_booleans.cpp PROPERTIES COMPILE_OPTIONS -fno-sanitize=vptr)
  endif()
  target_link_libraries(exact_area_tests PRIVATE CGAL::CGAL)
endif()
gtest_discover_tests(exact_area_tests PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
