# Devices, buffers, and the visibility buffer against its definition.
find_package(TBB REQUIRED)
add_executable(render_tests
  ${CMAKE_CURRENT_LIST_DIR}/unit/render_buffer.cpp
  ${CMAKE_CURRENT_LIST_DIR}/unit/render_device.cpp
  ${CMAKE_CURRENT_LIST_DIR}/unit/render_visibility_buffer.cpp)
target_compile_definitions(render_tests PRIVATE PENUMBRA_SCENES="${PROJECT_SOURCE_DIR}/scenes")
# The shared fixture names view-sample mapping, hence the link.
target_link_libraries(render_tests PRIVATE
  penumbra_vsm penumbra_reference penumbra_scenes penumbra_warnings GTest::gtest_main TBB::tbb)
gtest_discover_tests(render_tests PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
