# SPDX-License-Identifier: Apache-2.0
# Tests of the shadow-volume family. wedges_test needs no device, volumes_test does.
find_package(hwy REQUIRED)
penumbra_test(wedges
  SOURCES
  agreement/volumes/coverage_errors.cpp
  agreement/volumes/coverage_exact_area.cpp
  agreement/volumes/coverage_lights.cpp
  agreement/volumes/coverage_meshes.cpp
  analytic/coverage_closed_forms.cpp
  analytic/wedge_bodies.cpp
  property/volumes/coverage_properties.cpp
  property/volumes/coverage_textures.cpp
  property/volumes/penumbra_wedges.cpp
  property/volumes/wedge_corpus.cpp
  property/volumes/wedge_polyhedra.cpp
  property/volumes/wedge_validation.cpp
  LIBRARIES penumbra_wedges penumbra_reference penumbra_scenes ${RAPIDCHECK} gmpxx gmp)
penumbra_cgal_corpus(wedges_test)

penumbra_test(volumes
  SOURCES
  agreement/volumes/contacts.cpp
  agreement/volumes/wide_cones.cpp
  agreement/volumes/cut_edges.cpp
  agreement/volumes/window_corners.cpp
  agreement/volumes/depth_complexity_scenes.cpp
  agreement/volumes/edge_crop.cpp
  agreement/volumes/every_width.cpp
  agreement/volumes/exact_rows.cpp agreement/volumes/exact_rows_shapes.cpp
  agreement/volumes/exact_rows_spheres.cpp
  agreement/volumes/packed_counters_scenes.cpp
  agreement/volumes/plateaus.cpp
  agreement/volumes/soft_volume_blend.cpp
  agreement/volumes/soft_volume_exact.cpp
  agreement/volumes/soft_volume_fusion.cpp
  agreement/volumes/soft_volume_measures.cpp
  agreement/volumes/soft_volume_twin.cpp
  agreement/volumes/soft_volume_wedges.cpp
  agreement/volumes/wedge_ramp.cpp
  property/volumes/depth_complexity_counters.cpp
  property/volumes/depth_complexity_lattice.cpp
  property/volumes/edge_cones.cpp
  property/volumes/hard_volume_exact.cpp property/volumes/hard_volume_variants.cpp
  property/volumes/packed_counters.cpp
  property/volumes/disk_bounds.cpp
  property/volumes/row_bounds.cpp
  property/volumes/row_sweep.cpp
  property/volumes/silhouette_pass.cpp
  property/volumes/vector_bounds.cpp
  property/volumes/wedge_builder.cpp
  unit/horizon.cpp
  unit/light_tiles.cpp
  unit/known_normals.cpp
  unit/near_casters.cpp
  unit/pack.cpp
  unit/point_rows.cpp
  unit/wide_leaves.cpp
  LIBRARIES penumbra_volumes penumbra_selftest penumbra_vsm penumbra_reference penumbra_scenes hwy::hwy TBB::tbb gmpxx gmp)
target_compile_definitions(volumes_test PRIVATE PENUMBRA_TEST_LAMPS="${CMAKE_CURRENT_SOURCE_DIR}/lamps")
