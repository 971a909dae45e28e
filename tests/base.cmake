# SPDX-License-Identifier: Apache-2.0
# Tests of base: EXR, PNG and JPEG, files that appear whole or not at all, suggestions for misspelt names, and sorting
# on all cores.
find_package(JPEG REQUIRED)
find_package(OpenEXR REQUIRED)
find_package(TBB REQUIRED)
penumbra_test(base
  SOURCES unit/buckets.cpp unit/did_you_mean.cpp unit/exr.cpp unit/image.cpp unit/jpeg.cpp unit/kept_arrays.cpp unit/large_heap.cpp
    unit/parallel.cpp unit/rgbe.cpp unit/utf8.cpp
  LIBRARIES penumbra_base JPEG::JPEG OpenEXR::OpenEXR TBB::tbb)
