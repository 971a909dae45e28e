add_executable(penumbra_maps_tests analytic/maps_closed_form_test.cpp analytic/maps_method_test.cpp
               analytic/maps_products_test.cpp)
target_include_directories(penumbra_maps_tests PRIVATE ${PROJECT_BINARY_DIR}/shaders)
add_executable(penumbra_maps_tables analytic/maps_resolution_table.cpp)
foreach(target penumbra_maps_tests penumbra_maps_tables)
  target_link_libraries(${target} PRIVATE penumbra_maps GTest::gtest_main penumbra_warnings)
endforeach()
gtest_discover_tests(penumbra_maps_tests PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
gtest_discover_tests(penumbra_maps_tables PROPERTIES LABELS full DISCOVERY_TIMEOUT 120)
