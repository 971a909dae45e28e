# What `inspect` says that each method makes of a flawed mesh, against what the method does with it.
find_package(TBB REQUIRED)
add_executable(mesh_verdict_tests ${CMAKE_CURRENT_LIST_DIR}/agreement/mesh_verdicts.cpp)
target_link_libraries(mesh_verdict_tests PRIVATE
  penumbra_app penumbra_volumes penumbra_vsm penumbra_reference penumbra_scenes penumbra_warnings GTest::gtest_main
  TBB::tbb)
gtest_discover_tests(mesh_verdict_tests PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
