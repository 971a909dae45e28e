# SPDX-License-Identifier: Apache-2.0
# Tests of methods that decide pairs one triangle at a time, compared with the exact decision.
penumbra_test(pairs
  SOURCES
  agreement/volumes/soft_irregular.cpp
  property/vsm/alias_free.cpp
  property/vsm/pair_methods.cpp
  LIBRARIES penumbra_vsm penumbra_pairs penumbra_volumes penumbra_reference penumbra_scenes TBB::tbb)
