# Textured rectangle lights: their files, the weights of light samples, exact integrals, and every method under them.
find_package(TBB REQUIRED)
find_package(ZLIB REQUIRED)
add_executable(textured_lights_tests
  ${CMAKE_CURRENT_LIST_DIR}/agreement/textured_lights_methods.cpp
  ${CMAKE_CURRENT_LIST_DIR}/analytic/textured_lights_exact.cpp
  ${CMAKE_CURRENT_LIST_DIR}/unit/textured_lights_files.cpp
  ${CMAKE_CURRENT_LIST_DIR}/unit/textured_lights_weights.cpp)
target_compile_definitions(textured_lights_tests PRIVATE PENUMBRA_SCENES="${PROJECT_SOURCE_DIR}/scenes")
target_link_libraries(textured_lights_tests PRIVATE
  penumbra_compare penumbra_maps penumbra_vsm penumbra_reference penumbra_scenes penumbra_warnings GTest::gtest_main
  TBB::tbb ZLIB::ZLIB)
gtest_discover_tests(textured_lights_tests PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
