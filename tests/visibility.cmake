# The question itself: scene floats, lights and their samples, the exact truth of a pair, the tree, bits files. No device.
find_package(CGAL REQUIRED)
penumbra_test(visibility
  SOURCES
  property/signed_crossings.cpp
  property/signed_crossings_sum.cpp
  property/visibility_invariance.cpp
  property/visibility_pair_kinds.cpp
  property/visibility_pair_truth.cpp
  property/visibility_planes.cpp
  property/visibility_triangle_tree.cpp
  unit/bits_file.cpp
  unit/visibility_light_touch.cpp
  unit/visibility_lights.cpp
  unit/visibility_method.cpp
  unit/visibility_sample_patterns.cpp
  unit/visibility_scene_floats.cpp
  unit/visibility_view_samples.cpp
  # GMP's rationals are the judge of the exact predicates: another library, another formula.
  LIBRARIES penumbra_visibility CGAL::CGAL TBB::tbb gmpxx gmp)
