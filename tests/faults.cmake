# SPDX-License-Identifier: Apache-2.0
# Tests of the program when the system refuses something: limits, streams, disks, kills. Names of long searches begin
# with Long.
penumbra_test(faults FULL *Long*
  SOURCES
  faults/child.cpp
  faults/disks.cpp
  faults/farm.cpp
  faults/kills.cpp
  faults/limits.cpp
  faults/memory.cpp
  faults/orphans.cpp
  faults/outputs.cpp
  faults/signals.cpp
  faults/streams.cpp
  faults/waits.cpp
  LIBRARIES penumbra_base)
add_library(penumbra_interpose MODULE faults/interpose.cpp)  # tests load it by LD_PRELOAD
set_target_properties(penumbra_interpose PROPERTIES CXX_VISIBILITY_PRESET default)
target_link_libraries(penumbra_interpose PRIVATE penumbra_warnings ${CMAKE_DL_LIBS})
target_compile_definitions(faults_test PRIVATE PENUMBRA_PROGRAM="$<TARGET_FILE:penumbra>"
                           PENUMBRA_INTERPOSE="$<TARGET_FILE:penumbra_interpose>")
add_dependencies(faults_test penumbra penumbra_interpose)
