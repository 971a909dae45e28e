# SPDX-License-Identifier: Apache-2.0
# Tests of view-sample mapping, compared with the exact decision and closed forms.
penumbra_test(vsm
  SOURCES
  agreement/volumes/kept_meshes.cpp
  analytic/view_sample_closed_forms.cpp
  property/volumes/cut_ends.cpp
  property/volumes/edge_cut.cpp
  property/vsm/view_sample_closed_parts.cpp
  property/vsm/view_sample_invariance.cpp
  property/vsm/view_sample_metamorphic.cpp
  property/vsm/view_sample_patterns.cpp
  LIBRARIES penumbra_vsm penumbra_volumes penumbra_reference penumbra_scenes TBB::tbb gmpxx gmp)
# Lists that are allocated without being cleared (base/pages.hpp) are filled with garbage here: results must not depend
# on it.
add_test(NAME vsm.unset_memory COMMAND vsm_test --gtest_filter=Kept*:SceneEdges*)
set_tests_properties(vsm.unset_memory PROPERTIES LABELS quick ENVIRONMENT MALLOC_PERTURB_=165)
