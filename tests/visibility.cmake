# SPDX-License-Identifier: Apache-2.0
# Tests of the definition of visibility: scene floats, lights and their samples, the exact truth of a pair, the tree,
# bits files. No device.
find_package(CGAL REQUIRED)
penumbra_test(visibility
  SOURCES
  property/visibility/signed_crossings.cpp
  property/visibility/signed_crossings_sum.cpp
  property/visibility/alpha.cpp
  property/visibility/alpha_reach.cpp
  property/visibility/alpha_views.cpp
  property/visibility/invariance.cpp
  property/visibility/pair_kinds.cpp
  property/visibility/pair_truth.cpp
  property/visibility/planes.cpp
  property/visibility/seen_part.cpp
  property/visibility/shaft_planes.cpp
  property/visibility/triangle_bits.cpp
  property/visibility/triangle_tree.cpp
  unit/bits_file.cpp
  unit/visibility/box_groups.cpp
  unit/visibility/lens.cpp
  unit/visibility/light_kinds.cpp
  unit/visibility/light_touch.cpp
  unit/visibility/lights.cpp
  unit/visibility/method.cpp
  unit/visibility/sample_patterns.cpp
  unit/visibility/scene_floats.cpp
  unit/visibility/view_samples.cpp
  # GMP's rationals check the exact predicates: an independent library and formula.
  LIBRARIES penumbra_seen penumbra_visibility CGAL::CGAL TBB::tbb gmpxx gmp)
