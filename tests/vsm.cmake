# View-sample mapping against the exact decision and closed forms.
penumbra_test(vsm
  SOURCES
  analytic/view_sample_closed_forms.cpp
  property/cut_ends.cpp
  property/edge_cut.cpp
  property/view_sample_closed_parts.cpp
  property/view_sample_invariance.cpp
  property/view_sample_metamorphic.cpp
  property/view_sample_patterns.cpp
  LIBRARIES penumbra_vsm penumbra_volumes penumbra_reference penumbra_scenes TBB::tbb gmpxx gmp)
