# The shadow-volume family. wedges_test needs no device, volumes_test does.
penumbra_test(wedges
  SOURCES
  agreement/coverage_errors.cpp
  agreement/coverage_exact_area.cpp
  agreement/coverage_lights.cpp
  agreement/coverage_meshes.cpp
  analytic/coverage_closed_forms.cpp
  property/coverage_properties.cpp
  property/coverage_textures.cpp
  property/penumbra_wedges.cpp
  property/wedge_corpus.cpp
  property/wedge_polyhedra.cpp
  property/wedge_validation.cpp
  LIBRARIES penumbra_wedges penumbra_reference penumbra_scenes ${RAPIDCHECK} gmpxx gmp)
penumbra_cgal_corpus(wedges_test)

penumbra_test(volumes
  SOURCES
  agreement/depth_complexity_scenes.cpp
  agreement/edge_crop.cpp
  agreement/exact_rows.cpp agreement/exact_rows_shapes.cpp
  agreement/packed_counters_scenes.cpp
  agreement/soft_volume_blend.cpp
  agreement/soft_volume_exact.cpp
  agreement/soft_volume_measures.cpp
  agreement/soft_volume_twin.cpp
  agreement/soft_volume_wedges.cpp
  agreement/wedge_ramp.cpp
  property/depth_complexity_counters.cpp
  property/depth_complexity_lattice.cpp
  property/hard_volume_exact.cpp
  property/packed_counters.cpp
  property/row_sweep.cpp
  property/silhouette_pass.cpp
  property/vector_bounds.cpp
  property/wedge_builder.cpp
  unit/light_tiles.cpp
  LIBRARIES penumbra_volumes penumbra_selftest penumbra_vsm penumbra_reference penumbra_scenes TBB::tbb)
target_compile_definitions(volumes_test PRIVATE PENUMBRA_TEST_LAMPS="${CMAKE_CURRENT_SOURCE_DIR}/lamps")
